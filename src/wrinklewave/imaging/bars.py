"""The place of a bar in a profile along the row, by maximum likelihood."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats
from wrinklewave.imaging.edges.profile import normal_distribution

_MAX_STEPS = 30
_CONVERGED = 1e-4  # px
_LARGEST_STEP = 1.0  # px


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
