"""Strains of the surface: along its arc, and their rates. Compression is positive."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.laboratory_frame import Array


def arc_length_strain(x: ArrayLike, y_smooth: ArrayLike, x_boundary: ArrayLike, *, length: float) -> Array:
    """Mean strain along the curved surface: 1 - s / L_0 (Fig. S5), s the arc length without wrinkles.

    Args:
        x: laboratory grid [m], shape [n_x].
        y_smooth: height of the surface without wrinkles [m], shape [n_times, n_x]; gaps (NaN) are bridged by
            straight lines, and the slopes of the first and last known stretch continue to the sample's ends.
        x_boundary: struck end [m], shape [n_times].
        length: undeformed length of the sample, whose held end stays at x = length [m].

    Returns:
        Shape [n_times]; NaN where fewer than two heights are known.
    """
    x, y_smooth = np.asarray(x, dtype=float), np.asarray(y_smooth, dtype=float)
    ends = np.asarray(x_boundary, dtype=float)
    return np.array(
        [1.0 - _arc(x, row, end, length) / length for row, end in zip(y_smooth, ends, strict=True)]
    )


def strain_rate(time: ArrayLike, strain: ArrayLike) -> Array:
    """Rate of strain by central differences in time [1/s], shape [n_times, ...]."""
    return np.gradient(np.asarray(strain, dtype=float), np.asarray(time, dtype=float), axis=0)


def _arc(x: Array, height: Array, start: float, end: float) -> float:
    known = np.isfinite(height)
    x, height = x[known], height[known]
    if x.size < 2:
        return float("nan")
    lengths = np.hypot(np.diff(x), np.diff(height))
    stretch = lengths / np.diff(x)
    return float(lengths.sum() + (x[0] - start) * stretch[0] + (end - x[-1]) * stretch[-1])
