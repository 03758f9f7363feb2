"""Recordings of real cameras, where they lie beside the repository (or where a variable says)."""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np
import pytest

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import open_recording, recording_times
from wrinklewave.imaging.inspection import facts, histogram

BESIDE = Path(__file__).parents[2].parent / "shared" / "data"
RECORDINGS = Path(os.environ.get("WRINKLEWAVE_RECORDINGS", BESIDE))

pytestmark = pytest.mark.skipif(not RECORDINGS.is_dir(), reason="no real recordings here")


def test_phantom() -> None:
    pytest.importorskip("cine_reader")
    with open_recording(RECORDINGS / "phantom_15_frames_256x256.cine") as source:
        assert (source.n_frames, source.shape, source.bit_depth) == (15, (256, 256), 12)
        assert (source.black_level, source.white_level, source.clock) == (64, 4064, "camera")
        # the setup says 90,000 per second, of which every tenth was saved; the time stamps agree to 0.04 %
        assert source.frame_rate == pytest.approx(9000.0)
        times = recording_times(source)
        np.testing.assert_allclose(np.diff(times), 1 / 9003.3, rtol=1e-4)
        assert times[0] == pytest.approx(-0.6016727, abs=1e-6)
        images = np.stack([image for _, image in source.frames()])
        assert images.dtype == np.uint16
        # the bright field above and beside the object, its dark stem from below
        assert images[:, :40, :40].mean() > 2500
        assert images[:, 230:, 115:135].min() < 300
        assert images.max() < 4064


def test_tiff() -> None:
    import tifffile

    file = RECORDINGS / "tiff_stack_stuck_particles.tif"
    with open_recording(file) as source:
        assert (source.n_frames, source.shape, source.bit_depth) == (5, (512, 512), 16)
        assert source.times is None
        images = np.stack([image for _, image in source.frames()])
    np.testing.assert_array_equal(images, tifffile.imread(file))


def test_quicktime() -> None:
    pytest.importorskip("av")
    with open_recording(RECORDINGS / "quicktime_bulk_water.mov") as source:
        assert (source.n_frames, source.shape, source.bit_depth) == (480, (424, 640), 8)
        assert (source.clock, source.unreadable) == ("playback", ())
        assert source.frame_rate == pytest.approx(24000 / 1001)
        assert source.times is not None
        np.testing.assert_allclose(np.diff(source.times), 1001 / 24000, rtol=1e-9)
        assert [index for index, _ in source.frames(0, 480, 60)] == list(range(0, 480, 60))
        with pytest.raises(InputError, match="playback rate of 23"):
            recording_times(source)


@pytest.mark.parametrize("share", [0.3, 0.5, 0.75])
@pytest.mark.parametrize("name", ["phantom_15_frames_256x256.cine", "tiff_stack_stuck_particles.tif"])
def test_cut_short(tmp_path: Path, name: str, share: float) -> None:
    whole = RECORDINGS / name
    copy = tmp_path / name
    copy.write_bytes(whole.read_bytes()[: int(share * whole.stat().st_size)])
    with open_recording(whole) as complete, open_recording(copy) as source:
        read = dict(source.frames())
        assert source.n_frames == complete.n_frames
        assert list(read) == list(range(int(share * complete.n_frames)))
        assert [index for index, _ in source.unreadable] == list(range(len(read), complete.n_frames))
        for index, image in read.items():
            np.testing.assert_array_equal(image, complete.frame(index))
        assert f"{len(read)} (" in facts(source, histogram(source))["unreadable"]


def test_quicktime_cut_short(tmp_path: Path) -> None:
    whole = (RECORDINGS / "quicktime_bulk_water.mov").read_bytes()
    (tmp_path / "a.mov").write_bytes(whole[: len(whole) // 2])
    with pytest.raises(InputError, match="index of an MP4 or MOV file stands at its end"):
        open_recording(tmp_path / "a.mov")
