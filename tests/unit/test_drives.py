"""Histories of the plate and of the struck end."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.config.drives import EndMotionDrive, StrikerDrive, VelocityStepDrive
from wrinklewave.dynamics import drives
from wrinklewave.dynamics.boundary import position


def at(motion, times):
    return np.array([position(motion, t) for t in np.atleast_1d(times)])


def striker(velocity=10.0, rise_time=0.5e-3, stop_distance=6.3e-3):
    return StrikerDrive.model_construct(
        kind="striker", velocity=velocity, rise_time=rise_time, stop_distance=stop_distance, friction=0.0
    )


@given(
    velocity=st.floats(0.1, 50),
    distance=st.floats(1e-4, 2e-2),
    share=st.floats(0.0, 1.0),
)
def test_striker_goes_forward_to_its_stop(velocity, distance, share):
    motion = drives.striker(striker(velocity, share * distance / velocity, distance))
    t_stop = (1 + share) * distance / velocity
    U = at(motion, np.linspace(0, 1.2 * t_stop, 400))
    assert U[0] == 0
    assert (np.diff(U) >= -1e-15).all()
    assert U[-1] == pytest.approx(distance, rel=1e-12)
    # speed never exceeds the plate's; the slack is the rounding of differences
    assert np.diff(U).max() <= velocity * 1.2 * t_stop / 399 * (1 + 1e-6)


def test_segments_of_a_motion_join_without_a_jump():
    motion = drives.striker(striker())
    assert motion[1:, 0] == pytest.approx(motion[:-1, 1], abs=1e-15)
    assert motion[1:, 2] == pytest.approx(motion[:-1, 3], abs=1e-15)
    assert motion[1:, 4] == pytest.approx(motion[:-1, 5], abs=1e-9)


def test_sudden_step_moves_at_once():
    drive = VelocityStepDrive.model_construct(kind="velocity-step", velocity=2.0, rise_time=0.0)
    assert at(drives.velocity_step(drive), [0.0, 1e-3, 5.0]) == pytest.approx([0.0, 2e-3, 10.0])


def end_motion(smoothing):
    return EndMotionDrive.model_construct(
        kind="end-motion",
        velocity=10.0,
        stop_distance=6.3e-3,
        overshoot=9e-3,
        overshoot_time=1e-3,
        smoothing=smoothing,
        transverse="free",
    )


def test_smoothed_end_motion_is_the_convolution_of_the_sharp_one():
    # Gaussian convolution of the sharp motion, computed by quadrature
    s = 1e-4
    sharp, smooth = drives.end_motion(end_motion(0.0)), drives.end_motion(end_motion(s))
    shift = drives.SMOOTHING_REACH * s
    tau = np.linspace(-6 * s, 6 * s, 4001)
    weight = np.exp(-((tau / s) ** 2) / 2)
    weight /= weight.sum()
    for t in (0.1e-3, 0.7e-3, 1.5e-3, 2.4e-3):
        expected = weight @ at(sharp, t - shift - tau)
        assert position(smooth, t) == pytest.approx(expected, abs=2e-9)


def test_measured_history_is_followed_and_shifted_to_zero():
    t = np.linspace(1e-3, 3e-3, 201)
    U = 5e-3 + 1e-3 * np.sin(300 * (t - 1e-3))
    motion = drives.measured(t, U, 0.0)
    assert at(motion, t - 1e-3) == pytest.approx(U - U[0], abs=1e-12)


def test_smoothing_a_measured_history_removes_its_noise():
    generator = np.random.default_rng(1)
    t = np.linspace(0, 3e-3, 601)
    clean = 3e-3 * (1 - np.cos(np.pi * t / 3e-3))
    motion = drives.measured(t, clean + 2e-5 * generator.standard_normal(t.size), 5e-5)
    # the smoothed motion starts late by the reach of the Gaussian
    found = at(motion, t[50:550] + drives.SMOOTHING_REACH * 5e-5)
    error = found - (clean - clean[0])[50:550]
    assert np.std(error) < 2e-5 / 3  # 10 samples per width: sqrt(2 sqrt(pi) 10) = 6 times less noise


@given(share=st.floats(0.0, 2.0))
def test_compression_is_a_cosine_between_its_knots_too(share):
    # cubics between 64 knots a half wave: off by (pi/64)^4/384 of the half amplitude at most
    motion = drives.compression(5e-3, 0.1, unload=True)
    expected = 2.5e-3 * (1 - np.cos(np.pi * share))
    assert position(motion, 0.1 * share) == pytest.approx(
        expected, abs=2.5e-3 * (np.pi / 64) ** 4 / 384 * 1.01
    )


@pytest.mark.parametrize(
    ("motion", "end"),
    [
        (drives.striker(striker()), 6.3e-3),
        (drives.end_motion(end_motion(0.0)), 9e-3),
        (drives.end_motion(end_motion(1e-4)), 9e-3),
        (drives.compression(5e-3, 0.1, unload=False), 5e-3),
        (drives.measured(np.linspace(0, 1e-3, 50), np.linspace(0, 2e-3, 50), 0.0), 2e-3),
        (drives.measured(np.linspace(0, 1e-3, 50), np.linspace(0, 2e-3, 50), 2e-5), 2e-3),
    ],
)
def test_what_stops_stays_where_it_is(motion, end):
    last = motion[-1, 0]
    expected = pytest.approx([end] * 4, abs=2e-11)  # smoothed ones leave off at 5 standard deviations
    assert at(motion, last + np.array([0.0, 0.3, 0.8, 2.0])) == expected


def test_compression_returns():
    motion = drives.compression(5e-3, 0.1, unload=True)
    assert at(motion, [0.0, 0.05, 0.1, 0.2, 0.3]) == pytest.approx([0, 2.5e-3, 5e-3, 0, 0], abs=1e-9)
