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
    y_smooth = np.asarray(y_smooth, dtype=float)
    ends = np.asarray(x_boundary, dtype=float)
    arcs = (arc_positions(x, row, start=end, end=length)[1] for row, end in zip(y_smooth, ends, strict=True))
    return np.array([1.0 - arc / length for arc in arcs])


def arc_positions(x: ArrayLike, height: ArrayLike, *, start: float, end: float) -> tuple[Array, float]:
    """Positions along a curve from ``start`` on, and its length up to ``end`` [m].

    Args:
        x, height: of the curve [m], shape [n]; gaps (NaN) are bridged by straight lines, and the slopes of the
            first and last known stretch continue to the ends.
        start, end: x of the curve's ends [m].

    Returns:
        Shape [n], NaN where the height is unknown; NaN throughout if fewer than two heights are known.
    """
    heights = np.asarray(height, dtype=float)
    known = np.isfinite(heights)
    positions = np.full(heights.shape, np.nan)
    if known.sum() < 2:
        return positions, float("nan")
    at = np.asarray(x, dtype=float)[known]
    lengths = np.hypot(np.diff(at), np.diff(heights[known]))
    stretch = lengths / np.diff(at)
    along = (at[0] - start) * stretch[0] + np.concatenate([[0.0], np.cumsum(lengths)])
    positions[known] = along
    return positions, float(along[-1] + (end - at[-1]) * stretch[-1])


def strain_rate(time: ArrayLike, strain: ArrayLike) -> Array:
    """Rate of strain by central differences in time [1/s], shape [n_times, ...]."""
    return np.gradient(np.asarray(strain, dtype=float), np.asarray(time, dtype=float), axis=0)
