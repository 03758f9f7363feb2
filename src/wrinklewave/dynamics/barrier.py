"""A meeting point for threads inside compiled code: far cheaper than ending one parallel region and starting another.

Waking a sleeping thread takes longer than a step of a small mesh, so the threads of a region take many steps and wait
for each other by looking at counters; while they wait they offer their core to others (``sched_yield``), so that a
second process does not starve the one that is waited for.
"""

from __future__ import annotations

import sys
from typing import Any

from numba import types
from numba.core import cgutils
from numba.extending import intrinsic

from wrinklewave._jit import serial

LINE = 16
"""Counters stand this many 8-byte numbers apart, so that no two share a cache line (or a pair of prefetched ones)."""


def _pointer(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
    array_type = signature.args[0]
    array = context.make_array(array_type)(context, builder, arguments[0])
    return cgutils.get_item_pointer(context, builder, array_type, array, [arguments[1]])


PATIENCE = 200
"""Looks at a counter before a core is offered to others: about as long as it takes to offer it."""

ABANDONED = 2**62
"""A count that no meeting reaches: who finds it does not wait."""


@intrinsic
def load(typingctx: Any, counters: Any, i: Any) -> Any:
    """Counter ``i`` as other threads have left it."""

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        return builder.load_atomic(_pointer(context, builder, signature, arguments), "acquire", 8)

    return types.int64(counters, types.intp), codegen


@intrinsic
def store(typingctx: Any, counters: Any, i: Any, value: Any) -> Any:
    """Set counter ``i`` after everything that this thread has written before."""

    def codegen(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        builder.store_atomic(arguments[2], _pointer(context, builder, signature, arguments[:2]), "release", 8)
        return context.get_dummy_value()

    return types.void(counters, types.intp, types.int64), codegen


if sys.platform == "win32":

    @serial
    def offer_core():
        """Nothing: threads spin."""
else:
    offer_core = types.ExternalFunction("sched_yield", types.int32())


@serial
def wait_for(counts, part, count):
    """Wait until ``part`` has counted so far."""
    looks = 0
    while load(counts, part * LINE) < count:
        looks += 1
        if looks > PATIENCE:
            offer_core()


@serial
def wait_for_all(counts, part, n_parts, round):
    """Say that ``part`` has come to meeting number ``round`` (counted from 1), and wait until all have; its number."""
    store(counts, part * LINE, round)
    for other in range(n_parts):
        wait_for(counts, other, round)
    return round
