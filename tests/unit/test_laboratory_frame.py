"""From material points to the laboratory."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.laboratory_frame import (
    laboratory_to_material,
    material_to_laboratory,
    surface_curve,
    visible_height,
    visible_material_points,
)


def test_visible_height_of_a_fold_is_its_upper_branch() -> None:
    """An S of three branches: the grid sees the highest one at each place, nothing beyond its reach."""
    x_curve = np.array([[0.0, 2.0, 1.0, 3.0]])
    y_curve = np.array([[0.0, 2.0, 3.0, 2.0]])  # rises to (2, 2), turns back to (1, 3), falls to (3, 2)
    x = np.array([-0.5, 0.5, 1.25, 1.75, 2.5, 3.5])
    height = visible_height(x_curve, y_curve, x, [-1.0])[0]
    # first branch y = x, third branch y = 3 - (x - 1) / 2 from x = 1 on
    np.testing.assert_allclose(height, [np.nan, 0.5, 2.875, 2.625, 2.25, np.nan], atol=1e-12)


def test_material_seen_in_a_fold_belongs_to_its_upper_branch() -> None:
    X = np.array([0.0, 1.0, 2.0, 3.0])
    x_p, y_p = [[0.0, 2.0, 1.0, 3.0]], [[0.0, 2.0, 3.0, 2.0]]
    seen = visible_material_points(X, x_p, y_p, [0.5, 1.25, 2.5], [-1.0])
    # third branch: x = 1 + 2 (X - 2)
    np.testing.assert_allclose(seen[0], [0.25, 2.125, 2.75], atol=1e-12)


def test_nothing_is_seen_left_of_the_struck_end() -> None:
    height = visible_height([[0.0, 1.0], [0.0, 1.0]], [[1.0, 1.0], [1.0, 1.0]], [0.0, 0.5, 1.0], [0.0, 0.6])
    np.testing.assert_array_equal(np.isnan(height), [[False, False, False], [True, True, False]])


def test_lost_material_points_are_bridged() -> None:
    height = visible_height([[0.0, np.nan, 2.0]], [[0.0, 5.0, 2.0]], [0.5, 1.0], [0.0])
    np.testing.assert_allclose(height[0], [0.5, 1.0])


def test_a_single_known_point_shows_no_surface() -> None:
    assert np.isnan(visible_height([[0.0, np.nan]], [[0.0, np.nan]], [0.0, 1.0], [0.0])).all()


@given(
    shift=st.floats(-1.0, 1.0),
    stretches=st.lists(st.floats(0.05, 2.0), min_size=5, max_size=5),
    heights=st.lists(st.floats(-1.0, 1.0), min_size=6, max_size=6),
)
def test_a_rising_curve_is_interpolated_and_its_fields_return(
    shift: float, stretches: list[float], heights: list[float]
) -> None:
    """Without folds, fields that are linear in the material coordinate survive the way there and back."""
    X = np.arange(6.0)
    x_p = shift + np.concatenate([[0.0], np.cumsum(stretches)])[None]
    x = np.linspace(x_p[0, 0], x_p[0, -1], 400)
    x[[0, -1]] = x_p[0, [0, -1]]
    seen = visible_material_points(X, x_p, [heights], x, x_p[:, 0])
    field = material_to_laboratory(3.0 * X[None] - 1.0, X, seen)
    back = laboratory_to_material(field, x, x_p)[0]
    # linear interpolation misses a kink by at most the change of slope times a quarter of the grid spacing
    slope = 3.0 / min(stretches)
    np.testing.assert_allclose(back, 3.0 * X - 1.0, atol=slope * (x[1] - x[0]))


positions = st.lists(st.integers(0, 1000).map(lambda n: 1e-3 * n), min_size=2, max_size=9, unique=True)


@given(x_curve=positions, heights=st.lists(st.floats(-1.0, 1.0), min_size=9, max_size=9))
def test_a_surface_looks_the_same_whichever_end_it_is_followed_from(
    x_curve: list[float], heights: list[float]
) -> None:
    """Folded at will; seen as high as the highest of its straight stretches."""
    curve, y, x = np.array(x_curve), np.array(heights[: len(x_curve)]), np.linspace(-0.1, 1.1, 61)
    seen = visible_height(curve[None], y[None], x, [-1.0])[0]
    backwards = visible_height(curve[None, ::-1], y[None, ::-1], x, [-1.0])[0]
    np.testing.assert_allclose(backwards, seen, atol=1e-9)
    stretches = []
    for a, b, y_a, y_b in zip(curve[:-1], curve[1:], y[:-1], y[1:], strict=True):
        share = (x - a) / (b - a)
        stretches.append(np.where((share >= 0.0) & (share <= 1.0), y_a + share * (y_b - y_a), -np.inf))
    highest = np.max(stretches, axis=0)
    inside = np.isfinite(seen) & np.isfinite(highest)  # rounding decides about the very ends
    assert np.isfinite(seen).sum() == pytest.approx(np.isfinite(highest).sum(), abs=2)
    np.testing.assert_allclose(seen[inside], highest[inside], atol=1e-9)


def test_curve_through_points_of_a_circle_has_its_normals() -> None:
    """Cubic splines: position to fourth order in the step, tangent to third."""
    X = np.linspace(0.3, 2.8, 40)
    curve = surface_curve(X, -np.cos(X)[None], np.sin(X)[None], spacing=0.013)
    assert curve.X[[0, -1]] == pytest.approx(X[[0, -1]])
    assert 0.0125 < np.diff(curve.X).max() <= 0.013
    step = X[1] - X[0]
    np.testing.assert_allclose(curve.x[0], -np.cos(curve.X), atol=step**4)
    np.testing.assert_allclose(curve.normal_x[0], -np.cos(curve.X), atol=step**3)
    np.testing.assert_allclose(curve.normal_y[0], np.sin(curve.X), atol=step**3)
    np.testing.assert_allclose(np.hypot(curve.normal_x, curve.normal_y), 1.0, rtol=1e-12)


def test_values_outside_the_grid_are_unknown() -> None:
    result = laboratory_to_material([[1.0, 2.0]], [0.0, 1.0], [[-0.1, 0.5, 1.1]])
    np.testing.assert_array_equal(np.isnan(result[0]), [True, False, True])
    assert result[0, 1] == pytest.approx(1.5)
