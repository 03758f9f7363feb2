"""How kernels are compiled: one place for numba's options, and the reasons for them.

Three things decide whether LLVM turns a loop over elements into vector instructions (each measured, see
``docs/performance.md``): it must know that arrays do not overlap, indices must not wrap (unsigned, as
``uintp``), and nothing may raise inside the loop (``error_model="numpy"``).
"""

from __future__ import annotations

import hashlib
import os
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numba
from numba.core import cpu
from numba.core.options import TargetOptions

uintp = numba.uintp


def _use_full_vector_width() -> None:
    """Let LLVM use 512-bit vectors where the processor has them (its default there is 256): 1.3 to 1.4 times the speed.

    A user's own NUMBA_CPU_NAME or NUMBA_CPU_FEATURES is left alone.
    """
    if "NUMBA_CPU_NAME" in os.environ or "NUMBA_CPU_FEATURES" in os.environ:
        return
    features = llvm.get_host_cpu_features()
    if features.get("avx512f"):
        numba.config.CPU_NAME = llvm.get_host_cpu_name()
        numba.config.CPU_FEATURES = features.flatten() + ",-prefer-256-bit"


@cache
def _kernel_cache(room: str) -> str:
    """Folder of a room's compiled kernels, under a digest of all sources that its kernels call.

    Numba's own check sees only the file that a kernel stands in, not those of the functions it calls.
    """
    package = Path(__file__).parent
    sources = [Path(__file__)]
    for name in sorted({"materials", room}):
        sources += sorted((package / name).rglob("*.py"))
    digest = hashlib.sha256(b"".join(source.read_bytes() for source in sources)).hexdigest()[:16]
    folder = Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache"))
    return str(folder / "wrinklewave" / f"{room}-{digest}")


def _offer_noalias() -> dict[str, Any]:
    """The option that marks array arguments as not overlapping; numba has the flag but no spelling for it on CPUs."""
    if not hasattr(cpu.CPUTargetOptions, "noalias"):
        cpu.CPUTargetOptions.noalias = TargetOptions.Mapping("noalias")
    return {"noalias": True}


_use_full_vector_width()

_COMMON: dict[str, Any] = {"error_model": "numpy", "cache": True, "nogil": True}
_NO_COUNTING: dict[str, Any] = _COMMON | {
    "_nrt": False
}  # kernels allocate nothing; counting references costs a third
_FAST: dict[str, Any] = _NO_COUNTING | {"fastmath": True}


def choose_cache(function: Callable[..., Any]) -> None:
    """Make numba keep what it compiles of ``function`` where its room's kernels are."""
    if "NUMBA_CACHE_DIR" not in os.environ:
        numba.config.CACHE_DIR = _kernel_cache(function.__module__.split(".")[1])


def _compiler(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    def compile_lazily(function: Callable[..., Any]) -> Any:
        choose_cache(function)
        return numba.njit(**options)(function)

    return compile_lazily


scalar = _compiler(**_FAST, forceinline=True)
"""For pure functions of scalars: inlined into the loops that call them, on the CPU and on a GPU."""

vector = _compiler(**_FAST, **_offer_noalias())
"""For loops over elements or nodes. Array arguments must not overlap, except that a loop may read and write the
same place of one array within one iteration."""

serial = _compiler(**_NO_COUNTING)
"""For loops whose order matters, with strict floating point."""

strict = _compiler(**_NO_COUNTING, forceinline=True)
"""For pieces of serial loops, inlined into them: state is handed over in structures of many arrays, and to pass one
to a function costs more than most of these do."""

allocating = _compiler(**_COMMON)
"""For loops that make arrays of their own, with strict floating point."""
