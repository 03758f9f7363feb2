"""Figures drawn in two processes: most of drawing is Python's own work, which threads of one process do in turns.

The other process is started while there is nothing to draw yet, so that it has imported what drawing needs by then.
Nothing depends on it: what it did not bring is drawn where it was wanted.
"""

from __future__ import annotations

import importlib
import os
import pickle
import subprocess
import sys
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from pathlib import Path
from typing import IO, Any

_HELPER = "from wrinklewave.figures.beside import draw_wanted; draw_wanted()"


class Helper:
    """A process that draws some figures, once."""

    def __init__(self) -> None:
        # a session of its own: an interrupt at the terminal is for the process that started this one, and ends it
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", _HELPER],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def begin(self, registry: str, inputs: object, files: Mapping[str, Path]) -> None:
        """Have figures of the registry that is found at ``registry`` written to ``files``."""
        try:
            pickle.dump((registry, inputs, dict(files)), self._stdin, protocol=pickle.HIGHEST_PROTOCOL)
            self._stdin.close()
        except BrokenPipeError:  # it did not start
            pass

    def has_drawn(self) -> bool:
        """Wait for it; whether all figures are there."""
        return self._process.wait() == 0

    def end(self) -> None:
        """End it, whatever it is doing."""
        self._process.kill()
        self._process.wait()

    @property
    def _stdin(self) -> IO[bytes]:
        assert self._process.stdin is not None  # it has a pipe
        return self._process.stdin


@contextmanager
def helper_beside() -> Iterator[Helper | None]:
    """A process that gets ready to draw, until the end of the context; None where no core is free for it."""
    cores = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if cores == 1:
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

    place, inputs, files = pickle.load(sys.stdin.buffer)
    module, name = place.split(":")
    registry: Any = getattr(importlib.import_module(module), name)
    registry.draw(inputs, files)
