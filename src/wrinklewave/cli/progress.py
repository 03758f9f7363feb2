"""Progress of long work: a live bar on a terminal, log lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol

from wrinklewave.cli.console import console

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

LOG_INTERVAL, BAR_INTERVAL = 5.0, 0.1
COMPILING = "compiling kernels, if they are new (once per machine, 10 to 40 s)"


class State(Protocol):
    """Where a long computation is; as a string, one line about it."""

    @property
    def share(self) -> float:
        """Of the whole that is done."""


@contextmanager
def shown_progress(title: str, starting: str) -> Iterator[Callable[[State], None]]:
    """Show how far a computation is; ``starting`` says what happens before it first tells."""
    out = console()
    if not out.is_terminal:
        yield _at_most_every(
            LOG_INTERVAL, lambda state: print(f"{title}: {state}", file=sys.stderr, flush=True)
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
        task = bar.add_task(title, total=None, state=starting)
        yield _at_most_every(BAR_INTERVAL, lambda state: _update(bar, task, state))


def _update(bar: Bar, task: TaskID, state: State) -> None:
    bar.update(task, total=1.0, completed=state.share, state=str(state))


def _at_most_every(seconds: float, show: Callable[[State], None]) -> Callable[[State], None]:
    """Call ``show`` now and then, and at the end in any case."""
    last = -seconds

    def maybe(state: State) -> None:
        nonlocal last
        now = time.monotonic()
        if now - last >= seconds or state.share >= 1.0:
            last = now
            show(state)

    return maybe
