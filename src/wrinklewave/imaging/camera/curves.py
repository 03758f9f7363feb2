"""Interpolation along a curve, cubic and local, so that a gap or a kink is felt by its neighbours only."""

from __future__ import annotations

from typing import Any

import numpy as np
from numba import njit
from numpy.typing import ArrayLike, NDArray


def interpolate(at: ArrayLike, x: NDArray[np.float64], y: NDArray[np.float64]) -> NDArray[np.float64]:
    """Values of the cubics through the four nearest points of a curve; beyond its ends, the ends' values.

    Args:
        at: positions, shape [n], increasing.
        x, y: the curve, shape [n_points >= 4], x increasing.
    """
    positions = np.asarray(at, dtype=float)
    values = np.empty_like(positions)
    _interpolate(positions, x, y, values)
    return values


@njit(cache=True, nogil=True, error_model="numpy")
def _interpolate(at: Any, x: Any, y: Any, values: Any) -> None:
    last = x.size - 4
    first = 0
    for i in range(at.size):
        t = min(max(at[i], x[0]), x[-1])
        while first < last and x[first + 2] < t:
            first += 1
        a, b, c, d = x[first], x[first + 1], x[first + 2], x[first + 3]
        values[i] = (
            y[first] * (t - b) * (t - c) * (t - d) / ((a - b) * (a - c) * (a - d))
            + y[first + 1] * (t - a) * (t - c) * (t - d) / ((b - a) * (b - c) * (b - d))
            + y[first + 2] * (t - a) * (t - b) * (t - d) / ((c - a) * (c - b) * (c - d))
            + y[first + 3] * (t - a) * (t - b) * (t - c) / ((d - a) * (d - b) * (d - c))
        )
