"""Which frames show the striker touching: the cheapest of all sequences, found without trying them all."""

from __future__ import annotations

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.imaging.contact import touching_frames

GAP, CHANGE = 4.0, 4.0


def cost(states: tuple[float, ...] | np.ndarray, gain: list[float]) -> float:
    """What speaks against a sequence: 4 for a gap, its gain for none, in frames that tell; 4 for every change."""
    told = sum(
        max(g, 0.0) if touching else GAP for touching, g in zip(states, gain, strict=True) if not np.isnan(g)
    )
    return told + CHANGE * np.count_nonzero(np.diff(states))


@given(st.lists(st.floats(-3.0, 15.0) | st.just(np.nan), min_size=1, max_size=8))
def test_no_sequence_is_more_likely(gain: list[float]) -> None:
    found, told = touching_frames(np.array(gain)), ~np.isnan(gain)
    np.testing.assert_array_equal(np.isnan(found), ~told)
    least = min(cost(states, gain) for states in product((0.0, 1.0), repeat=len(gain)))
    # frames that tell nothing take whatever is cheapest
    filled = [(0.0, 1.0) if np.isnan(state) else (state,) for state in found]
    assert min(cost(states, gain) for states in product(*filled)) == pytest.approx(least)


def test_a_gap_of_any_width_is_a_gap() -> None:
    np.testing.assert_array_equal(touching_frames(np.array([np.inf, 1e9, 0.0, 0.0, 0.0])), [0, 0, 1, 1, 1])
