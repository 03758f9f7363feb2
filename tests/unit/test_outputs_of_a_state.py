"""What is taken from the state on the way: snapshots, which outlive it, and samples of its energies."""

import numpy as np
import pytest

from support.backend_models import MODELS, struck
from wrinklewave.dynamics.backends import March
from wrinklewave.dynamics.simulation import Simulation

END = 1e-4


def at_the_end(model, **choices) -> Simulation:
    simulation = Simulation(model, np.array([0.0, END]), **choices)
    for _ in simulation.run():
        pass
    return simulation


def further(simulation: Simulation) -> None:
    """Some more steps."""
    simulation.backend.march(March(20, END, simulation.dt, simulation.dt))


def test_snapshot_is_that_of_its_time_however_late_its_fields_are_made():
    simulation = at_the_end(struck())
    at_once = simulation.backend.snapshot()()
    waiting = [simulation.backend.snapshot() for _ in range(2)]
    further(simulation)
    later = simulation.backend.snapshot()()
    assert not np.array_equal(later.nodal, at_once.nodal)
    for late in (fields() for fields in waiting):
        assert np.array_equal(late.nodal, at_once.nodal)
        assert np.array_equal(late.elements, at_once.elements)


def test_fields_stay_when_the_room_of_their_snapshot_is_used_again():
    simulation = at_the_end(struck())
    first = simulation.backend.snapshot()()
    nodal, elements = first.nodal.copy(), first.elements.copy()
    further(simulation)
    simulation.backend.snapshot()()
    assert np.array_equal(first.nodal, nodal)
    assert np.array_equal(first.elements, elements)


@pytest.mark.parametrize("name", MODELS)
def test_kinetic_energy_is_that_of_all_nodes(name):
    simulation = at_the_end(MODELS[name]())
    counts = simulation.counts if simulation.subcycles else None
    sample = simulation.backend.march(March(1, END, simulation.dt, simulation.dt, counts))
    a = simulation.model.arrays
    v = simulation.model.row_steps or a  # means of a large step, where rows have steps of their own
    vx, vy, inverse_mass = (values.astype(np.float64) for values in (v.vx, v.vy, a.inverse_mass))
    moving = inverse_mass > 0
    expected = 0.5 * np.sum((vx[moving] ** 2 + vy[moving] ** 2) / inverse_mass[moving])
    assert expected > 0
    assert sample.kinetic == pytest.approx(expected, rel=1e-13)


def test_history_has_one_row_for_each_interval_of_the_outputs():
    # steps that fill the interval between outputs are 1/n of it, and n of them must not count as less than it
    events = 1e-6 * np.arange(0.0, 200.0, 5.0)
    simulation = Simulation(struck(), events, safety=0.2, history_interval=5e-6)
    for _ in simulation.run():
        pass
    assert simulation.step > 4 * events.size
    assert [row[0] for row in simulation.history] == pytest.approx(events[1:], rel=1e-12)
