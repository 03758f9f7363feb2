"""Grid meshes and what is lumped on them."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.dynamics.fields import depth_weights, to_nodes
from wrinklewave.dynamics.model import lumped_mass
from wrinklewave.mesh.block import block, graded


@given(n=st.integers(1, 60), ratio=st.floats(0.05, 20))
def test_graded_intervals_grow_by_the_ratio(n, ratio):
    points = graded(-1.0, 2.0, n, ratio)
    intervals = np.diff(points)
    assert points[[0, -1]] == pytest.approx([-1.0, 2.0])
    assert (intervals > 0).all()
    if n > 1:
        assert intervals[-1] / intervals[0] == pytest.approx(ratio, rel=1e-9)


def test_mass_is_that_of_the_block():
    mesh = block(length=0.05, bottom=0.0, top=0.0185, elements=(13, 7), grading=(2.0, 0.5))
    mass = lumped_mass(mesh, np.array([965.0]))
    assert mass.sum() == pytest.approx(965.0 * 0.05 * 0.0185, rel=1e-12)


@given(depth=st.floats(1e-3, 18.5e-3))
def test_depth_weights_add_up_and_stop_at_the_depth(depth):
    y = graded(0.0, 18.5e-3, 11, 0.3)
    weights = depth_weights(y, 18.5e-3, depth)
    assert weights.sum() == pytest.approx(1.0)
    assert (weights[y[1:] < 18.5e-3 - depth] == 0).all()


def test_nodes_take_the_mean_of_their_neighbours():
    assert to_nodes(np.array([1.0, 3.0, 5.0])) == pytest.approx([1, 2, 4, 5])
