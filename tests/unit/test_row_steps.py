"""Rows of elements with steps of their own: which they get; threads, restarts and equal steps change no bit."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest

from support.bilayers import struck_bilayer
from support.cases import EXAMPLES
from support.models import run
from wrinklewave.config import load_case
from wrinklewave.dynamics import row_steps, step
from wrinklewave.dynamics.boundary import N_TOTALS
from wrinklewave.dynamics.checkpoint import Record, read_checkpoint, write_checkpoint
from wrinklewave.dynamics.model import Model, build_model
from wrinklewave.dynamics.row_steps import MOST, Plan, plan
from wrinklewave.dynamics.shares import shares_of
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.dynamics.step import advance

STATE = ("u", "w", "vx", "vy")
EVENTS = np.linspace(0.0, 8e-5, 5)


def state(model: Model) -> list[np.ndarray]:
    assert model.row_steps is not None
    return [*(getattr(model.arrays, name) for name in STATE), model.memory, *model.row_steps]


@pytest.mark.parametrize(
    "stable",
    [
        np.full(12, 3e-7),
        np.r_[np.full(8, 7.7e-7), np.full(4, 9.2e-8)],
        np.r_[np.full(8, 1e-4), np.full(4, 9.2e-8)],
        np.r_[5e-7, 6e-7, 2e-7, 9e-7, 1.1e-7, 1e-7, 2e-7],
        np.random.default_rng(5).uniform(1e-7, 1e-6, 40),
    ],
)
def test_a_plan_is_stable_and_graded(stable):
    found = plan(stable)
    steps = found.step / found.counts
    assert found.counts[0] == 1
    assert np.all(steps <= stable * (1 + 1e-9))
    assert np.all(np.isin(found.counts[1:] // found.counts[:-1], (1, 2)))  # shrink upwards, by half at most
    assert found.counts[-1] <= MOST
    uniform = stable.size / stable.min()
    assert found.counts.sum() / found.step <= uniform * (1 + 1e-9)  # it never costs more than equal steps


def test_equal_rows_have_equal_steps_and_a_film_does_not_set_the_others():
    assert plan(np.full(9, 2e-7)) == (2e-7, pytest.approx(np.ones(9)))
    found = plan(np.r_[np.full(51, 7.7e-7), np.full(4, 9.2e-8)])
    np.testing.assert_array_equal(found.counts[-8:], [1, 1, 2, 4, 8, 8, 8, 8])
    assert found.step == pytest.approx(8 * 9.2e-8)


@pytest.mark.parametrize("parts", [1, 2, 3, 7])
def test_shares_are_of_about_the_same_work(parts):
    counts = np.r_[np.ones(49), 2, 4, 8, 8, 8, 8].astype(np.int64)
    shares = shares_of(counts, parts)
    assert (shares[0], shares[-1]) == (0, counts.size)
    assert np.all(np.diff(shares) >= 1)
    work = [counts[first:last].sum() for first, last in pairwise(shares)]
    assert max(work) <= counts.sum() / parts + 20


@pytest.mark.parametrize("precision", ["double", "mixed"])
@pytest.mark.parametrize("threads", [2, 3, 9])
def test_the_number_of_threads_changes_no_bit(threads, precision, monkeypatch):
    monkeypatch.setattr("wrinklewave.dynamics.team.MOST_HELPERS", 10)
    totals, found = [], []
    counts = np.array([1, 1, 1, 1, 1, 2, 4, 8, 8, 8], dtype=np.int64)
    for parts in (1, threads):
        model, sums = struck_bilayer(threads=parts, precision=precision), np.zeros(N_TOTALS)
        a = model.arrays._replace(shares=shares_of(counts, parts))
        rest = (model.memory_rows, model.terms, model.boundary, sums)
        for n, width in ((80, 2.5e-7), (40, 2e-7)):  # the step changes on the way
            row_steps.advance(n, 0.0, Plan(width, counts), model.row_steps, a, *rest)
        totals.append(sums)
        found.append(state(model))
    assert np.abs(found[0][0]).max() > 1e-7
    assert all(np.array_equal(one, many) for one, many in zip(*found, strict=True))
    assert np.array_equal(*totals)


def test_equal_steps_are_those_of_the_ordinary_march():
    found, dt = [], 2e-8
    for own_steps in (False, True):
        model, totals = struck_bilayer(own_steps=own_steps), np.zeros(N_TOTALS)
        rest = (model.arrays, model.memory_rows, model.terms, model.boundary, totals)
        if own_steps:
            equal = Plan(dt, np.ones(model.mesh.shape[0], dtype=np.int64))
            row_steps.advance(800, 0.0, equal, model.row_steps, *rest)
            assert np.abs(model.arrays.u).max() > 1e-7
            assert np.array_equal(model.row_steps.vx, model.arrays.vx)
        else:
            advance(800, 0.0, 0.0, dt, *rest)
        found.append([*(getattr(model.arrays, name) for name in STATE), model.memory, totals])
    assert all(np.array_equal(one, other) for one, other in zip(*found, strict=True))


def test_a_restart_changes_no_bit(tmp_path):
    whole, path = run(struck_bilayer(), EVENTS), tmp_path / "checkpoint.h5"
    first = run(struck_bilayer(), EVENTS[:3])
    first.events = EVENTS
    write_checkpoint(path, first, Record({"times": EVENTS}), "case")
    second = Simulation(struck_bilayer(), EVENTS)
    read_checkpoint(path, second, "case")
    for _ in second.run():
        pass
    assert whole.ratio == second.ratio == MOST
    assert whole.history == second.history
    assert whole.updates == second.updates
    assert all(np.array_equal(*pair) for pair in zip(state(whole.model), state(second.model), strict=True))
    assert np.array_equal(whole.fields(), second.fields())


def test_a_failure_in_a_share_lets_nobody_wait(monkeypatch):
    model = struck_bilayer()

    def fail(*_):
        raise RuntimeError("no memory")

    monkeypatch.setattr(step, "share_out", fail)
    plan_of_one = Plan(1e-8, np.ones(model.mesh.shape[0], dtype=np.int64))
    rest = (model.arrays, model.memory_rows, model.terms, model.boundary, np.zeros(N_TOTALS))
    with pytest.raises(RuntimeError, match="no memory"):
        row_steps.advance(1, 0.0, plan_of_one, model.row_steps, *rest)
    assert (model.arrays.counts == step.ABANDONED).all()


def test_only_films_in_the_mesh_have_steps_of_their_own():
    case = load_case(EXAMPLES / "paper_resolved.toml")
    assert build_model(case).row_steps is not None
    for choice in ("solver.subcycling=false", "wrinkles.model=none"):
        assert build_model(case.overridden(choice)).row_steps is None


def test_a_straight_end_has_one_step_for_all():
    end = "{kind='end-motion', transverse='linear', velocity='1 m/s', "
    end += "stop_distance='1 mm', overshoot='2 mm', overshoot_time='1 ms'}"
    case = load_case(EXAMPLES / "paper_resolved.toml", [f"drive={end}"])
    assert build_model(case).row_steps is None
