"""Writing a recording: TIFF stacks, and AVI or MP4 videos that lose nothing."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from fractions import Fraction
from pathlib import Path
from typing import Any

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import FrameSource, Image

MAX_SAMPLE_VALUE = 281
"""Number of the TIFF tag that tells how many of the stored bits mean something."""
PLAYBACK_RATE = 30
FULL_RANGE = 2
"""FFmpeg's ``AVCOL_RANGE_JPEG``: grey uses all values."""


def write_recording(
    source: FrameSource, path: str | Path, *, threads: int = 1, progress: Callable[[int], None] | None = None
) -> Path:
    """Write every frame of a recording to a TIFF stack or a lossless AVI, MP4 or MOV video, by the ending.

    The file appears whole or not at all. TIFF keeps depth and frame rate; videos play at 30 frames/s.

    Args:
        source: the recording.
        path: ends with .tif, .tiff, .avi, .mp4 or .mov.
        threads: threads that read (or render) frames; the source must bear it.
        progress: called with the number of frames written, after each.

    Raises:
        InputError: for another ending, or a bit depth that the format cannot keep.
    """
    target = Path(path)
    writer = {
        ".tif": _write_tiff,
        ".tiff": _write_tiff,
        ".avi": _write_avi,
        ".mp4": _write_mp4,
        ".mov": _write_mp4,
    }
    if target.suffix.lower() not in writer:
        raise InputError(f"unknown ending {target.suffix!r}", file=target, expected=", ".join(writer))
    target.parent.mkdir(parents=True, exist_ok=True)
    partial = target.with_name(f".part-{target.name}")
    try:
        writer[target.suffix.lower()](_counted(_all_frames(source, threads), progress), source, partial)
        partial.replace(target)
    finally:
        partial.unlink(missing_ok=True)
    return target


def _all_frames(source: FrameSource, threads: int) -> Iterator[Image]:
    """Frames in order, a few of them prepared ahead by ``threads`` threads."""
    if threads == 1:
        yield from (source.frame(index) for index in range(source.n_frames))
        return
    with ThreadPoolExecutor(threads) as pool:
        ahead: deque[Future[Image]] = deque()
        for index in range(source.n_frames):
            ahead.append(pool.submit(source.frame, index))
            if len(ahead) > 2 * threads:
                yield ahead.popleft().result()
        while ahead:
            yield ahead.popleft().result()


def _counted(frames: Iterator[Image], progress: Callable[[int], None] | None) -> Iterator[Image]:
    for number, frame in enumerate(frames, start=1):
        yield frame
        if progress:
            progress(number)


def _write_tiff(frames: Iterator[Image], source: FrameSource, path: Path) -> None:
    import tifffile

    height, width = source.shape
    size = source.n_frames * height * width * source.dtype.itemsize
    metadata: dict[str, Any] = {"axes": "TYX"}
    if source.frame_rate and source.clock == "camera":
        metadata["frame_rate"] = source.frame_rate
    tifffile.imwrite(
        path,
        frames,
        shape=(source.n_frames, height, width),
        dtype=source.dtype,
        bigtiff=size > 3.9e9,
        photometric="minisblack",
        metadata=metadata,
        extratags=[(MAX_SAMPLE_VALUE, 3, 1, (1 << source.bit_depth) - 1, False)],
    )


def _write_avi(frames: Iterator[Image], source: FrameSource, path: Path) -> None:
    """FFV1, every frame by itself and with checksums, so that damage is noticed and stays where it is."""
    depths = (8, 10, 12, 14, 16)
    options = {"level": "3", "slicecrc": "1", "g": "1", "slices": "4"}
    _encode(frames, source, path, "avi", "ffv1", _grey_format(source, depths, path), options)


def _write_mp4(frames: Iterator[Image], source: FrameSource, path: Path) -> None:
    """H.264 without loss; most players and 8 or 10 bit go with it."""
    pixels = _grey_format(source, (8, 10), path)
    _encode(
        frames, source, path, path.suffix[1:].lower(), "libx264", pixels, {"qp": "0", "preset": "veryfast"}
    )


def _grey_format(source: FrameSource, depths: tuple[int, ...], path: Path) -> str:
    if source.bit_depth not in depths:
        kept = ", ".join(map(str, depths))
        raise InputError(
            f"{source.bit_depth} bit grey values do not fit into this kind of video",
            file=path.with_name(path.name.removeprefix(".part-")),
            expected=f"{kept} bit",
            cure="write a TIFF stack (.tif), or film with another bit depth",
        )
    return "gray" if source.bit_depth == 8 else f"gray{source.bit_depth}le"


def _encode(
    frames: Iterator[Image],
    source: FrameSource,
    path: Path,
    container: str,
    codec: str,
    pixels: str,
    options: dict[str, str],
) -> None:
    import av

    height, width = source.shape
    with av.open(str(path), mode="w", format=container) as output:
        stream: Any = output.add_stream(codec, rate=PLAYBACK_RATE, options=options)
        stream.width, stream.height, stream.pix_fmt = width, height, pixels
        stream.codec_context.color_range = FULL_RANGE
        for number, frame in enumerate(frames):
            picture = av.VideoFrame.from_ndarray(frame.copy(), format=pixels)
            picture.color_range = FULL_RANGE
            picture.pts, picture.time_base = number, Fraction(1, PLAYBACK_RATE)
            output.mux(stream.encode(picture))
        output.mux(stream.encode(None))
