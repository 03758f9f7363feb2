"""The processor: the state lies where the model has it."""

from __future__ import annotations

import time
from collections import deque
from dataclasses import dataclass
from statistics import median_low
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.compiling import compiled_beside
from wrinklewave.dynamics import row_steps
from wrinklewave.dynamics.backends import March, Sample, Snapshot
from wrinklewave.dynamics.boundary import N_TOTALS
from wrinklewave.dynamics.energy import KINETIC, N_COLUMNS, N_SUMS, survey_share
from wrinklewave.dynamics.fields import FIELDS, fields_share, set_aside
from wrinklewave.dynamics.row_steps import Plan
from wrinklewave.dynamics.shares import shares_of
from wrinklewave.dynamics.stable_step import stable_steps_share
from wrinklewave.dynamics.step import advance
from wrinklewave.dynamics.team import share_out

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from wrinklewave.dynamics.model import Model
    from wrinklewave.dynamics.step import Arrays


class Pace:
    """Whether to step on all threads or on one, whichever is faster at the time.

    Threads wait for each other at every step, so they are slow when another process takes their cores. Results do not
    depend on their number, so it may change from one group of steps to the next. Each choice counts by the median of
    its last :data:`MEMORY` groups: one group that was held up, as the first often is, says nothing. All choices are
    tried :data:`TRIES` times, then the slower one again every :data:`RETRY` groups.
    """

    TRIES = 3
    RETRY = 40
    MEMORY = 5

    def __init__(self, choices: list[Arrays]) -> None:
        self._choices = choices
        self._seconds: list[deque[float]] = [deque(maxlen=self.MEMORY) for _ in choices]  # per step
        self._groups = 0
        self._current = 0

    def choose(self) -> Arrays:
        """The arrays, shared out to the number of threads that the next group should have."""
        self._groups += 1
        tries = [len(seconds) for seconds in self._seconds]
        if min(tries) < self.TRIES:
            self._current = tries.index(min(tries))
        else:
            medians = [median_low(seconds) for seconds in self._seconds]
            fastest = medians.index(min(medians))
            slower = (fastest + 1) % len(self._choices)
            self._current = slower if self._groups % self.RETRY == 0 else fastest
        return self._choices[self._current]

    def note(self, seconds: float) -> None:
        """Take down what a step of the last group took."""
        self._seconds[self._current].append(seconds)


@dataclass(frozen=True, eq=False)
class _Slot:
    """Room for a state, used over and over: memory that is new to the process costs more than what is copied to it."""

    nodal: NDArray[np.float64]
    memory: NDArray[np.float64]
    factors: NDArray[np.float64]

    @classmethod
    def of(cls, model: Model) -> _Slot:
        nodal = np.empty((4, *model.mesh.X.shape), model.arrays.u.dtype)
        return cls(nodal, np.empty_like(model.memory), np.empty_like(model.arrays.factors))


def _with_mean_velocities(model: Model) -> Arrays:
    """The arrays with what outputs see: where rows have steps of their own, velocities are means of a large step."""
    steps = model.row_steps
    return model.arrays if steps is None else model.arrays._replace(vx=steps.vx, vy=steps.vy)


class Cpu:
    """A :class:`~wrinklewave.dynamics.backends.Backend` on one or more threads; results do not depend on how many."""

    def __init__(self, model: Model) -> None:
        rows, columns = model.mesh.shape
        parts = model.arrays.shares.size - 1
        self._model, self._parts = model, parts
        self._memory = model.memory_rows
        self._steps = np.zeros((rows, columns))
        self._survey = np.zeros((rows + 1, N_SUMS))
        self._work = np.zeros((parts, N_COLUMNS, columns))
        self._alone = model.arrays._replace(shares=np.array([0, rows]))
        self._mean = _with_mean_velocities(model)
        self._pace = Pace([model.arrays, self._alone] if parts > 1 else [model.arrays])
        self._slots: list[_Slot] = []  # that no snapshot holds
        self._compiled = False

    def march(self, wanted: March) -> Sample:
        """Step, and survey the state."""
        self._compile()
        shared, totals = self._pace.choose(), np.zeros(N_TOTALS)
        begin = time.perf_counter()
        self._advance(wanted, shared, totals)
        seconds = time.perf_counter() - begin
        self._pace.note(seconds / wanted.n)
        a = self._mean if wanted.counts is None else row_steps.seen_over(wanted.dt, self._mean)
        terms = self._model.terms
        share_out(survey_share, self._parts, wanted.dt, a, self._memory, terms, self._work, self._survey)
        kinetic, corner = float(self._survey[:, KINETIC].sum()), (a.u[-1, 0], a.w[-1, 0])
        return Sample(seconds, self._survey[:-1, :N_COLUMNS], kinetic, totals, corner)

    def _advance(self, wanted: March, shared: Arrays, totals: NDArray[np.float64]) -> None:
        m, t = self._model, wanted.start
        state = (self._memory, m.terms, m.boundary, totals)
        if wanted.counts is None or m.row_steps is None:
            advance(wanted.n, t, wanted.last_dt, wanted.dt, shared, *state)
            return
        shared = shared._replace(shares=shares_of(wanted.counts, shared.shares.size - 1))
        row_steps.advance(wanted.n, t, Plan(wanted.dt, wanted.counts), m.row_steps, shared, *state)

    def _compile(self) -> None:
        """Take no step once, so that the time of the first steps is not that of the compiler."""
        if self._compiled:
            return
        m, steps = self._model, self._model.row_steps
        counts = None if steps is None else np.ones(m.mesh.shape[0], dtype=np.int64)
        a = self._mean
        survey = (0, 1.0, a, self._memory, m.terms, self._work, self._survey)
        fields = (0, a, self._memory, m.terms, np.empty((len(FIELDS), 1, 1)))
        stable = (0, m.arrays, m.density, self._steps)
        with compiled_beside((survey_share, survey), (fields_share, fields), (stable_steps_share, stable)):
            self._advance(March(0, 0.0, 0.0, 1.0, counts), m.arrays, np.zeros(N_TOTALS))
        self._compiled = True

    def stable_steps_of_rows(self) -> NDArray[np.float64]:
        """The smallest of each row [s]."""
        least: NDArray[np.float64] = self.stable_steps().min(axis=1)
        return least

    def stable_steps(self) -> NDArray[np.float64]:
        """Largest stable step of each element [s]."""
        self._compile()
        share_out(stable_steps_share, self._parts, self._model.arrays, self._model.density, self._steps)
        return self._steps

    def snapshot(self) -> Callable[[], Snapshot]:
        """Copy the state; its fields can be computed while the next steps are taken."""
        self._compile()
        a, slot = self._mean, self._slots.pop() if self._slots else _Slot.of(self._model)
        set_aside(a.u, a.w, a.vx, a.vy, self._model.memory, slot.nodal, slot.memory)
        slot.factors[:] = a.factors

        def fields() -> Snapshot:
            u, w, vx, vy = slot.nodal
            then = self._alone._replace(u=u, w=w, vx=vx, vy=vy, factors=slot.factors)
            out = np.empty((len(FIELDS), *self._model.mesh.shape))
            fields_share(0, then, tuple(slot.memory), self._model.terms, out)
            found = Snapshot(slot.nodal.copy(), out)
            self._slots.append(slot)
            return found

        return fields

    def fetch_all(self) -> None:
        """Nothing to do: the state is where it should be."""
