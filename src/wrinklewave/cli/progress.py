"""Progress of long work: a live bar on a terminal, log lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from wrinklewave.cli.console import console

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

    from wrinklewave.experiments.simulate import Progress

LOG_INTERVAL, BAR_INTERVAL = 5.0, 0.1
MEANINGFUL = 0.05
"""Part of the run after which its imbalance of energy is shown: before, there is hardly any work to compare it with."""


@contextmanager
def simulation_progress(title: str) -> Iterator[Callable[[Progress], None]]:
    """Show the progress of a simulation: time, step, rate, energy error, time left."""
    out = console()
    if not out.is_terminal:
        yield _at_most_every(
            LOG_INTERVAL, lambda state: print(f"{title}: {describe(state)}", file=sys.stderr, flush=True)
        )
        return
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

    columns = (
        TextColumn("{task.description}"),
        BarColumn(20),
        TaskProgressColumn(),
        TextColumn("{task.fields[state]}"),
    )
    with Progress(*columns, console=out) as bar:
        task = bar.add_task(title, total=None, state="compiling kernels, if they are new (once, 10 to 20 s)")
        yield _at_most_every(BAR_INTERVAL, lambda state: _update(bar, task, state))


def describe(state: Progress) -> str:
    """One line about a running simulation."""
    parts = [f"t = {state.time * 1e3:.3f} of {state.end_time * 1e3:g} ms", f"step {state.step}"]
    if state.updates_per_second > 0:
        parts.append(f"{state.updates_per_second / 1e6:.0f} M updates/s")
    if state.time > MEANINGFUL * state.end_time:
        parts.append(f"energy off by {state.imbalance:.1e}")
    known = state.seconds_left == state.seconds_left
    return ", ".join([*parts, f"{state.seconds_left:.0f} s left" if known else "starting"])


def _update(bar: Bar, task: TaskID, state: Progress) -> None:
    bar.update(task, total=state.end_time, completed=state.time, state=describe(state))


def _at_most_every(seconds: float, show: Callable[[Progress], None]) -> Callable[[Progress], None]:
    """Call ``show`` now and then, and at the end in any case."""
    last = -seconds

    def maybe(state: Progress) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= seconds or state.time >= state.end_time:
            last = now
            show(state)

    return maybe
