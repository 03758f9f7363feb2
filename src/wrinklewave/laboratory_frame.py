"""From material points to the laboratory: what a camera that looks along the film sees of a moving surface.

A surface is a curve through its material points, ``x_p(X), y_p(X)``. Seen from the side it is a single-valued
height ``y(x)`` on a fixed grid: where the curve folds over itself, the uppermost branch is what can be seen.
Everything that turns curves into heights (wrinkling models, the synthetic camera, the maps of material
fields) goes through here. Lengths in metres; the first axis of every array is time.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.floating[Any]]


@dataclass(frozen=True)
class SurfaceCurve:
    """A surface sampled finely along its material coordinate.

    Attributes:
        X: material coordinate [m], shape [n_samples].
        x, y: positions [m], shape [n_times, n_samples].
        normal_x, normal_y: unit normal that points out of the sample, same shape: (-sin alpha, cos alpha)
            with alpha the angle of the surface tangent from the x-axis.
    """

    X: Array
    x: Array
    y: Array
    normal_x: Array
    normal_y: Array


def surface_curve(X: ArrayLike, x_p: ArrayLike, y_p: ArrayLike, *, spacing: float) -> SurfaceCurve:
    """Smooth curve through material points, by cubic splines in the material coordinate.

    Args:
        X: undeformed positions, shape [n_points], increasing.
        x_p, y_p: positions, shape [n_times, n_points].
        spacing: largest distance between samples in the material coordinate [m].
    """
    from scipy.interpolate import CubicSpline

    X = np.asarray(X, dtype=float)
    n_samples = int(np.ceil((X[-1] - X[0]) / spacing)) + 1
    samples = np.linspace(X[0], X[-1], n_samples)
    x_spline, y_spline = (CubicSpline(X, np.asarray(p, dtype=float), axis=1) for p in (x_p, y_p))
    x_tangent, y_tangent = x_spline(samples, 1), y_spline(samples, 1)
    length = np.hypot(x_tangent, y_tangent)
    return SurfaceCurve(
        samples, x_spline(samples), y_spline(samples), -y_tangent / length, x_tangent / length
    )


def visible_height(x_curve: ArrayLike, y_curve: ArrayLike, x: ArrayLike, x_boundary: ArrayLike) -> Array:
    """Height of the uppermost branch of a curve on the laboratory grid.

    Args:
        x_curve, y_curve: positions along the curve, shape [n_times, n_samples].
        x: laboratory grid, shape [n_x], increasing.
        x_boundary: struck end, shape [n_times]; what lies left of it is not seen.

    Returns:
        Shape [n_times, n_x]; NaN left of the struck end and where the curve does not reach.
    """
    x_curve, y_curve = np.asarray(x_curve, dtype=float), np.asarray(y_curve, dtype=float)
    x = np.asarray(x, dtype=float)
    height = np.stack(
        [_uppermost(x_row, y_row, y_row, x) for x_row, y_row in zip(x_curve, y_curve, strict=True)]
    )
    return _without_struck_side(height, x, x_boundary)


def visible_material_points(
    X: ArrayLike, x_p: ArrayLike, y_p: ArrayLike, x: ArrayLike, x_boundary: ArrayLike
) -> Array:
    """Undeformed position of the material that is seen at each point of the laboratory grid.

    Args:
        X: undeformed positions, shape [n_points].
        x_p, y_p: positions of the material points, shape [n_times, n_points]; NaN where a point was lost.
        x: laboratory grid, shape [n_x], increasing.
        x_boundary: struck end, shape [n_times].

    Returns:
        Shape [n_times, n_x]; NaN where no material is seen.
    """
    X, x = np.asarray(X, dtype=float), np.asarray(x, dtype=float)
    x_p, y_p = np.asarray(x_p, dtype=float), np.asarray(y_p, dtype=float)
    seen = np.stack([_uppermost(x_row, y_row, X, x) for x_row, y_row in zip(x_p, y_p, strict=True)])
    return _without_struck_side(seen, x, x_boundary)


def material_to_laboratory(values: ArrayLike, X: ArrayLike, seen: Array) -> Array:
    """Values of material points on the laboratory grid.

    Args:
        values: shape [n_times, n_points].
        X: undeformed positions of the points, shape [n_points], increasing.
        seen: from ``visible_material_points``, shape [n_times, n_x].

    Returns:
        Shape [n_times, n_x]; NaN where ``seen`` is.
    """
    values, X = np.asarray(values, dtype=float), np.asarray(X, dtype=float)
    return np.stack([np.interp(points, X, row) for points, row in zip(seen, values, strict=True)])


def laboratory_to_material(values: ArrayLike, x: ArrayLike, x_p: ArrayLike) -> Array:
    """Values on the laboratory grid at the places where material points are.

    Args:
        values: shape [n_times, n_x], NaN where unknown.
        x: laboratory grid, shape [n_x], increasing.
        x_p: positions of the material points, shape [n_times, n_points].

    Returns:
        Shape [n_times, n_points]; NaN outside the grid and beside unknown values.
    """
    values, x, x_p = (np.asarray(a, dtype=float) for a in (values, x, x_p))
    rows = zip(x_p, values, strict=True)
    return np.stack([np.interp(points, x, row, left=np.nan, right=np.nan) for points, row in rows])


def _uppermost(x_curve: Array, y_curve: Array, carried: Array, x: Array) -> Array:
    """Interpolate ``carried`` to the grid on the branch of the curve with the greatest height."""
    known = np.isfinite(x_curve) & np.isfinite(y_curve)
    if not known.all():
        x_curve, y_curve, carried = x_curve[known], y_curve[known], carried[known]
    if x_curve.size < 2:
        return np.full(x.size, np.nan)
    steps = np.diff(x_curve)
    if (steps > 0).all():
        return np.interp(x, x_curve, carried, left=np.nan, right=np.nan)
    highest, result = np.full((2, x.size), np.nan)
    for branch in _branches(steps):
        height, value = (_interpolate(x, x_curve[branch], column[branch]) for column in (y_curve, carried))
        above = (height > highest) | (np.isnan(highest) & np.isfinite(height))
        highest[above], result[above] = height[above], value[above]
    return result


def _branches(steps: Array) -> list[slice]:
    """Stretches of the curve along which x keeps its sense."""
    turns = np.flatnonzero(np.diff(np.sign(steps)) != 0) + 1
    bounds = [0, *turns.tolist(), steps.size]
    return [slice(start, stop + 1) for start, stop in pairwise(bounds)]


def _interpolate(x: Array, x_branch: Array, values: Array) -> Array:
    order = slice(None) if x_branch[-1] >= x_branch[0] else slice(None, None, -1)
    return np.interp(x, x_branch[order], values[order], left=np.nan, right=np.nan)


def _without_struck_side(values: Array, x: Array, x_boundary: ArrayLike) -> Array:
    values[x[None, :] < np.asarray(x_boundary, dtype=float)[:, None]] = np.nan
    return values
