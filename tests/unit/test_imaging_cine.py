"""Phantom recordings, written by the test itself in every layout."""

from __future__ import annotations

import struct
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import FrameError, open_recording

pytest.importorskip("cine_reader")

SIZES = [(4, 8), (5, 7), (3, 10)]
SETUP_LENGTH = 10684
LAYOUTS = {"8": (8, 0, 8), "16": (16, 0, 12), "10 packed": (16, 256, 10), "12 packed": (16, 1024, 12)}
"""Name -> bits of the bitmap header, its compression, significant bits."""


def write_cine(
    path: Path,
    frames: NDArray[np.uint16],
    *,
    layout: str,
    frame_rate: float = 50e3,
    first_frame: int = -3,
    time_stamps: NDArray[np.float64] | None = None,
    decimation: float = 1.0,
    levels: tuple[int, int] = (64, 4064),
    significant_bits: int | None = None,
) -> None:
    """Write frames [n, height, width] of raw values (10 bit codes for the packed 10 bit layout)."""
    bits, compression, real_bits = LAYOUTS[layout]
    n_frames, height, width = frames.shape
    payloads = [_payload(frame, layout) for frame in frames]
    trigger = 1_500_000_000 << 32
    tagged = b"" if time_stamps is None else _time_block(time_stamps, trigger)
    off_offsets = 84 + SETUP_LENGTH + len(tagged)
    first = off_offsets + 8 * n_frames
    starts = [first + index * (8 + len(payloads[0])) for index in range(n_frames)]
    header = b"CI" + struct.pack(
        "<HHHiIiIIIIQ", 44, 0, 1, first_frame, n_frames, first_frame, n_frames, 44, 84, off_offsets, trigger
    )
    bitmap = struct.pack(
        "<IiiHHIIiiII", 40, width, height, 1, bits, compression, len(payloads[0]), 0, 0, 0, 4096
    )
    setup = bytearray(SETUP_LENGTH)
    struct.pack_into("<H", setup, 142, SETUP_LENGTH)
    struct.pack_into("<I", setup, 768, int(frame_rate))
    struct.pack_into("<I", setup, 896, significant_bits or real_bits)
    struct.pack_into("<I", setup, 1568, 5000)  # exposure in nanoseconds
    struct.pack_into("<ii", setup, 5732, *levels)
    struct.pack_into("<f", setup, 10388, decimation)
    struct.pack_into("<d", setup, 10400, frame_rate)
    with path.open("wb") as file:
        file.write(header + bitmap + bytes(setup) + tagged + struct.pack(f"<{n_frames}Q", *starts))
        for payload in payloads:
            file.write(struct.pack("<II", 8, len(payload)) + payload)


def _time_block(stamps: NDArray[np.float64], trigger: int) -> bytes:
    """TIME64 of each frame; the two lowest bits are flags that have no part in the time."""
    times = [trigger + (round(stamp * 2**32) & ~3) + 3 for stamp in stamps.tolist()]
    other = struct.pack("<IHH", 12, 1000, 0) + b"abcd"
    return other + struct.pack(f"<IHH{len(times)}Q", 8 + 8 * len(times), 1002, 0, *times)


def _payload(frame: NDArray[np.uint16], layout: str) -> bytes:
    if layout == "8":
        return _padded_rows(frame[::-1].astype("u1"))
    if layout == "16":
        return _padded_rows(frame[::-1].astype("<u2"))
    return _packed(frame, 10 if layout == "10 packed" else 12)


def _padded_rows(frame: NDArray[np.unsignedinteger]) -> bytes:
    rows = [row.tobytes() for row in frame]
    return b"".join(row + bytes(-len(row) % 4) for row in rows)


def _packed(frame: NDArray[np.uint16], bits: int) -> bytes:
    """One long number, most significant pixel first, filled up with zeros to whole bytes."""
    text = "".join(format(int(value), f"0{bits}b") for value in frame.ravel())
    text += "0" * (-len(text) % 8)
    return int(text, 2).to_bytes(len(text) // 8, "big")


def _frames(layout: str, shape: tuple[int, int], n: int = 6) -> np.ndarray:
    bits = {"8": 8, "16": 12, "10 packed": 10, "12 packed": 12}[layout]
    return np.random.default_rng(1).integers(0, 1 << bits, (n, *shape), dtype=np.uint16)


@pytest.mark.parametrize("shape", SIZES)
@pytest.mark.parametrize("layout", ["8", "16", "12 packed"])
def test_values_depth_and_orientation(tmp_path: Path, layout: str, shape: tuple[int, int]) -> None:
    frames = _frames(layout, shape)
    write_cine(tmp_path / "a.cine", frames, layout=layout)
    with open_recording(tmp_path / "a.cine") as source:
        assert (source.n_frames, source.shape, source.unreadable) == (6, shape, ())
        assert source.bit_depth == LAYOUTS[layout][2]
        assert source.dtype == (np.uint8 if layout == "8" else np.uint16)
        for index, image in source.frames():
            np.testing.assert_array_equal(image, frames[index])
            assert image.dtype == source.dtype


@pytest.mark.parametrize("shape", SIZES)
def test_packed_10_bit_is_linearised(tmp_path: Path, shape: tuple[int, int]) -> None:
    frames = _frames("10 packed", shape)
    write_cine(tmp_path / "a.cine", frames, layout="10 packed")
    with open_recording(tmp_path / "a.cine") as source:
        assert (source.bit_depth, source.black_level, source.white_level) == (12, 64, 4064)
        images = np.stack([image for _, image in source.frames()])
    # the camera's curve grows, starts near zero and ends near the top of twelve bits
    codes, values = frames.ravel(), images.ravel()
    order = np.argsort(codes, kind="stable")
    assert (np.diff(values[order].astype(int)) >= 0).all()
    for code in np.unique(codes):
        assert np.unique(values[codes == code]).size == 1


def test_linearisation_spans_twelve_bits() -> None:
    from wrinklewave.imaging.sources.cine import linearisation_10

    table = linearisation_10().astype(int)
    assert table.shape == (1024,)
    assert (np.diff(table) >= 0).all()
    assert table[0] < 8
    assert 4064 <= table[-1] <= 4095
    # steps grow with the light, as the noise does: the reason for the curve
    assert np.diff(table)[-100:].mean() > 4 * np.diff(table)[:100].mean()


def test_levels_and_significant_bits_come_from_the_setup(tmp_path: Path) -> None:
    write_cine(
        tmp_path / "a.cine", _frames("16", (4, 8)), layout="16", levels=(32, 1000), significant_bits=10
    )
    with open_recording(tmp_path / "a.cine") as source:
        assert (source.bit_depth, source.black_level, source.white_level) == (10, 32, 1000)


def test_impossible_levels_are_ignored(tmp_path: Path) -> None:
    write_cine(tmp_path / "a.cine", _frames("16", (4, 8)), layout="16", levels=(64, 9999))
    with open_recording(tmp_path / "a.cine") as source:
        assert (source.black_level, source.white_level) == (0, 4095)


def test_times_from_the_rate(tmp_path: Path) -> None:
    write_cine(tmp_path / "a.cine", _frames("16", (4, 8)), layout="16", frame_rate=20e3, first_frame=-2)
    with open_recording(tmp_path / "a.cine") as source:
        assert (source.frame_rate, source.clock) == (20e3, "camera")
        assert source.times is not None
        np.testing.assert_allclose(source.times, (np.arange(6) - 2) / 20e3, rtol=0, atol=1e-15)


def test_time_stamps_count_more_than_the_rate(tmp_path: Path) -> None:
    stamps = np.array([-1e-4, 0.0, 1.01e-4, 2e-4, 3e-4, 4.5e-4])
    write_cine(tmp_path / "a.cine", _frames("16", (4, 8)), layout="16", frame_rate=50e3, time_stamps=stamps)
    with open_recording(tmp_path / "a.cine") as source:
        assert source.times is not None
        np.testing.assert_allclose(source.times, stamps, rtol=0, atol=2e-9)  # 2**-30 s and the two flag bits
        assert source.frame_rate == 50e3
        assert any("time stamps" in note for note in source.notes)


def test_saved_every_tenth_frame(tmp_path: Path) -> None:
    write_cine(tmp_path / "a.cine", _frames("16", (4, 8)), layout="16", frame_rate=90e3, decimation=10.0)
    with open_recording(tmp_path / "a.cine") as source:
        assert source.frame_rate == pytest.approx(9e3)
        assert any("10th" in note for note in source.notes)


@pytest.mark.parametrize("layout", list(LAYOUTS))
def test_cut_short_names_the_missing_frames(tmp_path: Path, layout: str) -> None:
    file = tmp_path / "a.cine"
    write_cine(file, _frames(layout, (4, 8)), layout=layout)
    whole = file.read_bytes()
    frame_bytes = (len(whole) - 84 - 10684 - 48) // 6
    file.write_bytes(whole[: -2 * frame_bytes - frame_bytes // 2])
    with open_recording(file) as source:
        assert source.n_frames == 6
        assert [index for index, _ in source.unreadable] == [3, 4, 5]
        assert [index for index, _ in source.frames()] == [0, 1, 2]
        with pytest.raises(FrameError, match="frame 4"):
            source.frame(4)


def test_damaged_frame_header_is_one_frame_lost(tmp_path: Path) -> None:
    file = tmp_path / "a.cine"
    write_cine(file, _frames("16", (4, 8)), layout="16")
    data = bytearray(file.read_bytes())
    start = 84 + 10684 + 48 + 2 * (8 + 64)
    data[start : start + 4] = b"\0\0\0\0"
    file.write_bytes(data)
    with open_recording(file) as source:
        assert [index for index, _ in source.frames()] == [0, 1, 3, 4, 5]
        assert source.unreadable == ((2, "its header is damaged"),)


@pytest.mark.parametrize("length", [16, 60, 200, 10000, 84 + 10684 + 20])
def test_cut_within_the_headers(tmp_path: Path, length: int) -> None:
    file = tmp_path / "a.cine"
    write_cine(file, _frames("16", (4, 8)), layout="16")
    file.write_bytes(file.read_bytes()[:length])
    with pytest.raises(InputError, match=r"a\.cine"):
        open_recording(file)


def test_colour_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "a.cine"
    write_cine(file, _frames("16", (4, 8)), layout="16")
    data = bytearray(file.read_bytes())
    data[44 + 14 : 44 + 16] = (24).to_bytes(2, "little")
    file.write_bytes(data)
    with pytest.raises(InputError, match="colour"):
        open_recording(file)
