"""Work shared out to threads of our own: compiled code holds no lock of the interpreter, so they run side by side.

Threads that wait for work sleep, so a second process on the cores costs no more than its share.
"""

from __future__ import annotations

import os
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from threading import Lock
from typing import Any

MOST_HELPERS = max(2, os.cpu_count() or 1)
"""Threads beside the one that calls."""
_WHOLE_TEAM = Lock()
"""Parts of one task may wait for each other, so the threads serve one task at a time."""


@cache
def _helpers(count: int) -> ThreadPoolExecutor:
    return ThreadPoolExecutor(count, thread_name_prefix="wrinklewave")


def share_out(kernel: Callable[..., Any], n_parts: int, *arguments: Any) -> None:
    """Call ``kernel(part, *arguments)`` for every part, the first on this thread, each other on one of its own.

    Raises:
        ValueError: if there are more parts than threads.
    """
    if n_parts == 1:
        kernel(0, *arguments)
        return
    if n_parts - 1 > MOST_HELPERS:
        raise ValueError(f"{n_parts} parts for {MOST_HELPERS + 1} threads")
    with _WHOLE_TEAM:
        others = [_helpers(MOST_HELPERS).submit(kernel, part, *arguments) for part in range(1, n_parts)]
        kernel(0, *arguments)
        for other in others:
            other.result()
