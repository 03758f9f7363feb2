"""Wires at rest are known as well as an image lets them be known."""

from __future__ import annotations

import numpy as np
import pytest

from wrinklewave.imaging.appearance import learn_appearance
from wrinklewave.imaging.bars import foot_bound, row_bound
from wrinklewave.imaging.camera import Camera, Wires, film
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.imaging.tracks import track_wires
from wrinklewave.imaging.wires import clearance_of_wires, learn_wires
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

SCALE, RATIO, N_FRAMES = 20e3, 20.0, 80
PULSE = TravellingPulse(
    length=20e-3, half_height=6e-3, n_points=101, end_time=0.1e-3, travel=2e-3, front_speed=60.0
)
SHARED = 11  # frames that share a wire's inclination


@pytest.mark.parametrize(("blur", "allowed"), [(0.5, 1.15), (1.2, 1.2), (2.0, 1.25), (3.0, 1.4)])
def test_the_scatter_of_wires_at_rest_is_near_the_bound(blur: float, allowed: float) -> None:
    """``allowed`` is for a known surface; beside a wire it is not known, and the lowest rows are left out."""
    camera = Camera.framing(PULSE.surface(), scale=SCALE, blur=blur).at_contrast_to_noise(RATIO)
    recording = film(
        PULSE.surface(), camera, wires=Wires(X=(4e-3, 8e-3, 12e-3, 16e-3)), frames_before=N_FRAMES
    )
    frames = [recording.frame(i) for i in range(N_FRAMES)]
    appearance = learn_appearance(frames[::5], frames[::20])
    look = learn_wires(np.mean(frames[::5], axis=0).astype(np.float32), appearance, count=4)
    measurer = FrameMeasurer(appearance, wires=look)
    tracks = track_wires([measurer.measure(frame).wires for frame in frames], look)
    assert tracks.gaps == ()
    levels = camera.levels
    height = (levels.wire - levels.background) / (levels.sample - levels.background)
    wire = (RATIO, height, 0.15e-3 * SCALE, 0.8e-3 * SCALE, blur, SHARED)
    inner = tracks.column[SHARED:-SHARED]
    scatter = np.sqrt(inner.var(axis=0).mean())
    assert scatter / foot_bound(*wire) < allowed
    assert 0.9 < scatter / foot_bound(*wire, lowest=clearance_of_wires(blur)) < 1.15
    assert inner.std(axis=0).mean() / np.median(tracks.sigma[SHARED:-SHARED]) == pytest.approx(1.0, abs=0.2)
    np.testing.assert_allclose(np.diff(inner.mean(axis=0)), 80.0, atol=1.5 * scatter)


def test_the_bound_of_a_wide_bar_is_that_of_two_steps_and_of_a_narrow_one_that_of_a_line() -> None:
    step = np.sqrt(2.0 * np.sqrt(np.pi * (1.5**2 + 1 / 12))) / RATIO
    assert row_bound(RATIO, 1.0, 40.0, 1.5) == pytest.approx(step / np.sqrt(2.0), rel=2e-3)
    # of a line of width w much below the blur v: h^2 w^2/(4 sqrt(pi) v^3)
    line = np.sqrt(4.0 * np.sqrt(np.pi) * (4.0 + 1 / 12) ** 1.5) / (RATIO * 0.4)
    assert row_bound(RATIO, 1.0, 0.4, 2.0) == pytest.approx(line, rel=1e-2)
    one, eleven = (foot_bound(RATIO, 1.0, 3.0, 60.0, 1.0, frames) for frames in (1, 11))
    assert one / row_bound(RATIO, 1.0, 3.0, 1.0) == pytest.approx(2.0 / np.sqrt(60.0), rel=0.03)
    assert eleven / one == pytest.approx(np.sqrt((1.0 + 3.0 / 11.0) / 4.0), rel=0.01)
