"""Progress of long work: a live bar on a terminal, log lines elsewhere."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Timer
from typing import TYPE_CHECKING, Protocol

from wrinklewave.cli.console import console

if TYPE_CHECKING:
    from rich.progress import Progress as Bar
    from rich.progress import TaskID

LOG_INTERVAL, BAR_INTERVAL, PATIENCE = 5.0, 0.1, 3.0
COMPILING = "compiling kernels, if they are new (once per machine, {seconds} s)"
STEPPING, MEASURING = (COMPILING.format(seconds=seconds) for seconds in ("10 to 20", "30 to 60"))
"""What is said where a computation does not begin at once."""


class State(Protocol):
    """Where a long computation is; as a string, one line about it."""

    @property
    def share(self) -> float:
        """Of the whole that is done."""


@contextmanager
def shown_progress(title: str, starting: str) -> Iterator[Callable[[State], None]]:
    """Show how far a computation is; ``starting`` says what it is at if nothing comes for some seconds."""
    out = console()
    if not out.is_terminal:
        with told_if_slow(f"{title}: {starting}") as begun:
            yield _at_most_every(
                LOG_INTERVAL, begun, lambda state: print(f"{title}: {state}", file=sys.stderr, flush=True)
            )
        return
    from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(20),
        TaskProgressColumn(),
        TextColumn("{task.fields[state]}", markup=False),
    )
    with Progress(*columns, console=out) as bar:
        task = bar.add_task(title, total=None, state="")
        with _after(PATIENCE, lambda: bar.update(task, state=starting)) as begun:
            yield _at_most_every(BAR_INTERVAL, begun, lambda state: _update(bar, task, state))


@contextmanager
def told_if_slow(text: str) -> Iterator[Callable[[], None]]:
    """Print ``text`` as a line of the log unless the function that is yielded is called within some seconds."""
    with _after(PATIENCE, lambda: print(text, file=sys.stderr, flush=True)) as begun:
        yield begun


@contextmanager
def _after(seconds: float, act: Callable[[], None]) -> Iterator[Callable[[], None]]:
    """Call ``act`` after some seconds, unless the function that is yielded is called before, or the context ends."""
    timer = Timer(seconds, act)
    timer.daemon = True
    timer.start()
    try:
        yield timer.cancel
    finally:
        timer.cancel()


def _update(bar: Bar, task: TaskID, state: State) -> None:
    bar.update(task, total=1.0, completed=state.share, state=str(state))


def _at_most_every(
    seconds: float, begun: Callable[[], None], show: Callable[[State], None]
) -> Callable[[State], None]:
    """Call ``show`` now and then, and at the end in any case; ``begun`` before."""
    last = -seconds

    def maybe(state: State) -> None:
        nonlocal last
        begun()
        now = time.monotonic()
        if now - last >= seconds or state.share >= 1.0:
            last = now
            show(state)

    return maybe
