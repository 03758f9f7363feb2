"""What the edge detector does with frames that are not like the others."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray
from scipy.ndimage import gaussian_filter

from wrinklewave.imaging.edges import EdgeFinder, Optics
from wrinklewave.imaging.edges.coarse import step_contrast

FINDER = EdgeFinder(Optics(blur=1.2, sample_brighter=True))


def frame(
    row: float = 40.3, *, n_columns: int = 256, noise: float = 30.0, seed: int = 0
) -> NDArray[np.float32]:
    """A level edge, grey values 400 above and 1600 below, blurred by 1.2 px."""
    clean = 400 + 1200 * np.clip(np.arange(80)[:, None] + 0.5 - row, 0, 1) * np.ones(n_columns)
    return blurred(clean, noise, seed)


def blurred(clean: NDArray[np.float64], noise: float = 30.0, seed: int = 0) -> NDArray[np.float32]:
    random = np.random.default_rng(seed).normal(0, noise, clean.shape)
    return np.round(gaussian_filter(clean, 1.2, mode="nearest") + random).astype(np.float32)


def test_nothing_is_found_in_an_empty_frame() -> None:
    edge = FINDER.find(np.full((80, 256), 500, np.float32))
    assert not edge.valid.any()
    assert not edge.column_valid.any()
    assert np.isnan(edge.rows).all()


def test_a_wire_across_the_edge_leaves_a_gap_and_no_wrong_rows() -> None:
    clean = 400 + 1200 * np.clip(np.arange(80)[:, None] + 0.5 - 40.3, 0, 1) * np.ones(256)
    clean[25:70, 100:112] = 100.0
    edge = FINDER.find(blurred(clean))
    assert not edge.column_valid[101:111].any()
    assert not edge.valid[103:109].any()
    assert np.nanmax(np.abs(edge.rows[edge.valid] - 40.3)) < 0.5
    assert edge.valid[3:94].all()
    assert edge.valid[118:-3].all()


def test_a_dead_column_costs_what_the_blur_mixes_with_it_and_is_bridged_with_an_honest_uncertainty() -> None:
    image = frame()
    image[:, 100] = 100.0
    edge = FINDER.find(image)
    gap = np.flatnonzero(~edge.valid[10:-10]) + 10
    assert 97 <= gap.min() <= 100 <= gap.max() <= 103
    assert edge.sigma[100] > 2 * edge.sigma[80]
    assert abs(edge.rows[100] - 40.3) < 5 * edge.sigma[100]


def test_columns_outside_the_range_are_left_alone() -> None:
    edge = FINDER.find(frame(), first=50, stop=200)
    assert np.isnan(edge.rows[:50]).all()
    assert np.isnan(edge.rows[200:]).all()
    assert edge.valid[53:197].all()


def test_a_dark_sample_is_the_same_as_a_bright_one() -> None:
    bright = FINDER.find(frame())
    dark = EdgeFinder(Optics(blur=1.2, sample_brighter=False)).find(2000 - frame())
    np.testing.assert_allclose(dark.rows, bright.rows, atol=1e-6)
    np.testing.assert_allclose(dark.sigma, bright.sigma, rtol=1e-6)


def test_the_brighter_side_is_told_by_the_steps() -> None:
    up, down = step_contrast(frame())
    assert up > 1000 > 100 > down
    up, down = step_contrast(2000 - frame())
    assert down > 1000 > 100 > up


@settings(max_examples=25, deadline=None)
@given(st.floats(20, 60), st.integers(0, 1000))
def test_a_shift_by_whole_pixels_shifts_the_edge(row: float, seed: int) -> None:
    """The estimate knows no preferred place: the same grey values three rows lower give the same edge."""
    image = frame(row, n_columns=128, seed=seed)
    padded = np.pad(image, ((3, 3), (0, 0)), mode="edge")
    here, lower = FINDER.find(padded[3:-3]), FINDER.find(padded[1:-5])
    np.testing.assert_allclose(lower.rows, here.rows + 2, atol=0.02)


@settings(max_examples=25, deadline=None)
@given(st.floats(0.1, 30), st.floats(0, 500))
def test_grey_values_have_no_unit(gain: float, offset: float) -> None:
    image = frame()
    noisy_enough = np.round(image)
    scaled = (100 * gain * noisy_enough + offset).astype(np.float32)
    np.testing.assert_allclose(FINDER.find(scaled).rows, FINDER.find(noisy_enough).rows, atol=5e-3)
