"""Positions of vertical edges in a profile along the row, by maximum likelihood: one or two blurred steps."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats
from wrinklewave.imaging.edges.profile import normal_distribution

_MAX_STEPS = 30
_CONVERGED = 1e-4  # px
_LARGEST_STEP = 1.0  # px


class Steps(NamedTuple):
    """Steps fitted to a profile.

    Attributes:
        positions: columns [px], shape [n_steps]; NaN where the fit failed.
        covariance: of the positions for noise of standard deviation 1, shape [n_steps, n_steps].
        misfit: sum of squared residuals.
    """

    positions: Floats
    covariance: Floats
    misfit: float


@allocating
def fit_steps(profile: Floats, first: int, start: Floats, heights: Floats, base: float, blur: float) -> Steps:
    """Fit I(x) = base + sum_k heights[k] E(x - x_k) to a profile, E a blurred, pixel-integrated unit step.

    Args:
        profile: grey values of consecutive columns, shape [n].
        first: column of ``profile[0]``.
        start: positions to start from [px], shape [1] or [2].
        heights: of the steps, same shape.
        base: grey value left of them all.
        blur: standard deviation of the optical blur [px].
    """
    n_steps = start.size
    at = start.copy()
    normal = np.zeros((n_steps, n_steps))
    gradient = np.zeros(n_steps)
    sensitivity = np.zeros(n_steps)
    misfit = np.inf
    for _ in range(_MAX_STEPS):
        normal[:] = 0.0
        gradient[:] = 0.0
        misfit = 0.0
        for i in range(profile.size):
            model = base
            for k in range(n_steps):
                upper, upper_integral = normal_distribution((first + i + 0.5 - at[k]) / blur)
                lower, lower_integral = normal_distribution((first + i - 0.5 - at[k]) / blur)
                model += heights[k] * blur * (upper_integral - lower_integral)
                sensitivity[k] = -heights[k] * (upper - lower)
            residual = profile[i] - model
            misfit += residual * residual
            for k in range(n_steps):
                gradient[k] += sensitivity[k] * residual
                for m in range(n_steps):
                    normal[k, m] += sensitivity[k] * sensitivity[m]
        largest = 0.0
        if n_steps == 1:
            steps = gradient / normal[0, 0] if normal[0, 0] > 0.0 else np.full(1, np.nan)
        else:
            determinant = normal[0, 0] * normal[1, 1] - normal[0, 1] * normal[1, 0]
            damped = determinant + 1e-6 * normal[0, 0] * normal[1, 1]
            steps = np.array(
                [
                    (gradient[0] * normal[1, 1] - gradient[1] * normal[0, 1]) / damped,
                    (gradient[1] * normal[0, 0] - gradient[0] * normal[1, 0]) / damped,
                ]
            )
        for k in range(n_steps):
            move = min(max(steps[k], -_LARGEST_STEP), _LARGEST_STEP)
            at[k] += move
            largest = max(largest, abs(move))
        if not np.isfinite(at).all() or np.abs(at - start).max() > profile.size:
            at[:] = np.nan
            break
        if largest < _CONVERGED:
            break
    covariance = _inverse(normal)
    if not np.isfinite(covariance).all() or not np.isfinite(at).all():
        at[:] = np.nan
        covariance[:] = np.inf
    return Steps(at, covariance, misfit)


@allocating
def _inverse(matrix: Floats) -> Floats:
    """Of a 1 x 1 or 2 x 2 matrix; NaN if it has none."""
    inverse = np.full(matrix.shape, np.nan)
    if matrix.shape[0] == 1:
        if matrix[0, 0] > 0.0:
            inverse[0, 0] = 1.0 / matrix[0, 0]
        return inverse
    determinant = matrix[0, 0] * matrix[1, 1] - matrix[0, 1] * matrix[1, 0]
    if abs(determinant) > 1e-300:
        inverse[0, 0], inverse[1, 1] = matrix[1, 1] / determinant, matrix[0, 0] / determinant
        inverse[0, 1], inverse[1, 0] = -matrix[0, 1] / determinant, -matrix[1, 0] / determinant
    return inverse


class Bar(NamedTuple):
    """A bar fitted to a profile.

    Attributes:
        position: its middle [px]. height: in the profile's unit.
        variance: of the position, for noise of variance 1.
        misfit: sum of squared residuals.
    """

    position: float
    height: float
    variance: float
    misfit: float


@allocating
def fit_bar(profile: Floats, first: int, start: float, width: float, blur: float) -> Bar:
    """Fit I(x) = h [E(x - x_0 + w/2) - E(x - x_0 - w/2)] to a profile; position NaN if that fails.

    Args:
        profile: grey values of consecutive columns less the background, shape [n].
        first: column of ``profile[0]``.
        start: middle of the bar to start from [px].
        width: of the bar [px].
        blur: standard deviation of the optical blur [px].
    """
    at, height, variance, misfit = start, 0.0, np.inf, np.inf
    shape, slope = np.empty(profile.size), np.empty(profile.size)
    for _ in range(_MAX_STEPS):
        for i in range(profile.size):
            shape[i], slope[i] = 0.0, 0.0
            for side in (-1.0, 1.0):
                u = first + i - at + side * 0.5 * width
                upper, upper_integral = normal_distribution((u + 0.5) / blur)
                lower, lower_integral = normal_distribution((u - 0.5) / blur)
                shape[i] += side * blur * (upper_integral - lower_integral)
                slope[i] -= side * (upper - lower)
        height = np.dot(profile, shape) / np.dot(shape, shape)
        information = height * height * np.dot(slope, slope)
        if not information > 0.0:
            return Bar(np.nan, height, np.inf, np.inf)
        residual = profile - height * shape
        misfit = np.dot(residual, residual)
        step = height * np.dot(slope, residual) / information
        at += min(max(step, -_LARGEST_STEP), _LARGEST_STEP)
        variance = 1.0 / information
        if abs(at - start) > 0.5 * profile.size:
            return Bar(np.nan, height, np.inf, np.inf)
        if abs(step) < _CONVERGED:
            break
    return Bar(at, height, variance, misfit)
