"""Recordings as frame sources: one interface to every kind of file, one frame in memory at a time.

A frame source keeps what the camera recorded: the grey values as they are, their bit depth, the black and the
white level, and the clock. ``clock`` says what ``times`` and ``frame_rate`` are worth: ``"camera"`` means
that the file holds the times of exposure, ``"playback"`` that it only says how fast to show the frames (AVI,
MP4 and MOV files of high-speed cameras), ``None`` that it says nothing.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Iterator
from pathlib import Path
from types import TracebackType
from typing import Literal, Self

import numpy as np
from numpy.typing import NDArray

from wrinklewave.errors import InputError, RunError

Image = NDArray[np.uint8] | NDArray[np.uint16]
Clock = Literal["camera", "playback"] | None

IMAGE_ENDINGS = (".png", ".tif", ".tiff")
TIFF_MAGIC = (b"II*\0", b"MM\0*", b"II+\0", b"MM\0+")
CINE_MAGIC = b"CI\x2c\0"


class FrameError(RunError):
    """One frame that cannot be read; ``index`` and ``reason`` name it."""

    def __init__(self, index: int, reason: str, *, source: object = None) -> None:
        self.index, self.reason = index, reason
        super().__init__(f"{source or 'recording'}: frame {index} cannot be read: {reason}")


class FrameSource(ABC):
    """A recording, frame by frame. Frames are counted from 0; a frame is [height, width], row 0 at the top.

    Attributes:
        n_frames: number of frames, the unreadable ones included.
        shape: (height, width) in pixels.
        bit_depth: significant bits of a grey value; frames are uint8 up to 8 bits, uint16 above.
        black_level: grey value of no light.
        white_level: grey value at which the sensor (or the format) clips.
        times: seconds, shape [n_frames], or None when unknown.
        frame_rate: frames per second, or None when unknown.
        clock: what ``times`` and ``frame_rate`` mean: "camera", "playback" or None.
        description: what kind of file this is, for people.
        notes: what a user should know before trusting the numbers, one sentence each.
        path: where it lies, or None.

    A source reads from one open file: use it from one thread at a time.
    """

    n_frames: int
    shape: tuple[int, int]
    bit_depth: int
    black_level: int = 0
    white_level: int
    times: NDArray[np.float64] | None = None
    frame_rate: float | None = None
    clock: Clock = None
    description: str
    notes: tuple[str, ...] = ()
    path: Path | None = None

    def __init__(self) -> None:
        self._unreadable: dict[int, str] = {}

    @abstractmethod
    def _read(self, index: int) -> Image:
        """Read one frame.

        Raises:
            FrameError: if it is damaged.
        """

    @property
    def dtype(self) -> np.dtype:
        """The type of the frames: uint8 up to 8 bits, uint16 above."""
        return np.dtype(np.uint8 if self.bit_depth <= 8 else np.uint16)

    @property
    def unreadable(self) -> tuple[tuple[int, str], ...]:
        """The frames known by now to be damaged: (index, reason), in order."""
        return tuple(sorted(self._unreadable.items()))

    def frame(self, index: int) -> Image:
        """Frame ``index``, shape [height, width]; a negative index counts from the end.

        Raises:
            IndexError: if there is no such frame.
            FrameError: if it is damaged; it then stands in ``unreadable``.
        """
        if not -self.n_frames <= index < self.n_frames:
            raise IndexError(f"frame {index} of a recording of {self.n_frames}")
        index %= self.n_frames
        if index in self._unreadable:
            raise FrameError(index, self._unreadable[index], source=self.path)
        try:
            return self._read(index)
        except FrameError as error:
            self._unreadable[index] = error.reason
            raise

    def frames(self, start: int = 0, stop: int | None = None, step: int = 1) -> Iterator[tuple[int, Image]]:
        """Pairs (index, frame) for ``range(start, stop, step)``; damaged frames are left out and noted.

        Only one frame is held at a time.
        """
        for index in range(self.n_frames)[start:stop:step]:
            try:
                image = self.frame(index)
            except FrameError:
                continue
            yield index, image

    def close(self) -> None:  # noqa: B027 (most sources hold nothing open)
        """Release the file."""

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


class ArraySource(FrameSource):
    """A stack that is in memory already, shape [n_frames, height, width], uint8 or uint16.

    Raises:
        InputError: if the stack has another shape or type.
    """

    def __init__(
        self,
        stack: Image,
        *,
        bit_depth: int | None = None,
        black_level: int = 0,
        white_level: int | None = None,
        frame_rate: float | None = None,
        times: NDArray[np.float64] | None = None,
        description: str = "frames in memory",
    ) -> None:
        super().__init__()
        if stack.ndim != 3 or stack.dtype not in (np.uint8, np.uint16):
            raise InputError(
                f"frames of type {stack.dtype} and shape {stack.shape}",
                expected="uint8 or uint16, [n_frames, height, width]",
            )
        self._stack = stack
        self.n_frames = stack.shape[0]
        self.shape = (stack.shape[1], stack.shape[2])
        self.bit_depth = bit_depth or 8 * stack.dtype.itemsize
        self.black_level = black_level
        self.white_level = (1 << self.bit_depth) - 1 if white_level is None else white_level
        self.frame_rate = frame_rate
        self.times = np.arange(self.n_frames) / frame_rate if times is None and frame_rate else times
        self.clock = "camera" if self.times is not None else None
        self.description = description

    def _read(self, index: int) -> Image:
        return self._stack[index]


def open_recording(path: str | Path) -> FrameSource:
    """Open a recording: a TIFF stack, a folder of images, a Phantom .cine file, or an AVI, MP4 or MOV video.

    The content decides, not the name; a video is what the video library can open.

    Raises:
        InputError: if there is nothing there, or nothing that can be read as a recording.
    """
    source = _reader(Path(path))(Path(path))
    if next(source.frames(), None) is None:
        source.close()
        raise InputError(
            f"none of its {source.n_frames} frames can be read; the first: {source.unreadable[0][1]}",
            file=path,
            expected="at least one whole frame",
            cure="copy or export the recording again",
        )
    return source


def recording_times(source: FrameSource, frame_rate: float | None = None) -> NDArray[np.float64]:
    """Time of every frame in seconds, shape [n_frames], from the given rate or else from the camera's clock.

    A given ``frame_rate`` [frames/s] counts from frame 0 at t = 0.

    Raises:
        InputError: if no rate is given and the file holds none (a playback rate is no answer).
    """
    if frame_rate is not None:
        return np.arange(source.n_frames) / frame_rate
    if source.clock == "camera" and source.times is not None:
        return source.times
    said = (
        f"only a playback rate of {source.frame_rate:g} per second" if source.frame_rate else "no frame rate"
    )
    raise InputError(
        f"the recording holds {said}",
        file=source.path,
        key="video.frame_rate",
        expected="the camera's frame rate",
        cure='give it in the experiment file: frame_rate = "50000 Hz"',
    )


def _reader(path: Path) -> Callable[[Path], FrameSource]:
    if path.is_dir():
        from wrinklewave.imaging.sources.folder import FolderSource

        return FolderSource
    magic = _first_bytes(path)
    if magic[:4] in TIFF_MAGIC:
        from wrinklewave.imaging.sources.tiff import TiffSource

        return TiffSource
    if magic[:4] == CINE_MAGIC:
        from wrinklewave.imaging.sources.cine import CineSource

        return CineSource
    from wrinklewave.imaging.sources.video import VideoSource

    return VideoSource


def _first_bytes(path: Path) -> bytes:
    try:
        with path.open("rb") as file:
            magic = file.read(16)
    except OSError as error:
        raise InputError(
            f"cannot be opened ({error.strerror})",
            file=path,
            expected="a TIFF stack, a folder of images, a .cine file or a video (AVI, MP4, MOV)",
        ) from error
    if not magic:
        raise InputError("is empty", file=path, expected="a recording", cure="copy it from the camera again")
    return magic
