"""The frame source protocol, folders of images, and files that are no recordings."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tifffile
from PIL import Image as Picture

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import ArraySource, open_recording, recording_times


def _stack(n: int = 5, dtype: type = np.uint16) -> np.ndarray:
    return np.random.default_rng(0).integers(0, np.iinfo(dtype).max, (n, 12, 16)).astype(dtype)


def test_array_source() -> None:
    stack = _stack()
    source = ArraySource(stack, bit_depth=12, frame_rate=1e4)
    assert (source.n_frames, source.shape, source.white_level, source.dtype) == (5, (12, 16), 4095, np.uint16)
    assert source.times is not None
    np.testing.assert_allclose(source.times, np.arange(5) * 1e-4)
    np.testing.assert_array_equal(source.frame(-1), stack[4])
    assert [index for index, _ in source.frames(1, None, 2)] == [1, 3]
    assert [index for index, _ in source.frames(stop=2)] == [0, 1]
    with pytest.raises(IndexError):
        source.frame(5)


@pytest.mark.parametrize("stack", [np.zeros((3, 4)), np.zeros((3, 4, 5)), np.zeros((3, 4), np.uint8)])
def test_array_source_refuses_other_arrays(stack: np.ndarray) -> None:
    with pytest.raises(InputError, match="uint8 or uint16"):
        ArraySource(stack)  # type: ignore[arg-type]


def test_times_need_a_rate_of_the_camera() -> None:
    source = ArraySource(_stack())
    np.testing.assert_allclose(recording_times(source, 100.0), np.arange(5) / 100)
    with pytest.raises(InputError, match="no frame rate") as caught:
        recording_times(source)
    assert caught.value.key == "video.frame_rate"
    source.frame_rate, source.clock, source.times = 30.0, "playback", np.arange(5) / 30
    with pytest.raises(InputError, match="only a playback rate of 30"):
        recording_times(source)


def _write_image(file: Path, image: np.ndarray) -> None:
    if file.suffix == ".png":
        Picture.fromarray(image).save(file)
    else:
        tifffile.imwrite(file, image)


@pytest.mark.parametrize("ending", [".png", ".tif"])
@pytest.mark.parametrize("dtype", [np.uint8, np.uint16])
def test_folder_in_natural_order(tmp_path: Path, ending: str, dtype: type) -> None:
    stack = _stack(12, dtype)
    for index, image in enumerate(stack):
        _write_image(tmp_path / f"frame_{index}{ending}", image)
    (tmp_path / "notes.txt").write_text("not an image")
    with open_recording(tmp_path) as source:
        assert (source.n_frames, source.shape, source.bit_depth) == (
            12,
            (12, 16),
            8 * np.dtype(dtype).itemsize,
        )
        assert source.notes == ()
        for index, image in source.frames():
            np.testing.assert_array_equal(image, stack[index])


def test_folder_with_damaged_and_odd_images(tmp_path: Path) -> None:
    for index, image in enumerate(_stack(7, np.uint8)):
        _write_image(tmp_path / f"{index}.png", image)
    (tmp_path / "0.png").write_bytes(b"")
    (tmp_path / "2.png").write_bytes((tmp_path / "2.png").read_bytes()[:60])
    (tmp_path / "3.png").write_bytes(b"no image at all, only a name")
    _write_image(tmp_path / "4.png", np.zeros((12, 17), np.uint8))
    _write_image(tmp_path / "5.png", np.zeros((12, 16), np.uint16))
    with open_recording(tmp_path) as source:
        assert [index for index, _ in source.frames()] == [1, 6]
        reasons = dict(source.unreadable)
    assert sorted(reasons) == [0, 2, 3, 4, 5]
    assert all(f"{index}.png" in reason for index, reason in reasons.items())


def test_folder_with_gaps_in_the_numbers(tmp_path: Path) -> None:
    for index in (1, 2, 5):
        _write_image(tmp_path / f"img{index:04d}.tif", np.zeros((4, 4), np.uint8))
    with open_recording(tmp_path) as source:
        assert any("2 gaps" in note for note in source.notes)


def test_colour_png(tmp_path: Path) -> None:
    grey = np.random.default_rng(0).integers(0, 256, (12, 16)).astype(np.uint8)
    _write_image(tmp_path / "a.png", np.repeat(grey[..., None], 3, axis=2))
    with open_recording(tmp_path) as source:
        np.testing.assert_array_equal(source.frame(0), grey)  # grey stored as colour is unchanged
        assert any("colour" in note for note in source.notes)


def test_folder_without_images(tmp_path: Path) -> None:
    (tmp_path / "notes.txt").write_text("nothing here")
    with pytest.raises(InputError, match="holds no images"):
        open_recording(tmp_path)


def test_folder_of_damaged_images(tmp_path: Path) -> None:
    (tmp_path / "a.png").write_bytes(b"xyz")
    with pytest.raises(InputError, match="none of its 1 images"):
        open_recording(tmp_path)


def test_no_such_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be opened"):
        open_recording(tmp_path / "missing.tif")


@pytest.mark.parametrize("content", [b"", b"x", b"Dear reader, this is a letter.\n" * 40, bytes(5000)])
@pytest.mark.parametrize("name", ["letter.txt", "letter.avi", "letter.tif", "letter.cine", "letter.mp4"])
def test_files_that_are_no_recordings(tmp_path: Path, name: str, content: bytes) -> None:
    (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=name):
        open_recording(tmp_path / name)
