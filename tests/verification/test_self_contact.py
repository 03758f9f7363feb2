"""A surface that folds onto itself: bodies do not share space, momentum is kept, energy is accounted for."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
import pytest

from wrinklewave.dynamics.boundary import CONTACT_LOSS, FREE, LEFT_MOVED, N_TOTALS, ROLLER, TOP, Boundary
from wrinklewave.dynamics.model import Model, assemble
from wrinklewave.dynamics.self_contact import keep_apart
from wrinklewave.dynamics.step import advance
from wrinklewave.materials.moduli import Viscoelastic, bulk_modulus
from wrinklewave.mesh.block import GridMesh

if TYPE_CHECKING:
    from support.ledger import Verified

LENGTH, HEIGHT, COLUMNS, ROWS = 10e-3, 5e-3, 60, 24


def grooved_block(*, self_contact: bool) -> Model:
    """A block whose surface has a deep groove, between a frictionless floor and a plate that pushes its left side."""
    x = np.linspace(0.0, LENGTH, COLUMNS + 1)
    surface = HEIGHT - 3.5e-3 * np.exp(-(((x - LENGTH / 2) / 0.7e-3) ** 2))
    X, share = np.meshgrid(x, np.linspace(0.0, 1.0, ROWS + 1))
    mesh = GridMesh(X=X, Y=share * surface, layer=np.zeros((ROWS, COLUMNS), dtype=np.int64))
    none = np.zeros(0)
    solid = Viscoelastic(965.0, 44e3, bulk_modulus(44e3, 0.45), none, none, none)
    boundary = Boundary(
        left=LEFT_MOVED,
        right=ROLLER,
        top=FREE,
        bottom=ROLLER,
        wall=False,
        length=LENGTH,
        friction=0.0,
        motion=np.array([[0.0, 2e-3, 0.0, 3e-3, 0.0, 0.0]]),
        motion_across=np.zeros((1, 6)),
        old=np.zeros((3, 4, COLUMNS + 1)),
        bins=np.zeros((3, 2, (COLUMNS + 1) * self_contact), dtype=np.int64),
    )
    return assemble(mesh, [solid], boundary)


def overlap(model: Model) -> float:
    """How far the two sides of the groove have passed each other, at most, in element lengths."""
    a = model.arrays
    x, y = a.X[-1] + a.u[-1], a.Y[-1] + a.w[-1]
    middle = COLUMNS // 2
    left, right = slice(middle - 12, middle), slice(middle + 1, middle + 13)
    heights = np.linspace(max(y[left].min(), y[right].min()), min(y[left].max(), y[right].max()), 200)
    order = np.argsort(y[left])
    face = np.interp(heights, y[left][order], x[left][order])
    order = np.argsort(y[right])
    return float((face - np.interp(heights, y[right][order], x[right][order])).max() / (LENGTH / COLUMNS))


@pytest.mark.parametrize("self_contact", [True, False])
def test_a_closing_groove_does_not_close_beyond_contact(self_contact: bool, verified: Verified) -> None:
    """Its sides touch and stay where they touch; without the contact they pass through each other."""
    model, totals, dt = grooved_block(self_contact=self_contact), np.zeros(N_TOTALS), 4e-7
    for n in range(40):
        state = model.arrays, model.memory_rows, model.terms, model.boundary
        advance(100, n * 100 * dt, dt if n else 0.0, dt, *state, totals)
    if self_contact:
        verified.error(
            "overlap of a surface in contact with itself, per element", max(overlap(model), 0.0), 0.2
        )
        assert totals[CONTACT_LOSS] >= 0.0
    else:
        assert overlap(model) > 2.0


def folded_block() -> Model:
    """The same with the sides of the groove past each other, its surface at random velocities."""
    model = grooved_block(self_contact=True)
    a = model.arrays
    a.u[-1] = (LENGTH / 2 - a.X[-1]) * 0.8
    a.u[-1, COLUMNS // 2 - 6 : COLUMNS // 2] += 0.6e-3
    a.vx[-1], a.vy[-1] = np.random.default_rng(0).normal(size=(2, COLUMNS + 1))
    return model


def test_contact_keeps_momentum(verified: Verified) -> None:
    """sum m v does not change by impulses within the body."""
    model = folded_block()
    a = model.arrays
    mass = 1.0 / a.inverse_mass[-1]

    def momentum() -> np.ndarray:
        return np.array([(mass * a.vx[-1]).sum(), (mass * a.vy[-1]).sum()])

    before, velocities = momentum(), a.vx[-1].copy()
    keep_apart(a, ROWS, 1.0, 1e-6, model.boundary.old[TOP], model.boundary.bins[TOP])
    assert (a.vx[-1] != velocities).any()  # something touched
    given = np.abs(momentum() - before).max() / (mass * np.hypot(a.vx[-1], a.vy[-1])).sum()
    verified.error("momentum given to a body by contact with itself", float(given), 1e-12)


def test_a_lower_surface_is_an_upper_one_upside_down() -> None:
    upper, lower = folded_block(), folded_block()
    for turned in (lower.arrays.Y, lower.arrays.w, lower.arrays.vy):
        turned *= -1.0
    losses = []
    for model, side in ((upper, 1.0), (lower, -1.0)):
        a, old = model.arrays, model.boundary.old[TOP]
        old[:] = a.u[-1], a.w[-1], a.vx[-1], a.vy[-1]
        losses.append(keep_apart(a, ROWS, side, 1e-6, old, model.boundary.bins[TOP]))
    assert losses[0] != 0.0
    assert losses[1] == pytest.approx(losses[0], rel=1e-12)
    for name, sign in (("u", 1.0), ("vx", 1.0), ("w", -1.0), ("vy", -1.0)):
        np.testing.assert_allclose(
            getattr(lower.arrays, name), sign * getattr(upper.arrays, name), rtol=1e-12
        )


def test_what_overhangs_nowhere_is_left_alone() -> None:
    """Also where the undeformed surface overhangs and the motion has undone it."""
    model = folded_block()
    a = model.arrays
    a.X[-1] = a.X[-1] + a.u[-1]
    a.u[-1] = np.linspace(0.0, LENGTH, COLUMNS + 1) - a.X[-1]
    before = a.vx[-1].copy()
    assert keep_apart(a, ROWS, 1.0, 1e-6, model.boundary.old[TOP], model.boundary.bins[TOP]) == 0.0
    np.testing.assert_array_equal(a.vx[-1], before)


def test_one_node_in_contact_loses_the_energy_that_is_counted() -> None:
    """A tip that hangs 0.05 mm through a segment: energy, momentum and angular momentum of one impulse, exactly."""
    model = grooved_block(self_contact=True)
    a, mm = model.arrays, 1e-3
    x = np.array([0, 1, 2, 3, 3, 2.4, 1.5, 0.6, 0.6, *np.arange(1, COLUMNS - 7)]) * mm
    y = np.array([0, 0, 0, 0, 2, 2, -0.05, 2, 4, *np.full(COLUMNS - 8, 4)]) * mm
    a.u[-1], a.w[-1] = x - a.X[-1], y - a.Y[-1]
    a.vx[-1], a.vy[-1] = np.random.default_rng(3).normal(size=(2, COLUMNS + 1))
    a.vy[-1, 6] = -5.0
    old = model.boundary.old[TOP]
    old[:] = a.u[-1], a.w[-1], a.vx[-1], a.vy[-1]
    loss = keep_apart(a, ROWS, 1.0, 1e-6, old, model.boundary.bins[TOP])
    mass = 1.0 / a.inverse_mass[-1]
    gained = mass * (a.vx[-1] - old[2]), mass * (a.vy[-1] - old[3])
    assert np.flatnonzero(gained[1]).tolist() == [1, 2, 6]
    assert loss == pytest.approx(
        0.5 * (mass * (old[2] ** 2 + old[3] ** 2 - a.vx[-1] ** 2 - a.vy[-1] ** 2)).sum()
    )
    largest = np.abs(gained[1]).max()
    assert [gained[0].sum(), gained[1].sum()] == pytest.approx([0.0, 0.0], abs=1e-12 * largest)
    assert (x * gained[1] - y * gained[0]).sum() == pytest.approx(0.0, abs=1e-12 * largest * mm)
    # what is left of the approach returns a hundredth of the overlap in this step
    assert a.vy[-1, 6] - a.vy[-1, 1:3].mean() == pytest.approx(0.01 * 0.05 * mm / 1e-6)
    np.testing.assert_allclose(a.u[-1] - old[0], 1e-6 * (a.vx[-1] - old[2]), atol=1e-18)
