"""The yardstick in C, compiled on the spot, on the same arrays as the kernels that it is held against."""

from __future__ import annotations

import ctypes
import os
import shutil
import subprocess
from dataclasses import dataclass
from itertools import product
from pathlib import Path

import numpy as np

from benchmarks.problem import PLATE_SPEED, Problem

SOURCE = Path(__file__).with_name("yardstick.c")
FLAGS = ("-O3", f"-march={os.environ.get('NUMBA_CPU_NAME', 'native')}", "-ffast-math", "-fPIC")
"""For the processor that numba compiles for: this one, unless it is told another."""
WIDTHS = {"default": (), "512 bit": ("-mprefer-vector-width=512",)}
"""Vector widths that gcc may prefer; which is faster depends on the processor."""
LOOPS = {"one loop": (), "two loops": ("-DTWO_LOOPS",)}
"""The arithmetic of an element in one loop, or J^(-1/3) in a loop of its own, as the package has it."""

Double = ctypes.POINTER(ctypes.c_double)
ARRAYS = ("X", "Y", "u", "w", "vx", "vy", "inverse_mass")
BUFFERS = ("memory", "forces", "nothing", "old")
NUMBERS = (
    "mu",
    "K",
    "linear",
    "quadratic",
    "hourglass",
    "b",
    "decay",
    "b_next",
    "dt",
    "length",
    "plate_speed",
)


class Block(ctypes.Structure):
    """``Block`` of yardstick.c."""

    _fields_ = (
        *((name, ctypes.c_long) for name in ("rows", "columns")),
        *((name, Double) for name in (*ARRAYS, *BUFFERS)),
        *((name, ctypes.c_double) for name in NUMBERS),
        ("totals", ctypes.c_double * 4),
    )


def compiled(folder: Path) -> dict[str, ctypes.CDLL]:
    """The yardstick in all its forms; empty where there is no gcc."""
    if shutil.which("gcc") is None:
        return {}
    forms = {f"{width}, {loops}": (*WIDTHS[width], *LOOPS[loops]) for width, loops in product(WIDTHS, LOOPS)}
    return {name: _compile(folder / f"yardstick{i}", flags) for i, (name, flags) in enumerate(forms.items())}


def _compile(stem: Path, flags: tuple[str, ...]) -> ctypes.CDLL:
    """Linked in a step of its own: linking with -ffast-math would flush denormals to zero in the whole process."""
    thing, library = stem.with_suffix(".o"), stem.with_suffix(".so")
    subprocess.run(["gcc", *FLAGS, *flags, "-c", str(SOURCE), "-o", str(thing)], check=True)
    subprocess.run(["gcc", "-shared", str(thing), "-o", str(library), "-lm"], check=True)
    return ctypes.CDLL(str(library))


@dataclass(eq=False)
class CVersion:
    """A problem as the C library steps it, in place."""

    library: ctypes.CDLL
    problem: Problem

    def __post_init__(self) -> None:
        m, a = self.problem.model, self.problem.model.arrays
        rows, columns = m.mesh.shape
        self._buffers = {
            "memory": m.memory,
            "forces": np.zeros((2, 8, columns + 2)),
            "nothing": np.zeros((8, columns + 2)),
            "old": np.zeros((2, 4, max(rows, columns) + 1)),
        }
        arrays = {name: getattr(a, name) for name in ARRAYS} | self._buffers
        moduli = dict(zip(NUMBERS[:5], a.moduli[0], strict=True))
        factors = dict(zip(NUMBERS[5:8], a.factors[0, 0, :3], strict=True))
        others = {"dt": self.problem.dt, "length": m.boundary.length, "plate_speed": PLATE_SPEED}
        pointers = {name: array.ctypes.data_as(Double) for name, array in arrays.items()}
        self._block = Block(rows=rows, columns=columns, **pointers, **moduli, **factors, **others)

    def kernel(self, n_steps: int) -> None:
        """Forces of all elements, ``n_steps`` times."""
        self.library.kernel(ctypes.byref(self._block), ctypes.c_long(n_steps))

    def advance(self, n_steps: int, t: float = 0.0) -> None:
        """Take whole steps from time ``t`` [s]."""
        self.library.advance(ctypes.byref(self._block), ctypes.c_long(n_steps), ctypes.c_double(t))
