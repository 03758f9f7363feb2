"""Kernels compiled in a process of its own, beside what this one compiles: in one process numba compiles one at a time.

What is compiled meets in numba's cache on the disk. Nothing depends on the other process: what it did not bring is
compiled where it is called.
"""

from __future__ import annotations

import importlib
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import parent_process
from typing import Any, cast

import numba

from wrinklewave._jit import calls_kernels_of_others
from wrinklewave.processes import ProcessBeside, handed_over, usable_cores

_Wanted = list[tuple[str, str, tuple[Any, ...]]]
"""Module, name and types of the arguments of kernels."""

_HELPER = "from wrinklewave.compiling import compile_wanted; compile_wanted()"


@contextmanager
def compiled_beside(*calls: tuple[Any, tuple[Any, ...]]) -> Iterator[bool]:
    """Have kernels compiled for the arguments of these ``calls``, while the body of this context does other work.

    At its end they are in the cache. Nothing is started if they are there already, if no core is free for it, or if
    this process has kernels that the other would not know; yields whether something was.
    """
    wanted = _missing(calls) if _can_help() and _core_is_free() else []
    if not wanted:
        yield False
        return
    helper = ProcessBeside(_HELPER)
    try:
        helper.hand_over(wanted)
        yield True
        helper.has_done_it()
    finally:
        helper.end()


def _can_help() -> bool:
    """Whether another process would compile what this one does."""
    return not (calls_kernels_of_others() or numba.config.DISABLE_JIT)  # type: ignore[attr-defined]


def _core_is_free() -> bool:
    """Whether there is a second core; processes that others start, as sweeps do, share the cores already."""
    return usable_cores() > 1 and parent_process() is None


def _missing(calls: tuple[tuple[Any, tuple[Any, ...]], ...]) -> _Wanted:
    """Those of the kernels that are not in the cache."""
    typed = [(kernel, tuple(numba.typeof(argument) for argument in given)) for kernel, given in calls]
    return [
        (kernel.__module__, kernel.__name__, types) for kernel, types in typed if not is_kept(kernel, types)
    ]


def is_kept(kernel: Any, types: tuple[Any, ...]) -> bool:
    """Whether a kernel is in the cache for arguments of these ``types``."""
    key = kernel._cache._index_key(types, kernel.targetctx.codegen())
    return key in kernel._cache._cache_file._load_index()


def compile_wanted() -> None:
    """Compile what is asked for on the standard input."""
    for module, name, types in cast(_Wanted, handed_over()):
        getattr(importlib.import_module(module), name).compile(types)
