"""Steps of their own for rows of elements: what an asynchronous variational integrator keeps, and its order.

Every impulse acts on nodes that are at its time, so sum m v and sum m x × v change by nothing that is not external, at
every time that all rows have in common; errors are of the order of the square of the steps.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from support.bilayers import free_bilayer, struck_bilayer
from support.ledger import Verified, order
from support.models import Array, history, run
from wrinklewave.dynamics import row_steps
from wrinklewave.dynamics.boundary import LEFT_MOVED, N_TOTALS
from wrinklewave.dynamics.model import Model
from wrinklewave.dynamics.row_steps import Plan

ROUNDING = 1e-12
COUNTS = np.array([1, 1, 1, 1, 1, 2, 4, 8, 8, 8], dtype=np.int64)
END = 6.4e-5


def advance(model: Model, n: int, step: float, counts: Array = COUNTS) -> None:
    rest = (model.arrays, model.memory_rows, model.terms, model.boundary, np.zeros(N_TOTALS))
    assert model.row_steps is not None
    row_steps.advance(n, 0.0, Plan(step, counts), model.row_steps, *rest)


def momenta(model: Model) -> Array:
    """Sums of m v [N s/m] and of m x × v [N s]."""
    a = model.arrays
    m = 1 / a.inverse_mass
    turning = np.sum(m * ((a.X + a.u) * a.vy - (a.Y + a.w) * a.vx))
    return np.array([np.sum(m * a.vx), np.sum(m * a.vy), turning])


def test_a_free_body_keeps_its_momenta(verified: Verified) -> None:
    model = free_bilayer()
    before = momenta(model)
    advance(model, 100, 3e-7)
    advance(model, 100, 2e-7)  # the first steps are of two lengths
    change = np.abs(momenta(model) / before - 1)
    verified.error(
        "sub-cycling: change of a free body's momentum, relative", float(change[:2].max()), ROUNDING
    )
    verified.error("sub-cycling: change of its angular momentum, relative", float(change[2]), ROUNDING)


def test_energy_of_a_free_body(verified: Verified) -> None:
    # many short steps without any damping: nothing grows
    simulation = run(free_bilayer(), np.linspace(0.0, 2e-3, 101), history_interval=1.0)
    h = history(simulation)
    total = h["kinetic_J_per_m"] + h["elastic_J_per_m"]
    assert simulation.ratio > 1
    assert simulation.step * simulation.ratio > 20_000
    verified.error(
        "sub-cycling: drift of a free body's energy, relative",
        float(np.abs(total[-20:].mean() / total[:20].mean() - 1)),
        1e-2,
    )


def test_second_order_in_the_step(verified: Verified) -> None:
    # without bulk viscosity, which sees velocities half a step late and so is of first order
    surfaces = []
    for refinement in (1, 2, 4, 8):
        model, step = struck_bilayer(left=LEFT_MOVED, bulk_viscosity=(0.0, 0.0)), 4e-7 / refinement
        advance(model, round(END / step), step)
        surfaces.append(np.stack([model.arrays.u[-1], model.arrays.w[-1]]))
    changes = [float(np.abs(b - a).max()) for a, b in pairwise(surfaces)]
    verified.between("sub-cycling: order in the step", order(changes), 1.7, 2.3)


@pytest.mark.parametrize("one_point", [True, False], ids=["one-point", "mean-dilatation"])
def test_an_impact_is_that_of_equal_steps(one_point: bool, verified: Verified) -> None:
    found = [
        run(struck_bilayer(own_steps=own, one_point=one_point), np.linspace(0.0, 2e-4, 21))
        for own in (False, True)
    ]
    equal, own = (np.stack([s.model.arrays.u[-1], s.model.arrays.w[-1]]) for s in found)
    element = "one-point" if one_point else "mean-dilatation"
    assert found[1].ratio >= 4
    assert 2.0 * found[1].updates < found[0].updates
    verified.error(
        f"sub-cycling: surface against equal steps, over its motion, {element}",
        float(np.abs(own - equal).max() / np.abs(equal).max()),
        1e-3,
    )
    # the plate's work on rows of short steps is known up to half a large step later than the energies
    h = history(found[1])
    power = np.gradient(h["external_work_J_per_m"], h["time_s"]).max()
    imbalance = np.abs(h["imbalance_J_per_m"]).max() / (0.5 * power * h["dt_s"].max())
    verified.error(
        f"sub-cycling: energy imbalance over work in half a step, {element}", float(imbalance), 1.0
    )
