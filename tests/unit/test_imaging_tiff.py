"""TIFF stacks: every way in which programs write them, whole and damaged."""

from __future__ import annotations

import importlib.util
import struct
import tracemalloc
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import tifffile
from hypothesis import given, settings
from hypothesis import strategies as st

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import ArraySource, FrameError, open_recording
from wrinklewave.imaging.writing import write_recording

WRITERS: dict[str, dict[str, Any]] = {
    "tifffile": {},
    "imagej": {"imagej": True},
    "compressed": {"compression": "zlib"},
    "bigtiff": {"bigtiff": True},
    "plain": {"metadata": None},
    "big-endian": {"byteorder": ">"},
}


def _stack(dtype: type = np.uint16, n: int = 6) -> np.ndarray:
    return np.random.default_rng(0).integers(0, np.iinfo(dtype).max, (n, 32, 48)).astype(dtype)


@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
@pytest.mark.parametrize("writer", list(WRITERS))
def test_whole_stack(tmp_path: Path, writer: str, dtype: type) -> None:
    stack = _stack(dtype)
    tifffile.imwrite(tmp_path / "a.tif", stack, **WRITERS[writer])
    with open_recording(tmp_path / "a.tif") as source:
        assert (source.n_frames, source.shape, source.bit_depth) == (
            6,
            (32, 48),
            8 * np.dtype(dtype).itemsize,
        )
        assert (source.times, source.frame_rate, source.clock, source.unreadable) == (None, None, None, ())
        for index, image in source.frames():
            np.testing.assert_array_equal(image, stack[index])
            assert image.dtype == np.dtype(dtype)


@pytest.mark.parametrize("writer", list(WRITERS))
@pytest.mark.parametrize("share", [0.3, 0.6, 0.95])
def test_cut_short(tmp_path: Path, writer: str, share: float) -> None:
    """What is whole is read, what is not is named; between them they are all frames that can be known of."""
    stack, file = _stack(), tmp_path / "a.tif"
    tifffile.imwrite(file, stack, **WRITERS[writer])
    file.write_bytes(file.read_bytes()[: int(share * file.stat().st_size)])
    with open_recording(file) as source:
        read = [(index, np.array_equal(image, stack[index])) for index, image in source.frames()]
        assert read
        assert all(same for _, same in read)
        assert source.unreadable or share == 0.95  # what was cut off may have been the directories alone
        assert len(read) + len(source.unreadable) == source.n_frames
        if writer != "plain":  # the others say how many frames there were
            assert source.n_frames == 6


def test_pages_between_directories(tmp_path: Path) -> None:
    """Stacks that grow page by page, as a camera's program writes them."""
    stack, file = _stack(), tmp_path / "a.tif"
    with tifffile.TiffWriter(file) as writer:
        for frame in stack:
            writer.write(frame, metadata=None)
    file.write_bytes(file.read_bytes()[: int(0.6 * file.stat().st_size)])
    with open_recording(file) as source:
        assert [index for index, _ in source.frames()] == [0, 1, 2]
        assert [index for index, _ in source.unreadable] == [3, 4]


def test_damaged_data_is_one_frame_lost(tmp_path: Path) -> None:
    stack, file = _stack(), tmp_path / "a.tif"
    tifffile.imwrite(file, stack, compression="zlib")
    with tifffile.TiffFile(file) as tiff:
        place = tiff.pages[2].dataoffsets[0]  # type: ignore[union-attr]
    data = bytearray(file.read_bytes())
    data[place + 100 : place + 200] = bytes(100)
    file.write_bytes(data)
    with open_recording(file) as source:
        assert [index for index, _ in source.frames()] == [0, 1, 3, 4, 5]
        assert [index for index, _ in source.unreadable] == [2]
        with pytest.raises(FrameError, match="frame 2 cannot be read"):
            source.frame(2)


def test_another_size_is_one_frame_lost(tmp_path: Path) -> None:
    with tifffile.TiffWriter(tmp_path / "a.tif") as writer:
        for width in (48, 48, 40, 48):
            writer.write(np.zeros((32, width), np.uint8), metadata=None)
    with open_recording(tmp_path / "a.tif") as source:
        assert [index for index, _ in source.frames()] == [0, 1, 3]


@pytest.mark.parametrize("planar", ["contig", "separate"])
def test_colour_by_its_luma(tmp_path: Path, planar: str) -> None:
    colour = np.random.default_rng(0).integers(0, 256, (3, 16, 20, 3)).astype(np.uint8)
    pages = colour if planar == "contig" else np.moveaxis(colour, -1, 1)
    tifffile.imwrite(tmp_path / "a.tif", pages, photometric="rgb", planarconfig=planar)
    expected = np.rint(colour @ [0.299, 0.587, 0.114])
    with open_recording(tmp_path / "a.tif") as source:
        assert source.n_frames == 3
        images = np.stack([image for _, image in source.frames()])
        assert any("colour" in note for note in source.notes)
    assert np.abs(images - expected).max() <= 1  # rounding of exact halves


def test_frame_rate_of_imagej(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.tif", _stack(), imagej=True, metadata={"finterval": 2e-5})
    with open_recording(tmp_path / "a.tif") as source:
        assert source.clock == "camera"
        assert source.frame_rate == pytest.approx(5e4)
        assert source.times is not None
        np.testing.assert_allclose(source.times, np.arange(6) * 2e-5)


@pytest.mark.parametrize(
    ("content", "expected"),
    [
        (b"", "is empty"),
        (b"II*\0", "cannot be read"),
        (b"II*\0\x08\0\0\0", "cannot be read"),
        (b"MM\0*\0\0\xff\xff" + bytes(40), "cannot be read"),
    ],
)
def test_what_only_begins_like_a_tiff(tmp_path: Path, content: bytes, expected: str) -> None:
    (tmp_path / "a.tif").write_bytes(content)
    with pytest.raises(InputError, match=expected):
        open_recording(tmp_path / "a.tif")


@pytest.mark.parametrize("kind", [np.float32, np.uint32, np.int16])
def test_other_kinds_of_numbers_are_refused(tmp_path: Path, kind: type) -> None:
    tifffile.imwrite(tmp_path / "a.tif", np.zeros((5, 8, 9), kind))
    with pytest.raises(InputError, match="8 or 16 bit"):
        open_recording(tmp_path / "a.tif")


def test_a_compression_that_needs_another_package(tmp_path: Path) -> None:
    """Either it is installed and the frames are read, or the error names it."""
    from PIL import Image as Picture

    stack = _stack(np.uint8, 3)
    first, *others = (Picture.fromarray(image) for image in stack)
    first.save(tmp_path / "a.tif", save_all=True, append_images=others, compression="tiff_lzw")
    if importlib.util.find_spec("imagecodecs") is None:
        with pytest.raises(InputError, match="pip install imagecodecs"):
            open_recording(tmp_path / "a.tif")
        return
    with open_recording(tmp_path / "a.tif") as source:
        np.testing.assert_array_equal(np.stack([image for _, image in source.frames()]), stack)


def test_no_frame_left(tmp_path: Path) -> None:
    file = tmp_path / "a.tif"
    tifffile.imwrite(file, _stack())
    file.write_bytes(file.read_bytes()[:300])
    with pytest.raises(InputError, match="none of its"):
        open_recording(file)


@given(keep=st.integers(0, 20000))
@settings(max_examples=60, deadline=None)
def test_any_cut_gives_frames_or_a_clear_error(tmp_path_factory: pytest.TempPathFactory, keep: int) -> None:
    stack, file = _stack(), tmp_path_factory.mktemp("cut") / "a.tif"
    tifffile.imwrite(file, stack)
    file.write_bytes(file.read_bytes()[:keep])
    try:
        with open_recording(file) as source:
            for index, image in source.frames():
                np.testing.assert_array_equal(image, stack[index])
    except InputError:
        assert keep < 4000  # not even the first frame is whole


@pytest.mark.parametrize(
    ("bits", "dtype"), [(8, np.uint8), (10, np.uint16), (12, np.uint16), (16, np.uint16)]
)
def test_written_and_read_back(tmp_path: Path, bits: int, dtype: type) -> None:
    stack = (_stack(np.uint16) >> (16 - bits)).astype(dtype)
    write_recording(ArraySource(stack, bit_depth=bits, frame_rate=5e4), tmp_path / "b.tif")
    with open_recording(tmp_path / "b.tif") as source:
        assert (source.bit_depth, source.white_level, source.frame_rate) == (bits, (1 << bits) - 1, 5e4)
        np.testing.assert_array_equal(np.stack([image for _, image in source.frames()]), stack)


def _sparse_stack(file: Path, n_frames: int, height: int, width: int) -> None:
    """A BigTIFF of one directory and many frames after it, as tifffile describes one; its data are a hole."""
    description = f'{{"shape": [{n_frames}, {height}, {width}]}}'.encode() + b"\0"
    offset = 4096
    tags = [
        (256, 3, 1, width),
        (257, 3, 1, height),
        (258, 3, 1, 16),
        (259, 3, 1, 1),
        (262, 3, 1, 1),
        (270, 2, len(description), 2048),
        (273, 16, 1, offset),
        (277, 3, 1, 1),
        (278, 3, 1, height),
        (279, 16, 1, 2 * height * width),
    ]
    directory = struct.pack("<Q", len(tags)) + b"".join(struct.pack("<HHQQ", *tag) for tag in tags)
    with file.open("wb") as raw:
        raw.write(b"II+\0" + struct.pack("<HHQ", 8, 0, 16) + directory + struct.pack("<Q", 0))
        raw.seek(2048)
        raw.write(description)
        for index in (0, n_frames // 2, n_frames - 1):
            raw.seek(offset + 2 * height * width * index)
            raw.write(struct.pack("<H", 1000 + index % 1000))
        raw.truncate(offset + 2 * height * width * n_frames)


def test_twenty_gigabytes_within_the_memory_of_a_few_frames(tmp_path: Path) -> None:
    """The file is sparse, so that it costs no disk; the reader cannot know that."""
    n_frames, height, width = 31000, 256, 1280
    file = tmp_path / "big.tif"
    _sparse_stack(file, n_frames, height, width)
    assert file.stat().st_size > 20e9
    tracemalloc.start()
    with open_recording(file) as source:
        assert source.n_frames == n_frames
        for index in (0, n_frames // 2, n_frames - 1):
            assert source.frame(index)[0, 0] == 1000 + index % 1000
        for _, image in source.frames(step=500):
            assert image.shape == (height, width)
        peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert peak < 20 * (2 * height * width)
