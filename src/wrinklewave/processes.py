"""Work in a process of its own beside this one, which depends on nothing that it does."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from typing import IO


def usable_cores() -> int:
    """How many cores this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


class ProcessBeside:
    """A Python process that runs ``code``, says nothing, and is handed one thing.

    It has a session of its own: an interrupt at the terminal is for the process that started it, which ends it.
    """

    def __init__(self, code: str) -> None:
        self._process = subprocess.Popen(
            [sys.executable, "-P", "-c", code],
            stdin=subprocess.PIPE,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
            start_new_session=True,
        )

    def hand_over(self, thing: object) -> None:
        """Send what :func:`handed_over` is waiting for there."""
        try:
            pickle.dump(thing, self._stdin, protocol=pickle.HIGHEST_PROTOCOL)
            self._stdin.close()
        except BrokenPipeError:  # it did not start
            pass

    def has_done_it(self) -> bool:
        """Wait for its end; whether it came without an error."""
        return self._process.wait() == 0

    def end(self) -> None:
        """End it, whatever it is doing."""
        self._process.kill()
        self._process.wait()

    @property
    def _stdin(self) -> IO[bytes]:
        assert self._process.stdin is not None  # it has a pipe
        return self._process.stdin


def handed_over() -> object:
    """What this process was started for."""
    return pickle.load(sys.stdin.buffer)
