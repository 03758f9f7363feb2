"""AVI, MP4, MOV and other videos, decoded one frame at a time (PyAV).

Only the grey plane is taken, in the depth in which it is stored. Frames are found by their time stamps, which
a scan of the packets (no decoding) lists on opening. Where a packet cannot be decoded, its frame and those
built on it, up to the next key frame, are unreadable; the rest is used. Codecs without checksums (H.264,
HEVC) decode most damaged bits into wrong pictures without a word: for measuring, record in TIFF, .cine or
FFV1.
"""

from __future__ import annotations

from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import FrameError, FrameSource, Image
from wrinklewave.imaging.sources.grey import COLOUR_NOTE, luma

if TYPE_CHECKING:
    import av

UNDECODABLE = "it cannot be decoded"
CONTAINERS = ("avi", "mov,mp4,m4a,3gp,3g2,mj2", "matroska,webm", "mpeg", "mpegts", "asf", "mxf", "nut")
"""Formats that FFmpeg may take a file for; left to itself it makes moving pictures even of letters."""
DAMAGE = ("crc mismatch", "error", "concealing", "damage", "overread", "bad vlc")
"""Words in which FFmpeg's decoders complain about the data of a frame."""
MPEG_RANGE = 1
"""FFmpeg's ``AVCOL_RANGE_MPEG``: grey runs from 16 to 235 (of 8 bits)."""


class VideoSource(FrameSource):
    """A video that FFmpeg can decode. Its clock is the playback's, which high-speed cameras make up.

    Raises:
        InputError: if it is no video, or too damaged to be opened.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        declared, self._stamps, self._keys = _scan(path)
        self._container, self._stream = _open(path)
        self._stream.codec_context.options = {"err_detect": "explode"}  # no silent repair of damaged frames
        self._decoded: Iterator[tuple[int, Image]] = iter(())
        self._next = -1
        self._set_format()
        self.n_frames = max(declared, len(self._stamps))
        self._index = {stamp: index for index, stamp in enumerate(self._stamps)}
        lost = range(len(self._stamps), self.n_frames)
        self._unreadable.update(dict.fromkeys(lost, "the file ends before it"))
        self._set_clock()

    def _read(self, index: int) -> Image:
        if not self._reachable(index):
            self._decoded = self._decode_from(index)
        for found, image in self._decoded:
            if found == index:
                self._next = index + 1
                return image
            if found > index:
                self._lose(range(index, found))
                self._decoded, self._next = chain([(found, image)], self._decoded), found
                break
        else:
            self._lose(range(index, len(self._stamps)))
        raise FrameError(index, UNDECODABLE, source=self.path)

    def close(self) -> None:
        self._decoded = iter(())
        self._container.close()

    def _reachable(self, index: int) -> bool:
        """Whether decoding on gets to ``index`` without passing a key frame to start afresh from."""
        return 0 <= self._next <= index and not ((self._keys > self._next) & (self._keys <= index)).any()

    def _lose(self, indices: range) -> None:
        self._unreadable.update(dict.fromkeys(indices, UNDECODABLE))

    def _decode_from(self, index: int) -> Iterator[tuple[int, Image]]:
        """Pairs (index, frame) from the key frame at or before ``index`` on, without the damaged ones."""
        self._container.seek(
            self._stamps[self._keys[self._keys <= index][-1]], stream=self._stream, backward=True
        )
        self._stream.codec_context.flush_buffers()
        damaged = False
        for packet in self._container.demux(self._stream):
            if packet.is_keyframe:
                damaged = False
            if damaged:
                continue
            frames = _decoded(packet)
            if frames is None:
                damaged = True
                self._stream.codec_context.flush_buffers()
                continue
            for frame in frames:
                stamp = frame.pts if frame.pts is not None else frame.dts
                if stamp in self._index:
                    yield self._index[stamp], _grey(frame)

    def _set_format(self) -> None:
        """Size, depth and levels, from the pixel format of the first frame that can be decoded."""
        context = self._stream.codec_context
        self.shape = (int(context.height), int(context.width))
        pixels = context.format
        self.bit_depth = max(8, int(pixels.components[0].bits))
        step = 1 << (self.bit_depth - 8)
        limited = not _is_colour(pixels) and "yuvj" not in pixels.name and not pixels.name.startswith("gray")
        limited = (limited and context.color_range == 0) or context.color_range == MPEG_RANGE
        self.black_level, self.white_level = (16 * step, 235 * step) if limited else (0, 256 * step - 1)
        if _is_colour(pixels):
            self.notes = (COLOUR_NOTE,)
        kind = self._container.format.long_name or self._container.format.name
        self.description = f"{kind} video, {context.codec.name}, {pixels.name}"

    def _set_clock(self) -> None:
        base = self._stream.time_base
        stamps = np.array(self._stamps, dtype=float)
        spacing = np.median(np.diff(stamps)) if len(stamps) > 1 else 0.0
        if base is None or spacing <= 0:
            return
        self.clock = "playback"
        whole = np.append(stamps, stamps[-1] + spacing * np.arange(1, self.n_frames - len(stamps) + 1))
        self.times = (whole - whole[0]) * float(base)
        rate = self._stream.average_rate
        self.frame_rate = float(rate) if rate else 1.0 / (spacing * float(base))


def _open(path: Path) -> tuple[av.container.InputContainer, Any]:
    try:
        import av
    except ImportError as error:
        raise InputError(
            "is no TIFF stack; videos need a package that is not installed",
            file=path,
            cure='pip install "wrinklewave[video]"',
        ) from error
    try:
        container = av.open(str(path), mode="r")
    except av.FFmpegError as error:
        raise _no_recording(path, error.strerror or str(error)) from error
    if container.format.name not in CONTAINERS:
        container.close()
        raise _no_recording(path, f"its format is {container.format.long_name}")
    streams = container.streams.video
    if not streams or not streams[0].codec_context or streams[0].codec_context.format is None:
        container.close()
        raise InputError("holds no pictures that can be decoded", file=path, expected="a video stream")
    return container, streams[0]


def _no_recording(path: Path, reason: str) -> InputError:
    return InputError(
        f"cannot be read as a recording ({reason})",
        file=path,
        expected="a TIFF stack, a folder of images, a .cine file or a video (AVI, MP4, MOV)",
        cure=_cure(path),
    )


def _cure(path: Path) -> str | None:
    """An MP4 or MOV file whose index is gone cannot be salvaged: say so."""
    with path.open("rb") as file:
        is_quicktime = file.read(8)[4:] in (b"ftyp", b"moov", b"mdat", b"wide", b"free")
    if not is_quicktime:
        return None
    return "the index of an MP4 or MOV file stands at its end: if the file was cut short, copy it anew"


def _decoded(packet: av.Packet) -> list[av.VideoFrame] | None:
    """Frames that a packet completes, or None if it is damaged.

    Decoders repair what they can and tell of it in their log only, so that has to be read.
    """
    import av

    before = av.logging.get_level()
    av.logging.set_level(av.logging.ERROR)
    try:
        with av.logging.Capture(local=False) as log:
            frames = packet.decode()
    except av.FFmpegError:
        return None
    finally:
        av.logging.set_level(before)
    complaints = " ".join(message.lower() for _, _, message in log)
    if any(word in complaints for word in DAMAGE) or any(frame.is_corrupt for frame in frames):
        return None
    return frames


def _scan(path: Path) -> tuple[int, list[int], np.ndarray]:
    """Number of frames in the header, time stamps of those found, in order, and the indices of key frames."""
    container, stream = _open(path)
    with container:
        packets = {
            packet.pts if packet.pts is not None else packet.dts: bool(packet.is_keyframe)
            for packet in container.demux(stream)
            if packet.size and (packet.pts is not None or packet.dts is not None)
        }
        declared = int(stream.frames)
    stamps = sorted(packets)
    keys = np.flatnonzero([packets[stamp] for stamp in stamps])
    if not len(keys) or keys[0] > 0:
        raise InputError(
            "its first frame is missing, and the rest builds on it", file=path, expected="a whole video"
        )
    return declared, stamps, keys


def _is_colour(pixels: av.VideoFormat) -> bool:
    return bool(pixels.is_rgb) or pixels.name == "pal8"


def _grey(frame: av.VideoFrame) -> Image:
    """The grey plane of a decoded frame, shape [height, width], as it is stored."""
    if _is_colour(frame.format):
        deep = frame.format.components[0].bits > 8
        colour = frame.to_ndarray(format="rgb48le" if deep else "rgb24")
        return luma(colour.astype(np.uint16 if deep else np.uint8, copy=False))
    if not (frame.format.is_planar or frame.format.name.startswith("gray")):
        frame = frame.reformat(format="yuv422p" if frame.format.components[0].bits == 8 else "yuv422p16le")
    plane = frame.planes[0]
    bits = frame.format.components[0].bits
    order = ">" if frame.format.is_big_endian else "<"
    kind = np.dtype(np.uint8 if bits <= 8 else f"{order}u2")
    rows: Image = np.frombuffer(memoryview(plane), dtype=kind).reshape(-1, plane.line_size // kind.itemsize)
    return rows[: frame.height, : frame.width].astype(kind.newbyteorder("="))
