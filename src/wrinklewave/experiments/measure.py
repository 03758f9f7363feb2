"""The measured impact, from a recording to a surface motion and its analysis."""

from __future__ import annotations

import re
import tempfile
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave import surface as surfaces
from wrinklewave.analysis.analyse import analyse
from wrinklewave.analysis.filters import check_cutoff
from wrinklewave.config.experiment import Experiment, load_experiment
from wrinklewave.environment import processor
from wrinklewave.errors import InputError
from wrinklewave.experiments.frame_blocks import BlockStore, FrameBlock, block_bounds, measure_block
from wrinklewave.experiments.impact_moments import EndTrack, find_moments, with_exposure_uncertainty
from wrinklewave.experiments.interruption import Outcome, interruptible
from wrinklewave.experiments.measured_surface import (
    end_track,
    frame_series,
    laboratory_grid,
    track_columns,
    write_surface,
)
from wrinklewave.experiments.measurement_folder import MeasurementFolder
from wrinklewave.experiments.measurement_summary import (
    measurement_summary,
    scale_warnings,
    surface_attributes,
)
from wrinklewave.imaging.appearance import Appearance, learn_appearance
from wrinklewave.imaging.calibration import PixelMap, calibrate
from wrinklewave.imaging.edges.locking import PixelLocking
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.imaging.inspection import grey_warnings, histogram
from wrinklewave.imaging.prepared import PreparedSource, open_experiment
from wrinklewave.imaging.wires import WireLook, learn_wires

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.analysis.results import Analysis
    from wrinklewave.imaging.frames import Image

LEARNT_BYTES = 100e6
MOST_LEARNT, FEWEST_LEARNT = 32, 4
"""Frames that say what the sample looks like at rest: so many bytes and at most so many, spread over all that do."""
OTHER_FRAMES = 24
ANALYSED_VALUES = 1_000_000
"""Heights that are analysed at most: of a longer recording the first part after contact."""
FRAMES_BEFORE = 20
FEWEST_FRAMES = 4
WRONG_SCALE = 0.25
"""Relative difference between the length that is seen and the one that is given that can only be a mistake."""
ASTRAY = 0.2
"""Share of frames in which the struck end may be taken for something else, and of the length by which it is astray."""
MOVED = 1.0
"""Pixels by which the struck end of a sample at rest may move."""
SPREAD_TIMES = (0.1, 0.25, 0.7)
"""Times for profiles where the experiment file names none: shares of the time after contact."""


@dataclass(frozen=True)
class MeasuringProgress:
    """Where a measurement is.

    Args:
        frames: done.
        n_frames: of the recording.
        per_second: frames, since it was started or resumed.
    """

    frames: int
    n_frames: int
    per_second: float

    @property
    def share(self) -> float:
        """Of the whole that is done."""
        return self.frames / self.n_frames

    def __str__(self) -> str:
        left = (self.n_frames - self.frames) / self.per_second if self.per_second > 0 else float("nan")
        return f"frame {self.frames} of {self.n_frames}, {self.per_second:.0f} frames/s, {left:.0f} s left"


@dataclass(eq=False)
class Measurement:
    """A measurement that has ended.

    Args:
        experiment: as resolved.
        outcome: how it ended.
        summary: scalar results with units in their names.
        warnings: sentences about what makes it less trustworthy than it should be.
        surface: the surface motion; None if the measurement did not finish. Of a long recording, the part that
            was analysed: ``surface.nc`` holds all.
        analysis: of the surface motion; None if the measurement did not finish.
        appearance: of the recording at rest.
        pixels: the calibration; None if the measurement did not finish.
        locking: residuals of single columns against the sub-pixel phase, over all frames.
        folder: where the results are, if anywhere.
    """

    experiment: Experiment
    outcome: Outcome
    appearance: Appearance
    summary: dict[str, Any] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    surface: xr.Dataset | None = None
    analysis: Analysis | None = None
    pixels: PixelMap | None = None
    locking: PixelLocking = field(default_factory=PixelLocking.none)
    folder: Path | None = None


def measure(
    experiment: Experiment | str | Path,
    *,
    out: str | Path | None = None,
    threads: int | None = None,
    overrides: Sequence[str] = (),
    resume: bool = False,
    overwrite: bool = False,
    progress: Callable[[MeasuringProgress], None] = lambda state: None,
) -> Measurement:
    """Measure the recording of an impact and analyse its surface motion.

    Every frame is measured by itself; results depend neither on the number of threads nor on interruptions.

    Args:
        experiment: an experiment, or the path of an experiment file.
        out: folder for the results; without it only what is returned is kept.
        threads: that measure; default all cores that this process may use.
        overrides: ``"key=value"`` on top of the experiment file, if that is given by its path.
        resume: go on with an interrupted measurement in ``out``, if there is one.
        overwrite: replace an earlier measurement in ``out``.
        progress: called now and then.

    Raises:
        InputError: if the experiment file or the recording cannot be used, or ``out`` holds something else.
    """
    experiment = experiment if isinstance(experiment, Experiment) else load_experiment(experiment, overrides)
    if experiment.kind != "impact":
        raise InputError(
            f'kind = "{experiment.kind}"',
            key="experiment.kind",
            expected='"impact"',
            cure="other kinds have procedures of their own",
        )
    begin = time.perf_counter()
    with (
        open_experiment(experiment) as source,
        measurement_folder(experiment, out, resume, overwrite) as folder,
    ):
        _check_early(experiment, source)
        appearance, wires = learn(experiment, source)
        check_scale(experiment, appearance)
        store = folder.blocks(_origin(experiment, source))
        measurer = FrameMeasurer(appearance, wires=wires, resolution=experiment.edge.resolution)
        kept = Path(out) if out else None
        if not measure_frames(source, measurer, store, threads, progress):
            return Measurement(experiment, Outcome.INTERRUPTED, appearance, folder=kept)
        found = _evaluate(experiment, source, measurer, store, folder)
        found.folder = kept
        found.summary["wall_time_s"] = time.perf_counter() - begin
        assert found.surface is not None
        folder.write_finished(found.surface, found.summary)
        store.remove()
    return found


def _check_early(experiment: Experiment, source: PreparedSource) -> None:
    """What would stop the evaluation of all frames is better said before they are measured."""
    if experiment.calibration.kind != "sample-length":
        check_cutoff(experiment.analysis.filter_wavelength, experiment.calibration.pixel_size)
    check_frames(source.n_frames)
    contact = experiment.contact.time
    assert source.times is not None  # impacts have a clock
    first, last = source.times[0], source.times[-1]
    if contact is not None and not first < contact < last:
        raise InputError(
            f"{1e3 * contact:g} ms is not within the frames used",
            key="contact.time",
            expected=f"after {1e3 * first:.6g} ms and before {1e3 * last:.6g} ms, on the recording's clock",
            cure='correct it, or have it found: time = "detect"',
        )


def check_frames(n_frames: int) -> None:
    """Whether there are frames enough for a surface motion.

    Raises:
        InputError: if not.
    """
    if n_frames < FEWEST_FRAMES:
        raise InputError(
            f"too few frames that can be used: {n_frames}",
            key="video.frames",
            expected=f"{FEWEST_FRAMES} at least: the sample at rest, and what follows",
            cure="use more of the recording, or another one",
        )


def check_scale(experiment: Experiment, appearance: Appearance) -> None:
    """Whether the undeformed sample is roughly as long in the images as it is said to be.

    Raises:
        InputError: if not; small differences are warned of later.
    """
    if experiment.calibration.kind == "sample-length":
        return
    columns = (appearance.held_end - appearance.struck_end) * np.hypot(1.0, appearance.line[1])
    seen = columns * experiment.calibration.pixel_size
    if np.isfinite(seen) and abs(seen / experiment.sample.length - 1.0) > WRONG_SCALE:
        raise InputError(
            f"in the undeformed images the sample is {1e3 * seen:.4g} mm long ({columns:.0f} px), "
            f"not {1e3 * experiment.sample.length:.4g} mm",
            key="calibration",
            expected=f"a scale by which it is as long as sample.length says, to {WRONG_SCALE:.0%} at least",
            cure="correct one of the two; give region if something else is taken for an end of the sample",
        )


def _check_direction(track: EndTrack, length: float) -> None:
    """Whether the struck end stays where one of a sample of this ``length`` [px] can be."""
    way = (track.column - track.rest)[np.isfinite(track.column)] / length
    astray = (way < -ASTRAY) | (way > 0.5 + ASTRAY)
    if astray.mean() > ASTRAY:
        raise InputError(
            f"in {astray.mean():.0%} of the frames the struck end is seen at {np.median(way[astray]):.0%} "
            "of the sample's length",
            key="calibration.x_axis",
            expected="the direction in the image from the struck to the held end",
            cure="turn it if the striker comes from the other side; give region if something stands before the sample",
        )


def learn(experiment: Experiment, source: PreparedSource) -> tuple[Appearance, WireLook | None]:
    """What the sample and its wires look like at rest, from the undeformed frames and some others."""
    size = source.shape[0] * source.shape[1] * 4
    most = int(np.clip(LEARNT_BYTES / size, FEWEST_LEARNT, MOST_LEARNT))
    undeformed = _spread(source, experiment.video.undeformed_frames, most)
    if not undeformed:
        raise InputError(
            "none of the undeformed frames can be read",
            key="video.undeformed_frames",
            expected="at least one whole frame of the sample at rest at the beginning of the recording",
            cure="begin later with video.frames",
        )
    others = _spread(source, source.n_frames, min(most, OTHER_FRAMES))
    with _named_as_in_the_recording(source):
        _check_at_rest(undeformed, others, experiment.video.undeformed_frames)
        appearance = learn_appearance(undeformed, others)
    if experiment.wires is None:
        return appearance, None
    mean = np.asarray(np.mean(undeformed, axis=0, dtype=np.float64), dtype=np.float32)
    given = experiment.wires.positions
    places = None if given is None else np.array([source.position(place)[0] for place in given])
    names = [f"[{column:g}, {row:g}]" for column, row in given or ()]
    count = experiment.wires.count
    return appearance, learn_wires(mean, appearance, count=count, positions=places, names=names)


def _check_at_rest(undeformed: Sequence[Image], others: Sequence[Image], n_frames: int) -> None:
    """Whether the struck end is in the same place in all undeformed frames; those learnt from, spread evenly."""
    look = learn_appearance(undeformed[:1], others)
    measurer = FrameMeasurer(look)
    ends = [measurer.measure(image).end for image in undeformed]
    columns = np.array(
        [end.column if end.gain > 0.0 or not np.isfinite(end.touch) else end.touch for end in ends]
    )
    moved = np.flatnonzero(np.abs(columns - columns[0]) > MOVED)
    if moved.size:
        frame = round(moved[0] * (n_frames - 1) / (len(undeformed) - 1))
        raise InputError(
            f"{n_frames}, but in frame {frame} the struck end has moved by "
            f"{columns[moved[0]] - columns[0]:+.1f} px",
            key="video.undeformed_frames",
            expected="how many frames at the beginning show the sample at rest",
            cure=f"lower it to {frame} or fewer",
        )


@contextmanager
def _named_as_in_the_recording(source: PreparedSource) -> Iterator[None]:
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


def measure_frames(
    source: PreparedSource,
    measurer: FrameMeasurer,
    store: BlockStore,
    threads: int | None = None,
    progress: Callable[[MeasuringProgress], None] = lambda state: None,
) -> bool:
    """Measure what is not in the ``store`` yet; False if an interrupt came before the last block."""
    begin, measured = time.perf_counter(), 0
    with ThreadPoolExecutor(threads or processor().usable) as pool, interruptible() as wished:
        for number, (first, stop) in enumerate(block_bounds(source)):
            if number in store:
                continue
            store.put(number, measure_block(source, first, stop, measurer, pool))
            measured += stop - first
            progress(MeasuringProgress(stop, source.n_frames, measured / (time.perf_counter() - begin)))
            if wished() and stop < source.n_frames:
                return False
    return True


def _evaluate(
    experiment: Experiment,
    source: PreparedSource,
    measurer: FrameMeasurer,
    store: BlockStore,
    folder: MeasurementFolder,
) -> Measurement:
    """Surface motion and analysis from measured frames."""
    n_blocks = len(block_bounds(source))

    def blocks() -> Iterator[FrameBlock]:
        return (store.get(number) for number in range(n_blocks))

    appearance = measurer.appearance
    series = frame_series(blocks())
    check_frames(series.frame.size)
    assert source.times is not None  # impacts have a clock
    clock = source.times[series.frame]
    track = end_track(series, clock, experiment.video.undeformed_frames, appearance)
    with _named_as_in_the_recording(source):
        pixels = calibrate(experiment, appearance, track.rest)
    _check_direction(track, experiment.sample.length / pixels.pixel_size)
    impact = find_moments(track, experiment.contact.time)
    if not np.isfinite(impact.contact.time):
        raise InputError(
            "no contact is seen: neither does a striker touch, nor does the struck end move",
            key="contact.time",
            expected="an impact within the frames used",
            cure='give it, as in time = "1.2 ms" on the recording\'s clock, or check video.frames',
        )
    track = with_exposure_uncertainty(track, impact)
    tracks = write_surface(
        folder.surface,
        blocks=blocks(),
        time=clock - impact.contact.time,
        track=track,
        wires=measurer.wires,
        series=series,
        pixels=pixels,
        grid=laboratory_grid(appearance, pixels, measurer.finder.resolution),
        attrs=surface_attributes(experiment, appearance, pixels, impact),
    )
    folder.write_tracks(track_columns(clock - impact.contact.time, track, tracks, pixels))
    surface = _analysed_part(folder.surface)
    experiment = _with_times(experiment, surface)
    analysis = analyse(surface, experiment.analysis)
    summary, warnings = measurement_summary(
        source, appearance, pixels, series, track, impact, tracks, surface, analysis
    )
    warnings += grey_warnings(source, histogram(source))
    warnings += scale_warnings(
        experiment, pixels.pixel_size * (appearance.held_end - track.rest) / np.cos(pixels.tilt)
    )
    return Measurement(
        experiment,
        Outcome.FINISHED,
        appearance,
        summary=summary,
        warnings=warnings,
        surface=surface,
        analysis=analysis,
        pixels=pixels,
        locking=series.locking,
    )


@contextmanager
def measurement_folder(
    experiment: Experiment, out: str | Path | None, resume: bool, overwrite: bool
) -> Iterator[MeasurementFolder]:
    """The folder for the results, or one that is gone afterwards."""
    if out:
        yield MeasurementFolder.prepare(Path(out), experiment, resume=resume, overwrite=overwrite)
        return
    with tempfile.TemporaryDirectory(prefix="wrinklewave-") as passing:
        yield MeasurementFolder.prepare(Path(passing), experiment, resume=False, overwrite=False)


def _origin(experiment: Experiment, source: PreparedSource) -> str:
    """What measured frames depend on: the experiment file and the recording."""
    return f"{experiment.to_toml()}\n# {source.n_frames} frames of {source.shape[1]} x {source.shape[0]} px\n"


def _spread(source: PreparedSource, stop: int, most: int) -> list[Image]:
    """Up to ``most`` readable frames spread evenly over the first ``stop`` ones."""
    wanted = np.unique(np.linspace(0, stop - 1, min(most, stop)).round().astype(int))
    return [image for index in wanted for _, image in source.frames(int(index), int(index) + 1)]


def _analysed_part(path: Path) -> xr.Dataset:
    """The surface motion, or as much of it as memory is meant for: a little before contact and what follows."""
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as whole:
        n_times = max(ANALYSED_VALUES // whole.sizes["x"], 2)
        first = 0
        if whole.sizes["time"] > n_times:
            first = max(int(np.searchsorted(whole["time"].values, 0.0)) - FRAMES_BEFORE, 0)
        part = whole.isel(time=slice(first, first + n_times)).load()
    return surfaces.check(part, source=path)


def _with_times(experiment: Experiment, surface: xr.Dataset) -> Experiment:
    """The experiment with times for profiles, if it names none."""
    if experiment.analysis.times:
        return experiment
    last = float(surface["time"].values[-1])
    times = tuple(float(f"{share * last:.3g}") for share in SPREAD_TIMES)
    return experiment.model_copy(update={"analysis": experiment.analysis.model_copy(update={"times": times})})
