"""AVI, MP4 and MOV: depth, range, random access, damage."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import ArraySource, open_recording
from wrinklewave.imaging.writing import write_recording

av = pytest.importorskip("av")

N_FRAMES = 24


def _stack(bits: int, n: int = N_FRAMES) -> np.ndarray:
    """A moving grey ramp with noise on it."""
    rng = np.random.default_rng(3)
    ramp = np.linspace(0.1, 0.8, 96)[None, :] * np.linspace(0.4, 1.0, 64)[:, None]
    frames = np.stack([np.roll(ramp, 2 * index, axis=1) for index in range(n)])
    noisy = frames + rng.uniform(0, 0.05, frames.shape)
    return (noisy * ((1 << bits) - 1)).astype(np.uint8 if bits == 8 else np.uint16)


@pytest.mark.parametrize(
    ("ending", "bits"),
    [("avi", 8), ("avi", 10), ("avi", 12), ("avi", 16), ("mp4", 8), ("mp4", 10), ("mov", 8)],
)
def test_written_and_read_back(tmp_path: Path, ending: str, bits: int) -> None:
    stack, file = _stack(bits), tmp_path / f"a.{ending}"
    write_recording(ArraySource(stack, bit_depth=bits), file, threads=2)
    with open_recording(file) as source:
        assert (source.n_frames, source.shape, source.bit_depth) == (N_FRAMES, (64, 96), bits)
        assert (source.black_level, source.white_level) == (0, (1 << bits) - 1)
        assert (source.clock, source.frame_rate) == ("playback", 30.0)
        for index, image in source.frames():
            np.testing.assert_array_equal(image, stack[index])
        for index in (17, 3, 3, 4, 23, 0, -1):
            np.testing.assert_array_equal(source.frame(index), stack[index])
        assert [index for index, _ in source.frames(2, 20, 5)] == [2, 7, 12, 17]


def test_a_depth_that_the_format_cannot_keep(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="8, 10 bit"):
        write_recording(ArraySource(_stack(12), bit_depth=12), tmp_path / "a.mp4")
    assert list(tmp_path.iterdir()) == []
    with pytest.raises(InputError, match="unknown ending"):
        write_recording(ArraySource(_stack(8)), tmp_path / "a.gif")


def _encode(file: Path, stack: np.ndarray, codec: str, pixels: str, options: dict[str, str]) -> None:
    with av.open(str(file), "w") as output:
        stream = output.add_stream(codec, rate=30, options=options)
        stream.width, stream.height, stream.pix_fmt = stack.shape[2], stack.shape[1], pixels
        for index, image in enumerate(stack):
            colour = np.repeat(image[..., None], 3, axis=2)
            frame = av.VideoFrame.from_ndarray(colour, format="rgb24")
            frame.pts = index
            output.mux(stream.encode(frame))
        output.mux(stream.encode(None))


@pytest.mark.parametrize("pixels", ["bgr24", "gray"])
def test_uncompressed_avi(tmp_path: Path, pixels: str) -> None:
    """What most high-speed cameras export; grey stored as colour comes back unchanged."""
    stack = _stack(8)
    _encode(tmp_path / "a.avi", stack, "rawvideo", pixels, {})
    with open_recording(tmp_path / "a.avi") as source:
        assert source.white_level == 255
        for index, image in source.frames():
            np.testing.assert_array_equal(image, stack[index])


def test_frames_in_another_order_than_in_the_file(tmp_path: Path) -> None:
    """H.264 with B frames: stored out of order, found by their times; the limited range is known."""
    stack = _stack(8)
    _encode(tmp_path / "a.mp4", stack, "libx264", "yuv420p", {"crf": "1", "g": "8", "bf": "3"})
    with open_recording(tmp_path / "a.mp4") as source:
        assert (source.n_frames, source.black_level, source.white_level) == (N_FRAMES, 16, 235)
        forward = {index: image.copy() for index, image in source.frames()}
        assert sorted(forward) == list(range(N_FRAMES))
        for index in (20, 5, 6, 13, 2, 23):
            np.testing.assert_array_equal(source.frame(index), forward[index])
        # grey 0..255 is stored as 16..235, and loses a little
        full = (np.stack([forward[index] for index in range(N_FRAMES)]) - 16.0) * 255 / 219
        assert np.abs(full - stack).mean() < 2


@pytest.mark.parametrize("codec", ["rawvideo", "mjpeg", "ffv1"])
def test_avi_cut_short(tmp_path: Path, codec: str) -> None:
    file, stack = tmp_path / "a.avi", _stack(8)
    if codec == "ffv1":
        write_recording(ArraySource(stack), file)
    else:
        _encode(file, stack, codec, "gray" if codec == "rawvideo" else "yuvj420p", {})
    with open_recording(file) as source:
        whole = [image.copy() for _, image in source.frames()]
    file.write_bytes(file.read_bytes()[: int(0.6 * file.stat().st_size)])
    with open_recording(file) as source:
        read = dict(source.frames())
        assert source.n_frames == N_FRAMES
        assert 8 < len(read) < 18
        assert list(read) == list(range(len(read)))
        assert [index for index, _ in source.unreadable] == list(range(len(read), N_FRAMES))
        for index, image in read.items():
            np.testing.assert_array_equal(image, whole[index])


def test_damage_in_the_middle_of_a_checksummed_video(tmp_path: Path) -> None:
    """FFV1 notices; each frame stands by itself, so that only the damaged one is lost."""
    file, stack = tmp_path / "a.avi", _stack(8)
    write_recording(ArraySource(stack), file)
    data = bytearray(file.read_bytes())
    middle = len(data) // 2
    data[middle : middle + 40] = bytes(byte ^ 0x5A for byte in data[middle : middle + 40])
    file.write_bytes(data)
    with open_recording(file) as source:
        read = dict(source.frames())
        assert len(source.unreadable) == 1
        assert len(read) == N_FRAMES - 1
        for index, image in read.items():
            np.testing.assert_array_equal(image, stack[index])
        lost = source.unreadable[0][0]
        np.testing.assert_array_equal(source.frame(lost + 1), stack[lost + 1])


def test_mp4_without_its_index(tmp_path: Path) -> None:
    file = tmp_path / "a.mp4"
    write_recording(ArraySource(_stack(8)), file)
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with pytest.raises(InputError, match="index of an MP4 or MOV") as caught:
        open_recording(file)
    assert caught.value.file == file


def test_sound_is_no_recording(tmp_path: Path) -> None:
    with av.open(str(tmp_path / "a.mkv"), "w") as output:
        stream = output.add_stream("pcm_s16le", rate=8000)
        frame = av.AudioFrame.from_ndarray(np.zeros((1, 800), np.int16), layout="mono")
        frame.sample_rate = 8000
        output.mux(stream.encode(frame))
    with pytest.raises(InputError, match="no pictures"):
        open_recording(tmp_path / "a.mkv")
