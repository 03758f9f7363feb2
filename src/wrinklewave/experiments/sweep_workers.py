"""The processes of a sweep: each takes one run after the other, and ends it with a checkpoint when it is told to."""

from __future__ import annotations

import multiprocessing
import signal
from concurrent.futures import Future, ProcessPoolExecutor
from contextlib import suppress
from multiprocessing.synchronize import Event
from typing import TYPE_CHECKING, Any

from wrinklewave.errors import RunError
from wrinklewave.experiments.batch import simulate_together
from wrinklewave.experiments.simulate import simulate

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence
    from pathlib import Path

    from wrinklewave.config import Case
    from wrinklewave.experiments.run_progress import Progress

_end: Event | None = None  # of this process, if it is a worker


class Workers:
    """A pool of ``jobs`` processes; leaving it as a context ends runs that are still on their way."""

    def __init__(self, jobs: int) -> None:
        context = multiprocessing.get_context("spawn")  # a fork would copy threads that it does not have
        self._end = context.Event()
        self._pool = ProcessPoolExecutor(jobs, context, _begin, (self._end,))

    def submit(self, function: Callable[..., Any], *arguments: Any) -> Future[Any]:
        """Call a function in one of the processes."""
        return self._pool.submit(function, *arguments)

    def __enter__(self) -> Workers:
        return self

    def __exit__(self, *error: object) -> None:
        self._end.set()
        self._pool.shutdown(cancel_futures=True)


def _begin(end: Event) -> None:
    global _end
    _end = end
    # An interrupt goes to the whole group: the sweep hears it and tells its processes.
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def run_member(case: Case, folder: Path) -> None:
    """Simulate a case on one thread, or go on with it; a failure stands in its summary."""
    with suppress(RunError):
        simulate(case, out=folder, threads=1, resume=True, progress=_stop_if_told)


def run_batch(runs: Sequence[tuple[Case, Path]]) -> None:
    """The same of cases of one shape, on the GPU at the same time."""
    for _ in simulate_together(runs, _stop_if_told):
        pass


def _stop_if_told(state: Progress) -> None:
    if _end is not None and _end.is_set():
        signal.raise_signal(signal.SIGTERM)  # a run takes it as the wish to end with a checkpoint
