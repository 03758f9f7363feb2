"""A recording as an experiment file describes it: the part to look at, the right way round, with its times.

Whatever way the camera was held, prepared frames show the struck end on the left, the sample below its
surface and the held end on the right, so that everything after this knows one orientation only.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import FrameError, FrameSource, Image, open_recording, recording_times

if TYPE_CHECKING:
    from wrinklewave.config.experiment import Experiment

SAME_RATE = 0.01
"""Frame rates that differ by less are one, rounded."""


class PreparedSource(FrameSource):
    """The chosen frames and region of another source, turned so that x points right and y up.

    Args:
        source: the recording.
        x_axis: direction in the image from the struck to the held end ("right", "left", "up" or "down").
        y_axis: direction in the image out of the sample.
        columns, rows: the region, first and one after the last, in the source's pixels; all if None.
        frames: first frame and one after the last; all if None.
        times: seconds of every frame of the source; the source's own if None.
        bit_depth: significant bits, if fewer than the source's.

    Attributes:
        transposed: whether rows of the prepared frames are columns of the source.

    Raises:
        InputError: if the region or the frames leave the recording.
    """

    def __init__(
        self,
        source: FrameSource,
        *,
        x_axis: str = "right",
        y_axis: str = "up",
        columns: Sequence[int] | None = None,
        rows: Sequence[int] | None = None,
        frames: Sequence[int] | None = None,
        times: NDArray[np.float64] | None = None,
        bit_depth: int | None = None,
    ) -> None:
        super().__init__()
        height, width = source.shape
        self._source = source
        self._columns = _range(columns, width, "region.columns", source)
        self._rows = _range(rows, height, "region.rows", source)
        self._frames = _range(frames, source.n_frames, "video.frames", source)
        self.transposed = x_axis in ("up", "down")
        self._flip_x = x_axis in ("left", "up")
        self._flip_y = y_axis in ("down", "right")
        self.path, self.description, self.notes = source.path, source.description, source.notes
        self.n_frames = len(self._frames)
        size = len(self._rows), len(self._columns)
        self.shape = (size[1], size[0]) if self.transposed else size
        self.bit_depth = bit_depth or source.bit_depth
        self.black_level = source.black_level
        self.white_level = (1 << bit_depth) - 1 if bit_depth else source.white_level
        whole = source.times if times is None else times
        self.clock = source.clock if times is None else "camera"
        self.times = None if whole is None else whole[self._frames.start : self._frames.stop]
        self.frame_rate = source.frame_rate if times is None else _rate(times)

    @property
    def dtype(self) -> np.dtype:
        return self._source.dtype

    @property
    def unreadable(self) -> tuple[tuple[int, str], ...]:
        first, stop = self._frames.start, self._frames.stop
        return tuple((index - first, why) for index, why in self._source.unreadable if first <= index < stop)

    def position(self, column_row: ArrayLike) -> NDArray[np.float64]:
        """Positions in the recording's image as positions in prepared frames; [..., 2] of column and row."""
        found = np.array(column_row, dtype=float) - (self._columns.start, self._rows.start)
        if self.transposed:
            found = found[..., ::-1].copy()
        height, width = self.shape
        if self._flip_x:
            found[..., 0] = width - 1 - found[..., 0]
        if self._flip_y:
            found[..., 1] = height - 1 - found[..., 1]
        return found

    def close(self) -> None:
        self._source.close()

    def _read(self, index: int) -> Image:
        try:
            whole = self._source.frame(self._frames[index])
        except FrameError as error:
            raise FrameError(index, error.reason, source=self.path) from error
        image = whole[self._rows.start : self._rows.stop, self._columns.start : self._columns.stop]
        if self.transposed:
            image = image.T
        turned = image[:: -1 if self._flip_y else 1, :: -1 if self._flip_x else 1]
        return turned.copy()


def open_experiment(experiment: Experiment) -> PreparedSource:
    """Open the recording that an experiment file names, prepared as it says.

    Raises:
        InputError: if it cannot be read, has no times, or is smaller than the experiment file says.
    """
    video, region = experiment.video, experiment.region
    source = open_recording(video.file)
    dynamic = experiment.kind == "impact" or video.frame_rate
    prepared = PreparedSource(
        source,
        x_axis=experiment.calibration.x_axis,
        y_axis=experiment.calibration.y_axis,
        columns=region.columns,
        rows=region.rows,
        frames=video.frames,
        times=recording_times(source, video.frame_rate) if dynamic else None,
        bit_depth=video.bit_depth,
    )
    if video.undeformed_frames > prepared.n_frames:
        raise InputError(
            f"{video.undeformed_frames} of {prepared.n_frames} frames",
            key="video.undeformed_frames",
            expected="fewer than the recording has",
            cure="lower it",
        )
    prepared.notes += _clock_notes(source, video.frame_rate)
    return prepared


def _clock_notes(source: FrameSource, given: float | None) -> tuple[str, ...]:
    """What to know if the experiment file says another frame rate than the camera wrote down."""
    own = source.frame_rate if source.clock == "camera" else None
    if own is None or given is None or abs(given / own - 1) < SAME_RATE:
        return ()
    return (
        f"video.frame_rate is {given:g} Hz, but the camera's own clock in the recording has {own:g} Hz: times and "
        "speeds are those of the former; leave it out if the camera is right",
    )


@contextmanager
def named_as_in_the_recording(source: PreparedSource) -> Iterator[None]:
    """Errors about rows and columns of turned frames name what these are in the recording."""
    try:
        yield
    except InputError as error:
        if not source.transposed:
            raise
        raise InputError(
            error.problem,
            file=error.file,
            key=_transposed(error.key),
            expected=_transposed(error.expected),
            cure=_transposed(error.cure),
        ) from error


def _transposed(text: str | None) -> str | None:
    other = {"rows": "columns", "columns": "rows"}
    return text and re.sub(r"\b(rows|columns)\b", lambda found: other[found[1]], text)


def _rate(times: NDArray[np.float64]) -> float | None:
    return float((len(times) - 1) / (times[-1] - times[0])) if len(times) > 1 else None


def _range(bounds: Sequence[int] | None, size: int, key: str, source: FrameSource) -> range:
    if bounds is None:
        return range(size)
    first, stop = bounds
    if not 0 <= first < stop <= size:
        raise InputError(
            f"[{first}, {stop}] leaves the recording {source.path or ''}".rstrip(),
            key=key,
            expected=f"within [0, {size}]",
            cure="change it, or leave it out for all",
        )
    return range(first, stop)
