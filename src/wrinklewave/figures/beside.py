"""Figures drawn in two processes: most of drawing is Python's own work, which threads of one process do in turns.

The other process is started while there is nothing to draw yet, so that it has imported what drawing needs by then.
Nothing depends on it: what it did not bring is drawn where it was wanted.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import Any, cast

from wrinklewave.processes import ProcessBeside, handed_over, usable_cores

_HELPER = "from wrinklewave.figures.beside import draw_wanted; draw_wanted()"


class Helper:
    """A process that draws some figures, once."""

    def __init__(self) -> None:
        self._process = ProcessBeside(_HELPER)

    def begin(self, registry: str, inputs: object, files: Mapping[str, Path]) -> None:
        """Have figures of the registry that is found at ``registry`` written to ``files``."""
        self._process.hand_over((registry, inputs, dict(files)))

    def has_drawn(self) -> bool:
        """Wait for it; whether all figures are there."""
        return self._process.has_done_it()

    def end(self) -> None:
        """End it, whatever it is doing."""
        self._process.end()


@contextmanager
def helper_beside() -> Iterator[Helper | None]:
    """A process that gets ready to draw, until the end of the context; None where no core is free for it."""
    if usable_cores() == 1:
        yield None
        return
    helper = Helper()
    try:
        yield helper
    finally:
        helper.end()


def draw_wanted() -> None:
    """Import what draws, then draw what is asked for on the standard input."""
    import matplotlib.backends.backend_agg
    import matplotlib.figure  # noqa: F401 - before there is anything to draw

    import wrinklewave.figures  # noqa: F401

    place, inputs, files = cast(tuple[str, object, dict[str, Path]], handed_over())
    module, name = place.split(":")
    registry: Any = getattr(importlib.import_module(module), name)
    registry.draw(inputs, files)
