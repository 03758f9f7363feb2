"""Fronts: when a field reaches a threshold at each position, and how fast that place travels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.laboratory_frame import Array

FEWEST_POSITIONS = 3
CERTAIN = 0.25
"""Share of a speed below which its standard uncertainty must be for its line to mean something."""


@dataclass(frozen=True)
class SpeedFit:
    """Straight lines through the arrivals of a front.

    Attributes:
        speed, speed_sigma: of the free line t = a + x / speed, with its standard uncertainty [m/s].
        intercept: a, when the free line passes x = 0 [s].
        origin_speed, origin_speed_sigma: of the line t = start + x / speed through the origin [m/s].
        start: time at the origin of that line [s].
        positions, times: the arrivals in the window [m], [s].
        residual_rms: of the free line [s].
    """

    speed: float
    speed_sigma: float
    intercept: float
    origin_speed: float
    origin_speed_sigma: float
    start: float
    positions: Array
    times: Array
    residual_rms: float

    @property
    def is_line(self) -> bool:
        """Whether the free line says how fast a front travels, and not that none does."""
        return self.speed_sigma < CERTAIN * abs(self.speed)

    @property
    def is_line_through_origin(self) -> bool:
        """The same of the line through the origin."""
        return self.origin_speed_sigma < CERTAIN * abs(self.origin_speed)


def arrival_times(time: ArrayLike, field: ArrayLike, threshold: ArrayLike) -> Array:
    """When ``field`` first reaches ``threshold`` at each position [s], interpolated linearly in time.

    Args:
        time: shape [n_times], increasing.
        field: shape [n_times, n_positions]; NaN where unknown.
        threshold: one for all positions, or shape [n_positions].

    Returns:
        Shape [n_positions]; NaN where the threshold is never reached, or where the first known value is
        beyond it.
    """
    time, field = np.asarray(time, dtype=float), np.asarray(field, dtype=float)
    threshold = np.broadcast_to(np.asarray(threshold, dtype=float), field.shape[1:])
    reached = field >= threshold
    after = reached.argmax(axis=0)
    rows = np.arange(time.size)[:, None]
    last_known = np.maximum.accumulate(np.where(np.isfinite(field), rows, -1), axis=0)
    columns = np.arange(field.shape[1])
    before = last_known[np.maximum(after - 1, 0), columns]
    valid = reached.any(axis=0) & (after > 0) & (before >= 0)
    arrival = np.full(field.shape[1], np.nan)
    i, j, k = before[valid], after[valid], columns[valid]
    share = (threshold[k] - field[i, k]) / (field[j, k] - field[i, k])
    arrival[k] = time[i] + share * (time[j] - time[i])
    return arrival


def fit_speed(
    positions: ArrayLike, arrivals: ArrayLike, *, window: tuple[float, float], start: float = 0.0
) -> SpeedFit:
    """Fit the speed of a front: least squares of time on position, free and through the origin.

    Neighbouring positions share their errors. The standard uncertainties count only n (1 - r) / (1 + r) of
    the n positions as independent, r being the correlation between residuals of neighbours.

    Args:
        positions: shape [n] [m].
        arrivals: shape [n] [s]; NaN where the front never came.
        window: positions that take part [m].
        start: time at which the line through the origin leaves x = 0 [s].

    Returns:
        The fit. Its speeds are NaN when the front came to fewer than three positions in the window, or
        everywhere at once.
    """
    x, t = np.asarray(positions, dtype=float), np.asarray(arrivals, dtype=float)
    used = np.isfinite(t) & np.isfinite(x) & (x >= window[0]) & (x <= window[1])
    x, t = x[used], t[used]
    if x.size < FEWEST_POSITIONS:
        nan = float("nan")
        return SpeedFit(nan, nan, nan, nan, nan, start, x, t, nan)
    free = np.stack([np.ones_like(x), x], axis=1)
    (intercept, slowness), sigmas, residual = _least_squares(free, t)
    (origin_slowness,), (origin_sigma,), _ = _least_squares(x[:, None], t - start)
    speed, speed_sigma = _reciprocal(slowness, sigmas[1])
    origin_speed, origin_speed_sigma = _reciprocal(origin_slowness, origin_sigma)
    return SpeedFit(
        speed=speed,
        speed_sigma=speed_sigma,
        intercept=float(intercept),
        origin_speed=origin_speed,
        origin_speed_sigma=origin_speed_sigma,
        start=start,
        positions=x,
        times=t,
        residual_rms=float(np.sqrt(np.mean(residual**2))),
    )


def ahead_of_front(
    time: ArrayLike, x: ArrayLike, field: ArrayLike, front: SpeedFit, *, distance: float
) -> Array:
    """Values of ``field`` at ``distance`` [m] ahead of a front, when it arrives at each of its positions.

    Args:
        time: shape [n_times]. x: shape [n_x], evenly spaced [m].
        field: shape [n_times, n_x].

    Returns:
        One value for each position of the front from which the place ahead is still on the grid.
    """
    time, x, field = (np.asarray(a, dtype=float) for a in (time, x, field))
    columns = np.rint((front.positions + distance - x[0]) / (x[1] - x[0])).astype(int)
    pairs = zip(columns, front.times, strict=True)
    return np.array([np.interp(arrival, time, field[:, c]) for c, arrival in pairs if c < x.size])


def rise_time(time: ArrayLike, signal: ArrayLike, *, low: float = 0.1, high: float = 0.9) -> float:
    """Time a signal takes from ``low`` to ``high`` of its maximum [s]; NaN if it does not pass both."""
    signal = np.asarray(signal, dtype=float)[:, None]
    if not np.isfinite(signal).any():
        return float("nan")
    arrivals = [arrival_times(time, signal, share * np.nanmax(signal))[0] for share in (low, high)]
    return float(arrivals[1] - arrivals[0])


def _least_squares(design: Array, values: Array) -> tuple[Array, Array, Array]:
    """Coefficients, their standard uncertainties with correlated residuals, and the residuals."""
    coefficients = np.linalg.lstsq(design, values, rcond=None)[0]
    residual = values - design @ coefficients
    freedom = max(independent_count(residual) - design.shape[1], 1.0)
    covariance = residual @ residual / freedom * np.linalg.inv(design.T @ design)
    return coefficients, np.sqrt(np.diag(covariance)), residual


def _reciprocal(slowness: float, sigma: float) -> tuple[float, float]:
    """Speed and its uncertainty; NaN if the slowness cannot be told from zero."""
    if abs(slowness) <= max(sigma, 1e-9):
        return np.nan, np.nan
    return float(1.0 / slowness), float(sigma / slowness**2)


def independent_count(residual: Array) -> float:
    """How many independent values a row of correlated residuals is worth."""
    power = residual @ residual
    if power == 0.0:
        return float(residual.size)
    correlation = np.clip(residual[1:] @ residual[:-1] / power, 0.0, 1.0)
    return float(residual.size * (1.0 - correlation) / (1.0 + correlation))
