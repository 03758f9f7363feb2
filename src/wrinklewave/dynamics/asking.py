"""Who asks for steps, and who takes them: simulations are generators that ask for marches and are sent the samples.

So one simulation can have its steps from a backend of its own, and many can have theirs together.
"""

from __future__ import annotations

from contextlib import ExitStack, closing
from typing import TYPE_CHECKING, TypeVar

from wrinklewave.errors import RunError

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator, Mapping, Sequence

    from wrinklewave.dynamics.backends import March, Sample

Result = TypeVar("Result")


def answered(asking: Generator[March, Sample, Result], march: Callable[[March], Sample]) -> Result:
    """Answer every march that is asked for; returns what all of them lead to."""
    with closing(asking):
        try:
            wanted = next(asking)
            while True:
                wanted = asking.send(march(wanted))
        except StopIteration as end:
            result: Result = end.value
            return result


def answered_together(
    asking: Sequence[Generator[March, Sample, Result]],
    march: Callable[[Mapping[int, March]], Mapping[int, Sample]],
) -> Iterator[tuple[int, Result | RunError]]:
    """Answer several at a time: whenever all have asked that have not ended, ``march`` answers them, by place.

    Yields the place of each that ends, and what it has led to, or the error that it failed with.
    """
    samples: Mapping[int, Sample | None] = dict.fromkeys(range(len(asking)))
    with ExitStack() as stack:
        for one in asking:
            stack.enter_context(closing(one))
        while samples:
            wanted: dict[int, March] = {}
            for place, sample in samples.items():
                try:
                    wanted[place] = asking[place].send(sample)  # type: ignore[arg-type]  # None starts it
                except StopIteration as end:
                    yield place, end.value
                except RunError as error:
                    yield place, error
            samples = march(wanted) if wanted else {}
