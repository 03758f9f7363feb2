"""Histories of the plate or of the struck end, as piecewise cubics.

Each is an array [n_segments, 6]: t0, t1 [s], U0, U1 [m], V0, V1 [m/s].
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from wrinklewave.config.drives import EndMotionDrive, StrikerDrive, VelocityStepDrive

    Function = Callable[[NDArray[np.float64]], NDArray[np.float64]]

RAMP_SEGMENTS = 64
SMOOTHING_REACH = 5.0
"""Standard deviations of Gaussian smoothing by which a smoothed motion starts late, so that it starts at rest."""


def cubic_segments(t: NDArray[np.float64], U: Function, V: Function) -> NDArray[np.float64]:
    """Hermite segments between the knots ``t`` of a motion U(t) with velocity V(t)."""
    return np.column_stack([t[:-1], t[1:], U(t[:-1]), U(t[1:]), V(t[:-1]), V(t[1:])])


def velocity_step(drive: VelocityStepDrive) -> NDArray[np.float64]:
    """Speed rises along half a cosine within the rise time, then stays."""
    V, T = drive.velocity, drive.rise_time
    steady = np.array([[T, T + 1.0, V * T / 2, V * T / 2 + V, V, V]])
    return np.vstack([_speed_up(V, T), steady])


def striker(drive: StrikerDrive) -> NDArray[np.float64]:
    """The plate gains its speed within the rise time, and loses it within the same time before the stoppers.

    Both along half a cosine; its travel ends at the stop distance.
    """
    V, T, distance = drive.velocity, drive.rise_time, drive.stop_distance
    up = _speed_up(V, T)
    t_brake = distance / V
    steady = np.array([[T, t_brake, V * T / 2, distance - V * T / 2, V, V]])
    t_stop = t_brake + T
    down = up[::-1].copy()
    down[:, 0], down[:, 1] = t_stop - up[::-1, 1], t_stop - up[::-1, 0]
    down[:, 2], down[:, 3] = distance - up[::-1, 3], distance - up[::-1, 2]
    down[:, 4], down[:, 5] = up[::-1, 5], up[::-1, 4]
    return np.vstack([up, steady, down, [t_stop, t_stop + 1.0, distance, distance, 0.0, 0.0]])


def _speed_up(V: float, T: float) -> NDArray[np.float64]:
    """From rest to speed V [m/s] in T [s]: V (1 - cos(pi t/T))/2."""
    if T == 0:
        return np.empty((0, 6))
    return cubic_segments(
        np.linspace(0, T, RAMP_SEGMENTS + 1),
        lambda t: V / 2 * (t - T / np.pi * np.sin(np.pi * t / T)),
        lambda t: V / 2 * (1 - np.cos(np.pi * t / T)),
    )


def end_motion(drive: EndMotionDrive) -> NDArray[np.float64]:
    """Constant speed to the stop distance, slow overshoot, rest; convolved with a Gaussian.

    A piecewise linear motion smoothed by a Gaussian of width s is a sum of smoothed corners
    dV (t Phi(t/s) + s phi(t/s)), with the normal distribution Phi and its density phi.
    """
    from scipy.special import ndtr

    s = drive.smoothing
    t_stop = drive.stop_distance / drive.velocity
    t_end = t_stop + drive.overshoot_time
    slow = (drive.overshoot - drive.stop_distance) / drive.overshoot_time
    start = SMOOTHING_REACH * s
    corners = start + np.array([0.0, t_stop, t_end])
    changes = np.array([drive.velocity, slow - drive.velocity, -slow])
    if s == 0:
        U = np.array([0.0, drive.stop_distance, drive.overshoot])
        V = np.array([drive.velocity, slow])
        legs = np.column_stack([corners[:2], corners[1:], U[:2], U[1:], V, V])
        return np.vstack([legs, [t_end, t_end + 1.0, U[2], U[2], 0.0, 0.0]])

    def displacement(t: NDArray[np.float64]) -> NDArray[np.float64]:
        z = (t[:, None] - corners) / s
        bell = np.exp(-(z**2) / 2) / np.sqrt(2 * np.pi)
        return (s * (z * ndtr(z) + bell)) @ changes

    def velocity(t: NDArray[np.float64]) -> NDArray[np.float64]:
        return ndtr((t[:, None] - corners) / s) @ changes

    knots = np.arange(0.0, corners[-1] + SMOOTHING_REACH * s + s / 8, s / 8)
    rest = np.array([[knots[-1], knots[-1] + 1.0, drive.overshoot, drive.overshoot, 0.0, 0.0]])
    return np.vstack([cubic_segments(knots, displacement, velocity), rest])


def compression(distance: float, duration: float, unload: bool) -> NDArray[np.float64]:
    """Half a cosine wave to ``distance`` [m] in ``duration`` [s]; with ``unload`` a full one, back to zero."""
    total = 2 * duration if unload else duration
    knots = np.linspace(0, total, RAMP_SEGMENTS * (2 if unload else 1) + 1)
    ramp = cubic_segments(
        knots,
        lambda t: distance / 2 * (1 - np.cos(np.pi * t / duration)),
        lambda t: distance / 2 * np.pi / duration * np.sin(np.pi * t / duration),
    )
    end = ramp[-1, 3]
    return np.vstack([ramp, [total, total + 1.0, end, end, 0.0, 0.0]])


def measured(t: NDArray[np.float64], U: NDArray[np.float64], smoothing: float) -> NDArray[np.float64]:
    """A measured history: smoothed by a Gaussian of standard deviation ``smoothing`` [s], then a monotone cubic.

    The history is taken to be at rest before its first and after its last sample; smoothing acts on samples
    interpolated to a tenth of its width, and the result is shifted to start at zero.
    """
    from scipy.interpolate import PchipInterpolator
    from scipy.ndimage import gaussian_filter1d

    if smoothing > 0:
        h = min(smoothing / 10, float(np.diff(t).min()))
        reach = SMOOTHING_REACH * smoothing
        fine = np.arange(t[0] - reach, t[-1] + reach + h, h)
        U = gaussian_filter1d(np.interp(fine, t, U), smoothing / h, truncate=SMOOTHING_REACH, mode="nearest")
        t = fine[:: max(1, int(smoothing / h / 4))]
        U = U[:: max(1, int(smoothing / h / 4))]
    curve = PchipInterpolator(t - t[0], U - U[0])
    segments = cubic_segments(t - t[0], curve, curve.derivative())
    end, stop = segments[-1, 1], segments[-1, 3]
    return np.vstack([segments, [end, end + 1.0, stop, stop, 0.0, 0.0]])
