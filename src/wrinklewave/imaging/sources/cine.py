"""Phantom .cine recordings (Vision Research), read frame by frame.

cine-handler reads the headers and knows the linearisation of packed 10 bit values; the frames are unpacked
here, because it takes 10 bit values stored in 16 bits for packed ones, reads no packed 12 bits, turns no
picture the right way up, and decodes the first frame on opening, so that one damaged frame would lose the
recording.

Layouts (Cine File Format, Vision Research): ``biCompression`` 0 is one or two bytes per pixel, rows from the
bottom up when the height is positive; 256 is 10 bit packed, four pixels in five bytes, on a curve that the
table makes linear 12 bit; 1024 is 12 bit packed, two pixels in three bytes; both most significant bits first,
rows top down.
"""

from __future__ import annotations

import struct
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import FrameError, FrameSource, Image

if TYPE_CHECKING:
    from cine_reader.headers import BitmapHeader, CineHeader, Setup

UNPACKED, PACKED_10, PACKED_12 = 0, 256, 1024
LINEARISED_BITS = 12
LINEARISED_BLACK, LINEARISED_WHITE = 64, 4064
"""Black and white of packed 10 bit frames once they are linear, whatever the setup's levels say."""
TIME_BLOCK = 1002
"""Tagged block with the time of every frame: TIME64, seconds times 2**32, whose two lowest bits are flags."""


class CineSource(FrameSource):
    """A grey Phantom recording: 8 bit, 16 bit (10 to 16 significant), packed 10 bit or packed 12 bit.

    ``times`` are the camera's time stamps relative to the trigger; without them, frame numbers over the rate.

    Raises:
        InputError: if the headers are damaged, or the recording is compressed or in colour.
    """

    def __init__(self, path: Path) -> None:
        super().__init__()
        self.path = path
        header, bitmap, setup, offsets = _read_headers(path)
        _check_supported(bitmap, setup, header, path)
        self._layout = int(bitmap.biCompression)
        self._bottom_up = self._layout == UNPACKED and bitmap.biHeight > 0
        self._offsets = offsets
        self._file = path.open("rb")
        self.n_frames = int(header.ImageCount)
        self.shape = (abs(int(bitmap.biHeight)), int(bitmap.biWidth))
        self._set_levels(bitmap, setup)
        self._stored = np.dtype("u1" if bitmap.biBitCount == 8 else "<u2")
        self._set_clock(header, setup)
        self.exposure_time = float(setup.exposure_time_seconds)
        packing = {PACKED_10: "packed 10 bit, linearised", PACKED_12: "packed 12 bit"}
        self.description = f"Phantom cine, {packing.get(self._layout, f'{bitmap.biBitCount} bit')}"
        self._note_missing()

    def _read(self, index: int) -> Image:
        raw = self._payload(index)
        if self._layout == PACKED_10:
            return _linear_10(raw, *self.shape)
        if self._layout == PACKED_12:
            return unpack_12(raw, self.shape[0] * self.shape[1]).reshape(self.shape)
        return self._unpacked(raw)

    def close(self) -> None:
        self._file.close()

    @property
    def _frame_bytes(self) -> int:
        height, width = self.shape
        if self._layout == PACKED_10:
            return -(-height * width * 5 // 4)
        if self._layout == PACKED_12:
            return -(-height * width * 3 // 2)
        return height * _row_stride(width * self._stored.itemsize)

    def _payload(self, index: int) -> NDArray[np.uint8]:
        """The stored bytes of one frame, behind the annotation that precedes it."""
        start = int(self._offsets[index])
        self._file.seek(start)
        size = self._file.read(4)
        annotation = struct.unpack("<I", size)[0] if len(size) == 4 else 0
        if annotation < 8:
            raise FrameError(index, "the file ends before it" if len(size) < 4 else "its header is damaged")
        self._file.seek(start + annotation)
        raw = np.empty(self._frame_bytes, dtype=np.uint8)
        if self._file.readinto(raw.data) != raw.size:
            raise FrameError(index, "the file ends within it", source=self.path)
        return raw

    def _unpacked(self, raw: NDArray[np.uint8]) -> Image:
        height, width = self.shape
        row = width * self._stored.itemsize
        rows = raw.reshape(height, _row_stride(row))[:: -1 if self._bottom_up else 1, :row]
        return np.ascontiguousarray(rows).view(self._stored).astype(self.dtype, copy=False)

    def _set_levels(self, bitmap: BitmapHeader, setup: Setup) -> None:
        if self._layout == PACKED_10:
            self.bit_depth = LINEARISED_BITS
            self.black_level, self.white_level = LINEARISED_BLACK, LINEARISED_WHITE
            return
        stored = 12 if self._layout == PACKED_12 else int(bitmap.biBitCount)
        real = int(setup.RealBPP)
        self.bit_depth = real if 8 <= real <= stored else stored
        black, white, top = (
            _setup_value(setup, "BlackLevel"),
            _setup_value(setup, "WhiteLevel"),
            (1 << self.bit_depth) - 1,
        )
        known = 0 <= black < white <= top
        self.black_level, self.white_level = (black, white) if known else (0, top)

    def _set_clock(self, header: CineHeader, setup: Setup) -> None:
        """Time stamps if there are any; the setup's rate is the camera's, which saves every n-th frame."""
        camera_rate, every = float(setup.frame_rate_hz), float(getattr(setup, "fDecimation", 0) or 0)
        rate = camera_rate / every if every > 1 else camera_rate
        stamps = _time_stamps(setup, header)
        if every > 1:
            self.notes += (f"every {every:g}th frame was saved of {camera_rate:g} per second",)
        if rate > 0:
            self.frame_rate, self.clock = rate, "camera"
            self.times = (int(header.FirstImageNo) + np.arange(self.n_frames)) / rate
        if stamps is None:
            return
        self.times, self.clock = stamps, "camera"
        measured = (self.n_frames - 1) / (stamps[-1] - stamps[0]) if self.n_frames > 1 else rate
        self.frame_rate = rate or measured
        if abs(measured - self.frame_rate) > 0.01 * self.frame_rate:
            self.notes += (
                f"the time stamps say {measured:.6g} frames/s, the header {rate:g}; the stamps count",
            )

    def _note_missing(self) -> None:
        """Frames beyond the end of the file are named at once: a recording cut short is the common damage."""
        end = self.path.stat().st_size if self.path else 0
        for index, start in enumerate(self._offsets):
            if int(start) + 8 + self._frame_bytes > end:
                self._unreadable[index] = (
                    "the file ends before it" if int(start) >= end else "the file ends within it"
                )


def _read_headers(path: Path) -> tuple[CineHeader, BitmapHeader, Setup, NDArray[np.uint64]]:
    try:
        from cine_reader import headers
    except ImportError as error:
        raise InputError(
            "is a Phantom recording, and the package that reads its headers is not installed",
            file=path,
            cure='pip install "wrinklewave[video]"',
        ) from error
    try:
        with path.open("rb") as file:
            header = headers.read_cine_header(file)
            bitmap = headers.read_bitmap_header(file, off_image_header=header.OffImageHeader)
            setup = headers.read_setup(
                file, off_setup=header.OffSetup, off_image_offsets=header.OffImageOffsets
            )
            table = headers.read_image_offsets(
                file,
                off_image_offsets=header.OffImageOffsets,
                image_count=header.ImageCount,
                version=header.Version,
            )
    except (ValueError, struct.error, IndexError, OSError) as error:
        raise _damaged(path, str(error)) from error
    offsets = table.pImage[:-1]  # cine-handler adds the end of the file
    if (
        len(offsets) != header.ImageCount
        or header.ImageCount == 0
        or bitmap.biWidth <= 0
        or bitmap.biHeight == 0
    ):
        raise _damaged(path, f"{len(offsets)} frame positions for {header.ImageCount} frames")
    return header, bitmap, setup, offsets


def _damaged(path: Path, reason: str) -> InputError:
    return InputError(
        f"its headers are damaged ({reason})",
        file=path,
        expected="a Phantom .cine recording with at least one frame",
        cure="save it from the camera again",
    )


def _check_supported(bitmap: BitmapHeader, setup: Setup, header: CineHeader, path: Path) -> None:
    layouts, compressed = (UNPACKED, PACKED_10, PACKED_12), header.Compression not in (0, 2)
    colour = bitmap.biBitCount not in (8, 16) or bool(
        getattr(setup, "bEnableColor", False) and getattr(setup, "CFA", 0)
    )
    if bitmap.biCompression not in layouts or compressed or colour:
        kind = "colour" if colour else f"compression {header.Compression}/{bitmap.biCompression}"
        raise InputError(
            f"is a Phantom recording of an unsupported kind ({kind}, {bitmap.biBitCount} bit)",
            file=path,
            expected="grey frames: 8 or 16 bit, packed 10 bit or packed 12 bit",
            cure="export it from the camera's program as an uncompressed grey .cine or as 16 bit TIFF",
        )


def _setup_value(setup: Any, name: str) -> int:
    return int(getattr(setup, name, -1))


def _row_stride(row_bytes: int) -> int:
    """Rows of a device-independent bitmap are padded to four bytes."""
    return (row_bytes + 3) // 4 * 4


def _time_stamps(setup: Setup, header: CineHeader) -> NDArray[np.float64] | None:
    """Time of every frame relative to the trigger, seconds, from the tagged blocks behind the setup."""
    data, position = setup.SetupData, int(setup.Length)
    while position + 8 <= len(data):
        size, kind = struct.unpack_from("<IH", data, position)
        if kind == TIME_BLOCK and size >= 8 + 8 * header.ImageCount and position + size <= len(data):
            stamps = np.frombuffer(
                data, dtype="<u8", count=header.ImageCount, offset=position + 8
            ) & ~np.uint64(3)
            since = (stamps - np.uint64(header.TriggerTime & ~3)).astype(np.int64)
            return since / 2.0**32
        if size < 8:
            return None
        position += size
    return None


def unpack_10(raw: NDArray[np.uint8], n_pixels: int) -> NDArray[np.uint16]:
    """10 bit codes from four pixels in five bytes, most significant bits first; shape [n_pixels]."""
    groups = -(-n_pixels // 4)
    five = np.zeros((groups, 5), dtype=np.uint16)
    five.reshape(-1)[: raw.size] = raw[: five.size]
    codes = np.empty((groups, 4), dtype=np.uint16)
    codes[:, 0] = five[:, 0] << 2 | five[:, 1] >> 6
    codes[:, 1] = (five[:, 1] & 0x3F) << 4 | five[:, 2] >> 4
    codes[:, 2] = (five[:, 2] & 0x0F) << 6 | five[:, 3] >> 2
    codes[:, 3] = (five[:, 3] & 0x03) << 8 | five[:, 4]
    return codes.reshape(-1)[:n_pixels]


def unpack_12(raw: NDArray[np.uint8], n_pixels: int) -> NDArray[np.uint16]:
    """12 bit values from two pixels in three bytes, most significant bits first; shape [n_pixels]."""
    groups = -(-n_pixels // 2)
    three = np.zeros((groups, 3), dtype=np.uint16)
    three.reshape(-1)[: raw.size] = raw[: three.size]
    values = np.empty((groups, 2), dtype=np.uint16)
    values[:, 0] = three[:, 0] << 4 | three[:, 1] >> 4
    values[:, 1] = (three[:, 1] & 0x0F) << 8 | three[:, 2]
    return values.reshape(-1)[:n_pixels]


@cache
def linearisation_10() -> NDArray[np.uint16]:
    """Linear 12 bit value of each of the 1024 codes of packed 10 bit frames, as cine-handler has it."""
    from cine_reader import unpack_10bit_numpy

    code = np.arange(1024, dtype=np.uint16).reshape(256, 4)
    five = np.empty((256, 5), dtype=np.uint8)
    five[:, 0] = code[:, 0] >> 2
    five[:, 1] = (code[:, 0] & 0x03) << 6 | code[:, 1] >> 4
    five[:, 2] = (code[:, 1] & 0x0F) << 4 | code[:, 2] >> 6
    five[:, 3] = (code[:, 2] & 0x3F) << 2 | code[:, 3] >> 8
    five[:, 4] = code[:, 3] & 0xFF
    return unpack_10bit_numpy(five.tobytes()).astype(np.uint16)


def _linear_10(raw: NDArray[np.uint8], height: int, width: int) -> NDArray[np.uint16]:
    return linearisation_10()[unpack_10(raw, height * width)].reshape(height, width)
