"""Unilateral contact with the rigid plate: no penetration, no tension, impulse equal to momentum, Coulomb's bound.

And the impact of an elastic bar in one-dimensional strain, whose contact lasts 2 L/c under the force rho c V.
"""

from __future__ import annotations

import numpy as np
import pytest

from support.cases import impact, paper_impact
from support.ledger import Verified, order
from support.models import ELEMENTS, K_0, MU_0, RHO, Array, build, elastic, march, relaxing, stable_step
from wrinklewave.dynamics.boundary import IMPULSE_ACROSS, IMPULSE_LEFT, LEFT_STRUCK, ROLLER, position
from wrinklewave.dynamics.model import AT_REST, Model, build_model
from wrinklewave.materials.moduli import plane_wave_modulus
from wrinklewave.mesh.block import block

LENGTH, HEIGHT = 20e-3, 8e-3


def moving_plate(velocity: float) -> Array:
    """Position of a plate that moves at a constant velocity for ever, as a history [1, 6]."""
    return np.array([[0.0, 1.0, 0.0, velocity, velocity, velocity]])


def momentum_along(model: Model) -> float:
    return float(np.sum(model.arrays.vx / model.arrays.inverse_mass))


@pytest.mark.parametrize("element", ELEMENTS)
def test_a_struck_block_is_pushed_and_never_pulled(element: str, verified: Verified) -> None:
    # gap >= 0, N >= 0 and N gap = 0: at every step of an impact with lift-off
    model = build_model(impact(element, "elastic-long-term", "drive.stop_distance=2 mm"))
    a, plate, dt = model.arrays, model.boundary.motion, 0.8 * stable_step(model)
    deepest, least, lifted, pushed = 0.0, 0.0, 0, 0.0
    for n, totals in enumerate(march(model, dt, int(1.2e-3 / dt))):
        gap = float((a.X[:, 0] + a.u[:, 0] - position(plate, (n + 1) * dt)).min())
        impulse, pushed = totals[IMPULSE_LEFT] - pushed, float(totals[IMPULSE_LEFT])
        deepest, least = min(deepest, gap), min(least, impulse)
        if gap > 1e-9:
            lifted += 1
            assert impulse == 0.0
    assert lifted > 10  # the block does leave the plate
    verified.error(
        f"deepest penetration of the plate over the block's length, {element}", -deepest / 50.4e-3, 1e-15
    )
    verified.error(f"largest tension over the whole impulse, {element}", -least / pushed, 0.0)


@pytest.mark.parametrize("element", ELEMENTS)
def test_impulse_is_the_change_of_momentum(element: str, verified: Verified) -> None:
    # a free block struck by a moving plate: sum m v = ∫ N dt, and it flies off faster than the plate
    V = 1.0
    mesh = block(length=LENGTH, bottom=0.0, top=HEIGHT, elements=(40, 16))
    model = build(mesh, elastic(), element, left=LEFT_STRUCK, motion=moving_plate(V))
    dt, worst = 0.8 * stable_step(model), 0.0
    for totals in march(model, dt, int(6e-3 / dt)):
        worst = max(worst, abs(momentum_along(model) - totals[IMPULSE_LEFT]))
    gap = float((model.arrays.X[:, 0] + model.arrays.u[:, 0]).min() - V * 6e-3)
    mass = RHO * LENGTH * HEIGHT
    verified.error(
        f"momentum of a struck free block minus the plate's impulse, relative, {element}",
        worst / (mass * V),
        1e-12,
    )
    # a plate of infinite mass gives a body that loses nothing 2 V; what stays behind as vibration is missing
    verified.between(
        f"speed of the block after the stroke over the plate's, {element}",
        momentum_along(model) / (mass * V),
        1.5,
        2.0,
    )
    assert gap > 0


def bar_impact(element: str, columns: int) -> tuple[float, float, float]:
    """Duration of the contact over 2 L/c, mean force over rho c V, rebound speed over V."""
    V, size = 0.01, LENGTH / columns
    material = elastic()
    c = np.sqrt(plane_wave_modulus(MU_0, K_0) / RHO)
    mesh = block(length=LENGTH, bottom=0.0, top=size, elements=(columns, 1))
    model = build(mesh, material, element, left=LEFT_STRUCK, top=ROLLER, bottom=ROLLER, motion=AT_REST)
    model.arrays.vx[:] = -V
    dt = 0.5 * stable_step(model)
    pushed, last = 0.0, 0.0
    for n, totals in enumerate(march(model, dt, int(3 * LENGTH / c / dt))):
        if totals[IMPULSE_LEFT] > pushed:
            last = (n + 1) * dt
        pushed = float(totals[IMPULSE_LEFT])
    mass = RHO * LENGTH * size
    return last / (2 * LENGTH / c), pushed / last / (RHO * c * V * size), momentum_along(model) / (mass * V)


@pytest.mark.parametrize("element", ELEMENTS)
def test_impact_of_an_elastic_bar_on_a_rigid_plate(element: str, verified: Verified) -> None:
    found = np.array([bar_impact(element, columns) for columns in (50, 100, 200)])
    for name, column in zip(
        ("duration over 2 L/c", "mean force over rho c V", "rebound speed over V"), found.T, strict=True
    ):
        verified.value(f"bar impact, {name}, 200 elements, {element}", float(column[-1]), 1.0, relative=0.02)
    errors = [float(e) for e in np.abs(found - 1).max(axis=1)]
    verified.between(f"order in h of the bar impact, {element}", order(errors), 0.6, 1.2)


@pytest.mark.parametrize("element", ELEMENTS)
def test_friction_of_a_sliding_block(element: str, verified: Verified) -> None:
    # T = -mu N while it slides: a block that flies along the plate, fast, and is struck by it
    mu = 0.3
    mesh = block(length=LENGTH, bottom=0.0, top=HEIGHT, elements=(20, 8))
    model = build(
        mesh, relaxing(bulk=False), element, left=LEFT_STRUCK, motion=moving_plate(0.5), friction=mu
    )
    model.arrays.vy[:] = 5.0
    dt, worst = 0.8 * stable_step(model), 0.0
    for totals in march(model, dt, int(2e-4 / dt)):
        worst = max(worst, abs(totals[IMPULSE_ACROSS] + mu * totals[IMPULSE_LEFT]))
    assert model.arrays.vy[:, 0].min() > 0
    verified.error(
        f"|T + mu N| over mu N, sliding, {element}", worst / float(mu * totals[IMPULSE_LEFT]), 1e-12
    )


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("mu", [0.1, 5.0])
def test_friction_stays_below_coulombs_bound(element: str, mu: float, verified: Verified) -> None:
    # |T| <= mu N at every step, also while the block sticks, bulges or slides back
    mesh = block(length=LENGTH, bottom=0.0, top=HEIGHT, elements=(20, 8))
    model = build(
        mesh, relaxing(bulk=False), element, left=LEFT_STRUCK, motion=moving_plate(2.0), friction=mu
    )
    model.arrays.vy[:] = 0.1
    dt, excess = 0.8 * stable_step(model), -np.inf
    before = np.zeros(2)
    for totals in march(model, dt, int(5e-4 / dt)):
        now = totals[[IMPULSE_LEFT, IMPULSE_ACROSS]].copy()
        N, T = now - before
        excess, before = max(excess, abs(T) - mu * N), now
    verified.error(
        f"excess of friction over mu N, mu = {mu}, relative, {element}",
        max(excess, 0.0) / float(before[0]),
        1e-15,
    )


@pytest.mark.parametrize("element", ELEMENTS)
def test_the_surface_does_not_pass_the_wall(element: str, verified: Verified) -> None:
    # x <= L for the free surface, bulging over the held end
    run = paper_impact(element, "elastic-long-term", (50, 18), "solver.end_time=3.5 ms")
    beyond = float(np.nanmax(run.surface["x_p"].values) / 50.4e-3 - 1)
    verified.error(f"the surface beyond the wall over the block's length, {element}", max(beyond, 0.0), 1e-12)
