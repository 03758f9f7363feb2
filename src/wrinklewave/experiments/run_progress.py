"""Where a simulation is, and how long it will take."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from wrinklewave.dynamics.simulation import Simulation

MEANINGFUL_SHARE = 0.05
"""Part of the run after which its imbalance of energy is shown: before, there is hardly any work to compare it with."""


@dataclass(frozen=True)
class Progress:
    """Where a simulation is.

    Args:
        time: simulated [s].
        end_time: of the simulation [s].
        step: steps taken.
        updates_per_second: element updates per second of the stepping loop.
        imbalance: energy imbalance over external work.
        seconds: wall-clock time since the run was started or resumed.
        seconds_left: estimated; NaN at the start.
    """

    time: float
    end_time: float
    step: int
    updates_per_second: float
    imbalance: float
    seconds: float
    seconds_left: float

    @property
    def share(self) -> float:
        """Of the whole that is done."""
        return self.time / self.end_time

    def __str__(self) -> str:
        parts = [f"t = {self.time * 1e3:.3f} of {self.end_time * 1e3:g} ms", f"step {self.step}"]
        if self.updates_per_second > 0:
            parts.append(f"{self.updates_per_second / 1e6:.0f} M updates/s")
        if self.share > MEANINGFUL_SHARE:
            parts.append(f"energy off by {self.imbalance:.1e}")
        known = self.seconds_left == self.seconds_left
        return ", ".join([*parts, f"{self.seconds_left:.0f} s left" if known else "starting"])


class Clock:
    """Estimates the time that a simulation has left from its pace since its first steps, which may have had to wait
    for the compiler. It is started with the simulation."""

    def __init__(self, simulation: Simulation) -> None:
        self._simulation, self._begin = simulation, time.perf_counter()
        self._at_first, self._first = simulation.time, 0.0

    def seconds_left(self) -> float:
        """Wall-clock time left [s]; NaN while there is nothing to tell it from."""
        now, done = time.perf_counter(), self._simulation.time
        if not self._first:
            if done > self._at_first:
                self._first, self._at_first = now, done
            return float("nan")
        if done == self._at_first:
            return float("nan")
        left = float(self._simulation.events[-1]) - done
        return (now - self._first) * left / (done - self._at_first)

    def progress(self) -> Progress:
        """Where the simulation is now."""
        simulation, seconds = self._simulation, time.perf_counter() - self._begin
        return Progress(
            simulation.time,
            float(simulation.events[-1]),
            simulation.step,
            simulation.updates_per_second,
            simulation.imbalance,
            seconds,
            self.seconds_left(),
        )
