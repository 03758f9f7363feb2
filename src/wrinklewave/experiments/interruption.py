"""How long computations end; Ctrl-C and termination as a wish that they ask for at their own convenience."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from enum import Enum
from types import FrameType


class Outcome(Enum):
    """How a long computation ended; the value is the message."""

    FINISHED = "finished"
    INTERRUPTED = "interrupted; go on with --resume"
    FAILED = "failed"


STOPPING = b"\nstopping where it can go on later; Ctrl-C now stops at once\n"


@contextmanager
def interruptible() -> Iterator[Callable[[], bool]]:
    """Yield a function that tells whether an interrupt has come; a second one acts at once, as it always does."""
    if threading.current_thread() is not threading.main_thread():
        yield lambda: False
        return
    wished = False

    def note(signum: int, frame: FrameType | None) -> None:
        nonlocal wished
        wished = True
        with suppress(OSError):  # print, which tells progress, may be at work right now
            os.write(2, STOPPING)
        signal.signal(signal.SIGINT, signal.default_int_handler)

    old = {number: signal.signal(number, note) for number in (signal.SIGINT, signal.SIGTERM)}
    try:
        yield lambda: wished
    finally:
        for number, handler in old.items():
            signal.signal(number, handler)
