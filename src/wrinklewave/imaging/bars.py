"""The place of a bar in a profile along the row, by maximum likelihood, and how well it can be known at all."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats
from wrinklewave.imaging.edges.profile import blurred_step, blurred_step_at

_MAX_STEPS = 30
_CONVERGED = 1e-4  # px
_LARGEST_STEP = 1.0  # px
_BOUND_REACH = 8.0  # blurs on either side of a bar that the bound sums over


class Bar(NamedTuple):
    """A bar fitted to a profile.

    Attributes:
        position: its middle [px]. height: in the profile's unit.
        variance: of the position, for noise of variance 1.
        misfit: weighted sum of squared residuals.
    """

    position: float
    height: float
    variance: float
    misfit: float


@allocating
def fit_bar(profile: Floats, weights: Floats, first: int, start: float, width: float, blur: float) -> Bar:
    """Fit I(x) = h [E(x - x_0 + w/2) - E(x - x_0 - w/2)] + b to a profile; position NaN if that fails.

    Args:
        profile: grey values of consecutive columns, shape [n].
        weights: inverse variance of each, same shape.
        first: column of ``profile[0]``.
        start: middle of the bar to start from [px].
        width: of the bar [px].
        blur: standard deviation of the optical blur [px].
    """
    failed = Bar(np.nan, 0.0, np.inf, np.inf)
    at, height, variance, misfit = start, 0.0, np.inf, np.inf
    shape, slope = np.empty(profile.size), np.empty(profile.size)
    total = weights.sum()
    for _ in range(_MAX_STEPS):
        for i in range(profile.size):
            shape[i], slope[i] = 0.0, 0.0
            for side in (-1.0, 1.0):
                u = first + i - at + side * 0.5 * width
                edge, density = blurred_step_at(u, blur)
                shape[i] += side * edge
                slope[i] -= side * density
        mean_shape, mean_slope = np.dot(weights, shape) / total, np.dot(weights, slope) / total
        mean = np.dot(weights, profile) / total
        own = np.dot(weights, (shape - mean_shape) ** 2)
        if not own > 0.0:
            return failed
        height = np.dot(weights, (shape - mean_shape) * (profile - mean)) / own
        mixed = np.dot(weights, (shape - mean_shape) * (slope - mean_slope))
        seen = np.dot(weights, (slope - mean_slope) ** 2) - mixed**2 / own
        information = height * height * seen
        if not information > 0.0:
            return failed
        residual = profile - mean - height * (shape - mean_shape)
        misfit = np.dot(weights, residual**2)
        step = height * np.dot(weights, (slope - mean_slope) * residual) / information
        at += min(max(step, -_LARGEST_STEP), _LARGEST_STEP)
        variance = 1.0 / information
        if abs(at - start) > 0.5 * profile.size:
            return failed
        if abs(step) < _CONVERGED:
            break
    return Bar(at, height, variance, misfit)


def row_bound(contrast_to_noise: float, height: float, width: float, blur: float) -> float:
    """Least standard deviation of an unbiased estimate of a bar's place in one row [px].

    sigma^-2 = (C/N)^2 h^2 sum_j [E'(j - x_0 + w/2) - E'(j - x_0 - w/2)]^2, mean over x_0, all else known.

    Args:
        contrast_to_noise: contrast of the surface over noise.
        height: of the bar, in contrasts.
        width: of the bar [px].
        blur: standard deviation of the optical blur [px].
    """
    reach = int(np.ceil(_BOUND_REACH * blur + width))
    u = np.linspace(-reach, reach, 16 * 2 * reach + 1)
    h = 1e-4
    slope = (
        blurred_step(u + 0.5 * width + h, blur)
        - blurred_step(u + 0.5 * width - h, blur)
        - blurred_step(u - 0.5 * width + h, blur)
        + blurred_step(u - 0.5 * width - h, blur)
    ) / (2 * h)
    return float(1.0 / (contrast_to_noise * abs(height) * np.sqrt(np.sum(slope**2) / 16)))


def foot_bound(
    contrast_to_noise: float,
    height: float,
    width: float,
    length: float,
    blur: float,
    frames: int = 1,
    *,
    lowest: float = -np.inf,
) -> float:
    """Least standard deviation of where a straight wire leaves a level surface [px].

    A row at the distance d above the surface shows the share V(d) of the wire, blurred at the surface and at the tip.
    Place and inclination are unknown, the inclination is shared by some frames:
    sigma^2 = sigma_row^2 [1/W + D^2/(n sum V^2 (d - D)^2)], W = sum V^2, D = sum V^2 d/W.

    Args:
        contrast_to_noise, height, width, blur: as for ``row_bound``.
        length: of the wire above the surface [px].
        frames: n.
        lowest: distance from which rows are used; below, the surface has to be known better than to 0.1 px [px].
    """
    per_row = 16
    d = np.arange(-_BOUND_REACH * blur, length + _BOUND_REACH * blur, 1.0 / per_row)
    d = d[d >= lowest]
    seen = (blurred_step(d, blur) - blurred_step(d - length, blur)) ** 2 / per_row
    total, middle = seen.sum(), (seen * d).sum() / seen.sum()
    lever = (seen * (d - middle) ** 2).sum()
    row = row_bound(contrast_to_noise, height, width, blur)
    return row * float(np.sqrt(1.0 / total + middle**2 / (frames * lever)))
