"""Runs whose models have one shape, side by side on a GPU: each as if it were alone, their steps taken together."""

from __future__ import annotations

from contextlib import nullcontext
from typing import TYPE_CHECKING, Any

from wrinklewave.dynamics.asking import answered_together
from wrinklewave.dynamics.model import build_model
from wrinklewave.experiments.interruption import interruptible
from wrinklewave.experiments.simulate import start

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

    from wrinklewave.config import Case
    from wrinklewave.errors import RunError
    from wrinklewave.experiments.run_progress import Progress
    from wrinklewave.experiments.simulate import Run


def simulate_together(
    runs: Sequence[tuple[Case, Path]], progress: Callable[[Progress], None] = lambda state: None
) -> Iterator[tuple[int, Run | RunError]]:
    """Simulate cases of one shape on the GPU, each into its folder; those that have a checkpoint there go on from it.

    Yields the place of each as it ends, and its run or the error that it failed with; the others go on.

    Raises:
        InputError: if what a folder holds does not allow a run.
    """
    from wrinklewave.dynamics.cuda.backend import Batch

    started = [start(case, folder, device="cuda", resume=True) for case, folder in runs]
    batch = Batch([one.simulation.model for one in started])
    for one, member in zip(started, batch.members(), strict=True):
        one.simulation.backend = member
    with interruptible() as wished:
        running = [one.to_the_end(lambda: nullcontext(wished), progress) for one in started]
        yield from answered_together(running, batch.march)


def processes_at_once(wish: int) -> int:
    """As many processes as are wished for and the memory of the current CUDA device has room for."""
    from wrinklewave.dynamics.cuda.backend import most_processes

    return int(min(wish, most_processes()))


def batches(cases: Sequence[Case], processes: int) -> list[list[int]]:
    """Places of cases that make batches: of one shape each, one or more for every process, as the GPU has room for.

    Args:
        cases: to be simulated on the current CUDA device.
        processes: that share it.
    """
    from wrinklewave.dynamics.cuda.backend import most_members, shape_of

    by_shape: dict[Any, list[int]] = {}
    models = [build_model(case) for case in cases]
    for place, model in enumerate(models):
        by_shape.setdefault(shape_of(model), []).append(place)
    found = []
    for places in by_shape.values():
        fewest = -(-processes * len(places) // len(cases))
        count = max(fewest, -(-len(places) // most_members(models[places[0]], processes)))
        found += [places[first::count] for first in range(min(count, len(places)))]
    return found
