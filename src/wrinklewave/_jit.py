"""How kernels are compiled: one place for numba's options, and the reasons for them.

Three things decide whether LLVM turns a loop over elements into vector instructions (each measured, see
``docs/performance.md``): it must know that arrays do not overlap, indices must not wrap (unsigned, as
``uintp``), and nothing may raise inside the loop (``error_model="numpy"``).
"""

from __future__ import annotations

import ast
import hashlib
import inspect
import linecache
import os
import secrets
import textwrap
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import Any

import llvmlite.binding as llvm
import numba
import numpy as np
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


def _vector_bytes() -> int:
    """Of the widest vector that this processor computes with."""
    features = llvm.get_host_cpu_features()
    return 64 if features.get("avx512f") else 32 if features.get("avx") else 16


VECTOR_BYTES = _vector_bytes()


def cache_folder() -> Path:
    """Folder of all compiled kernels."""
    own = os.environ.get("NUMBA_CACHE_DIR")
    return (
        Path(own) if own else Path(os.environ.get("XDG_CACHE_HOME", Path.home() / ".cache")) / "wrinklewave"
    )


_SOURCES_OF_OTHERS: list[str] = []
"""Of the kernels that do not belong to the package, such as a law that a script puts in another's place."""


def calls_kernels_of_others() -> bool:
    """Whether kernels of this process may be others than the package alone would make."""
    return bool(_SOURCES_OF_OTHERS)


@cache
def _kernel_cache(room: str, sources_of_others: tuple[str, ...]) -> str:
    """Folder of a room's compiled kernels, under a digest of all sources that its kernels call.

    Numba's own check sees only the file that a kernel stands in, not those of the functions it calls.
    """
    package = Path(__file__).parent
    sources = [Path(__file__)]
    for name in sorted({"materials", room}):
        sources += sorted((package / name).rglob("*.py"))
    texts = [source.read_bytes() for source in sources] + [text.encode() for text in sources_of_others]
    return str(cache_folder() / f"{room}-{hashlib.sha256(b''.join(texts)).hexdigest()[:16]}")


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

STRICTLY_INLINED: dict[str, Any] = {"error_model": "numpy", "forceinline": True}
INLINED: dict[str, Any] = STRICTLY_INLINED | {"fastmath": True}
"""For what an ``overload`` chooses when compiled."""


def choose_cache(function: Callable[..., Any]) -> None:
    """Make numba keep what it compiles of ``function`` where its room's kernels are."""
    package, _, module = function.__module__.partition(".")
    if package != __package__:
        _SOURCES_OF_OTHERS.append("".join(linecache.getlines(function.__code__.co_filename)))
    room = module.partition(".")[0] if package == __package__ else "others"
    numba.config.CACHE_DIR = _kernel_cache(room, tuple(_SOURCES_OF_OTHERS))


_OPTIONS: dict[Any, dict[str, Any]] = {}
"""Of every kernel."""
_PROCESS = secrets.token_hex(4)


def _keep_apart(kernel: Any) -> None:
    """Give what this process compiles file names of its own.

    Numba numbers the files of a function. Two processes that compile it for different types at a time would take the
    same number, and one would find the other's code under its own types.
    """
    if not numba.config.DISABLE_JIT:  # type: ignore[attr-defined]  # made when numba is imported
        file = kernel._cache._cache_file
        file._data_name_pattern = file._data_name_pattern.replace("{number", f"{_PROCESS}-{{number")


def _compiler(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    def compile_lazily(function: Callable[..., Any]) -> Any:
        choose_cache(function)
        kernel = numba.njit(**options)(function)
        _keep_apart(kernel)
        _OPTIONS[kernel] = options
        return kernel

    return compile_lazily


@cache
def in_single_precision(kernel: Any) -> Any:
    """The same kernel with its constants, and those of all kernels that it calls, in single precision.

    A constant of double precision widens all that it meets; so a kernel on arrays of single precision would else
    compute in double. There is one source of formulas: its constants are replaced before it is compiled.
    """
    function = getattr(kernel, "py_func", kernel)
    tree = ast.parse(textwrap.dedent(inspect.getsource(function)))
    definition = tree.body[0]
    assert isinstance(definition, ast.FunctionDef)
    definition.decorator_list, definition.name = [], f"{function.__name__}_in_single_precision"
    constants = _NamedConstants()
    narrow = ast.increment_lineno(constants.visit(tree), function.__code__.co_firstlineno - 1)
    used = {name: value for name, value in function.__globals__.items() if name in function.__code__.co_names}
    names = function.__globals__ | {name: _narrowed(value) for name, value in used.items()} | constants.values
    exec(compile(ast.fix_missing_locations(narrow), function.__code__.co_filename, "exec"), names)
    return _compiler(**_OPTIONS[kernel])(names[definition.name])


def _narrowed(value: Any) -> Any:
    if isinstance(value, float):
        return np.float32(value)
    return in_single_precision(value) if callable(value) and value in _OPTIONS else value


class _NamedConstants(ast.NodeTransformer):
    """Gives every floating-point constant a name, and keeps their values in single precision."""

    def __init__(self) -> None:
        self.values: dict[str, np.float32] = {}

    def visit_Constant(self, node: ast.Constant) -> ast.expr:
        if not isinstance(node.value, float):
            return node
        name = f"_constant_{len(self.values)}"
        self.values[name] = np.float32(node.value)
        return ast.Name(name, ast.Load())


scalar = _compiler(**_FAST, forceinline=True)
"""For pure functions of scalars: inlined into the loops that call them, on the CPU and on a GPU."""

vector = _compiler(**_FAST, **_offer_noalias())
"""For loops over elements or nodes. Array arguments must not overlap, except that a loop may read and write the
same place of one array within one iteration."""

inlined_vector = _compiler(**_FAST, **_offer_noalias(), forceinline=True)
"""The same, for loops that are called in one place: to hand over thirty arrays takes as long as a dozen elements. A
second place could be compiled to other roundings."""

strict_vector = _compiler(**_NO_COUNTING, **_offer_noalias())
"""The same with strict floating point, so that all places that call one round alike."""

serial = _compiler(**_NO_COUNTING)
"""For loops whose order matters, with strict floating point."""

strict = _compiler(**_NO_COUNTING, forceinline=True)
"""For pieces of serial loops, inlined into them: state is handed over in structures of many arrays, and to pass one
to a function costs more than most of these do."""

allocating = _compiler(**_COMMON)
"""For loops that make arrays of their own, with strict floating point."""
