"""A model in time: from event to event, with the stable step estimated anew on the way, and the energies followed."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.dynamics.asking import answered
from wrinklewave.dynamics.backends import Backend, Device, March, Sample, backend_for
from wrinklewave.dynamics.boundary import CONTACT_LOSS, FORCE, FRICTION_LOSS, N_TOTALS, WORK
from wrinklewave.dynamics.energy import (
    BULK_VISCOUS,
    HOURGLASS,
    HOURGLASS_AMPLITUDE,
    J_LEAST,
    J_MOST,
    SPRINGS,
    STORED,
)
from wrinklewave.dynamics.row_steps import plan
from wrinklewave.errors import RunError
from wrinklewave.materials.neo_hookean import J_MAX, J_MIN

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator

    from numpy.typing import NDArray

    from wrinklewave.dynamics.model import Model

HISTORY = (
    "time_s",
    "step",
    "dt_s",
    "kinetic_J_per_m",
    "elastic_J_per_m",
    "springs_J_per_m",
    "viscous_work_J_per_m",
    "bulk_viscosity_J_per_m",
    "hourglass_J_per_m",
    "contact_loss_J_per_m",
    "friction_J_per_m",
    "external_work_J_per_m",
    "imbalance_J_per_m",
    "x_boundary_m",
    "y_boundary_m",
    "contact_force_N_per_m",
    "hourglass_amplitude",
    "volume_ratio_min",
    "volume_ratio_max",
)
"""Columns of the history. Energies are per metre of width, at mid-step; ``viscous_work`` is the whole work of the
overstress, of which ``springs`` is stored still and the rest dissipated."""

SMALLEST_STEP = 1e-3
"""A run stops when the stable step falls below this fraction of the first: elements are collapsing."""
SHRINKAGE = 0.05
"""The stable step is estimated anew before it can have shrunk by this part, as far as the last estimates tell."""
FEWEST_STEPS, MOST_STEPS = 4, 64
"""Steps between two estimates: at the start, and at most."""
ROUNDING = 1e-9
"""Steps that fill an interval are as many as they should be, whatever their division says in its last digits."""


@dataclass(frozen=True)
class Event:
    """A time that the simulation has reached exactly."""

    index: int
    time: float


@dataclass(eq=False)
class Simulation:
    """A model that runs through ``events`` (increasing times [s], the first one 0) on a ``device``.

    Everything that a restart needs is in ``model.arrays``, ``model.memory`` and the fields below; while the model is
    on a GPU, ``backend.fetch_all`` brings the state to where it belongs.
    """

    model: Model
    events: NDArray[np.float64]
    safety: float = 0.9
    history_interval: float = 2e-6
    device: Device = "cpu"
    next_event: int = 0
    step: int = 0
    updates: int = 0
    dt: float = 0.0
    first_dt: float = 0.0
    last_dt: float = 0.0
    largest_dt: float = 0.0
    last_step: int = 0
    patience: int = FEWEST_STEPS
    reached: float = 0.0
    totals: NDArray[np.float64] = field(default_factory=lambda: np.zeros(N_TOTALS))
    work: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    power: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))
    power_time: float = 0.0
    history: list[tuple[float, ...]] = field(default_factory=list)
    stepping_seconds: float = 0.0

    def __post_init__(self) -> None:
        self.counts = np.ones(self.model.mesh.shape[0], dtype=np.int64)
        self.backend: Backend = backend_for(self.device, self.model)
        self._most_work, self._rows_seen = 0.0, 0  # largest external work in so many rows of the history

    @property
    def time(self) -> float:
        """The last event reached [s]."""
        return float(self.events[max(self.next_event - 1, 0)])

    @property
    def updates_per_second(self) -> float:
        """Element updates per second of the stepping loop so far."""
        return self.updates / self.stepping_seconds if self.stepping_seconds else 0.0

    @property
    def ratio(self) -> int:
        """Steps of the fastest row of elements in one step of the slowest."""
        return int(self.counts[-1])

    @property
    def subcycles(self) -> bool:
        """Whether rows of elements have steps of their own."""
        return self.model.row_steps is not None

    @property
    def imbalance(self) -> float:
        """Energy imbalance now, over the largest external work so far."""
        work, imbalance = HISTORY.index("external_work_J_per_m"), HISTORY.index("imbalance_J_per_m")
        for row in self.history[self._rows_seen :]:
            self._most_work = max(self._most_work, abs(row[work]))
        self._rows_seen = len(self.history)
        return abs(self.history[-1][imbalance]) / self._most_work if self._most_work > 0 else 0.0

    def run(self) -> Iterator[Event]:
        """Go from event to event; yields each when it is reached, the state at rest first.

        Raises:
            RunError: if an element inverts, the state stops being finite, or the stable step collapses; it names the
                element, its place and the time.
        """
        while self.has_events:
            yield answered(self.to_next_event(), self.backend.march)

    @property
    def has_events(self) -> bool:
        """Whether there is an event to go to."""
        return self.next_event < self.events.size

    def to_next_event(self) -> Generator[March, Sample, Event]:
        """Go to the next event, whoever takes the steps: each march is asked for, and its sample is the answer.

        Raises:
            RunError: as :meth:`run`.
        """
        if self.next_event > 0:
            yield from self._go(self.events[self.next_event - 1], self.events[self.next_event])
        self.next_event += 1
        return Event(self.next_event - 1, self.time)

    def fields(self) -> NDArray[np.float64]:
        """Element fields now, shape [len(FIELDS), n_rows, n_columns], see :mod:`wrinklewave.dynamics.fields`."""
        return self.backend.snapshot()().elements

    def stable_step(self) -> float:
        """Largest stable step of the present state [s].

        Raises:
            RunError: as :meth:`run`.
        """
        return self._checked(float(self.backend.stable_steps_of_rows().min()))

    def _checked(self, dt: float) -> float:
        self.first_dt = self.first_dt or dt
        if not dt > SMALLEST_STEP * self.first_dt:
            raise self._failure()
        return dt

    def _go(self, start: float, stop: float) -> Generator[March, Sample, None]:
        t = start
        while t < stop:
            if not self.last_dt or self.step + self._steps_in(stop - t) > self.last_step + self._trusted:
                self._estimate_stable_step()
            n = self._steps_in(stop - t)
            dt, count = float(stop - t) / n, min(n, self._trusted)
            yield from self._march(count, t, dt)
            t = stop if count == n else t + count * dt

    def _steps_in(self, interval: float) -> int:
        """Steps that fill a time [s], each safely below the last estimate."""
        return int(np.ceil(interval / (self.safety * self.largest_dt)))

    @property
    def _trusted(self) -> int:
        """Steps for which an estimate holds: patience counts those of the fastest row."""
        return max(1, self.patience // self.ratio)

    def _march(self, n: int, start: float, dt: float) -> Generator[March, Sample, None]:
        """Steps in groups, with a row of the history after each."""
        counts = self.counts if self.subcycles else None
        group = max(1, int((1 + ROUNDING) * self.history_interval / dt))
        for done in range(0, n, group):
            count = min(group, n - done)
            sample = yield March(count, start + done * dt, self.dt, dt, counts)
            self.step += count
            self.updates += count * int(self.counts.sum()) * self.model.mesh.shape[1]
            self.stepping_seconds += sample.seconds
            self.dt = dt
            self.reached = start + (done + count) * dt
            self.totals[FORCE] = 0.0
            self.totals += sample.totals
            self._record(self.reached, dt, sample)

    def _estimate_stable_step(self) -> None:
        """Ask for the stable step; how fast it shrinks tells how many steps later it is to be asked for again."""
        rows = self._stable_steps_of_rows()
        dt, taken = self._checked(float(rows.min())), (self.step - self.last_step) * self.ratio
        shrunk = max(1 - dt / (self.last_dt or dt), 1e-9)
        allowed = min(taken * SHRINKAGE / shrunk, MOST_STEPS) if taken else FEWEST_STEPS
        self.patience = max(1, int(min(allowed, max(self.patience, 2 * taken))))
        self.last_dt, self.last_step = dt, self.step
        self.largest_dt, self.counts = plan(rows)

    def _stable_steps_of_rows(self) -> NDArray[np.float64]:
        """Largest stable step of each row of elements [s], or that of all for each."""
        rows = self.backend.stable_steps_of_rows()
        return rows if self.subcycles else np.full(rows.size, rows.min())

    def _record(self, t: float, dt: float, sample: Sample) -> None:
        a, rows = self.model.arrays, sample.survey
        s = rows.sum(axis=0)
        power, middle = s[[2, BULK_VISCOUS, HOURGLASS]], t - dt / 2
        self.work += 0.5 * (self.power + power) * (middle - self.power_time)
        self.power, self.power_time = power, middle
        spent = (
            sample.kinetic
            + s[STORED]
            + self.work.sum()
            + self.totals[CONTACT_LOSS]
            + self.totals[FRICTION_LOSS]
        )
        least, most = float(rows[:, J_LEAST].min()), float(rows[:, J_MOST].max())
        self.history.append(
            (
                t,
                self.step,
                dt,
                sample.kinetic,
                s[STORED],
                s[SPRINGS],
                *self.work,
                self.totals[CONTACT_LOSS],
                self.totals[FRICTION_LOSS],
                self.totals[WORK],
                spent - self.totals[WORK],
                a.X[-1, 0] + sample.corner[0],
                a.Y[-1, 0] + sample.corner[1],
                self.totals[FORCE],
                float(rows[:, HOURGLASS_AMPLITUDE].max()),
                least,
                most,
            )
        )
        if not (least >= J_MIN and most <= J_MAX):
            self.stable_step()  # names an inverted element, if that is the cause
            row = int(np.argmin(rows[:, J_LEAST])) if least < J_MIN else int(np.argmax(rows[:, J_MOST]))
            raise RunError(
                f"at t = {t * 1e3:.4f} ms (step {self.step}) the volume ratio in element row {row} is "
                f"{least:.3g} to {most:.3g}, outside {J_MIN} to {J_MAX}\n"
                "  to mend:  a finer mesh there, a longer rise time, or more bulk viscosity"
            )

    def _failure(self) -> RunError:
        steps = self.backend.stable_steps()
        row, column = np.unravel_index(int(np.argmin(steps)), steps.shape)  # the first NaN, if any
        dt = float(steps[row, column])
        X, Y = self.model.arrays.X, self.model.arrays.Y
        place = f"X = {X[row, column] * 1e3:.3f} mm, Y = {Y[row, column] * 1e3:.3f} mm"
        t = max(self.time, self.reached)
        what = "the stable step has collapsed: an element is inverted or nearly so"
        if np.isnan(dt):
            what = "the state is not finite"
        return RunError(
            f"{what} (element row {row}, column {column}, at {place}; t = {t * 1e3:.4f} ms, step {self.step}, "
            f"stable step {dt:.3g} s)\n"
            "  to mend:  a smaller solver.safety, a longer rise time, a coarser mesh at a clamped struck corner "
            "(no converged answer exists there), or boundaries.wall = true"
        )
