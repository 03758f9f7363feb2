"""What fewer bytes per update would gain, and what single precision costs: ``python -m benchmarks.fewer_bytes``.

Variants of the yardstick in C, made by a flag or by replacing text in it, take turns on the same problem, with the
package's own step and what coordinates of every node make of it. Errors are those of the displacements after 1.5 ms of
the paper's case, against the yardstick as it is, relative to the largest.
"""

from __future__ import annotations

import argparse
import ctypes
import subprocess
import tempfile
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks import parts
from benchmarks.c_version import FLAGS, LOOPS, SOURCE, WIDTHS
from benchmarks.limits import best_rates
from benchmarks.machine import keep, offer_to_keep
from benchmarks.numba_version import NumbaVersion
from benchmarks.problem import PLATE_SPEED, Problem, problem
from wrinklewave.dynamics.step import update_factors

SIZES = (15_000, 100_000, 1_000_000, 4_000_000)
DT, END = 1e-6, 1.5e-3
"""Of the accuracy test [s]."""
SINGLE = ("-fsingle-precision-constant",)


@dataclass(frozen=True)
class Variant:
    """A change to the yardstick.

    Args:
        bytes: moved per update, of 168.
        replaced: text and what takes its place.
        flags: for the compiler, beside the common ones.
        state: type of the nodal arrays.
        memory: type of what the Prony terms remember.
    """

    bytes: int
    replaced: tuple[tuple[str, str], ...] = ()
    flags: tuple[str, ...] = ()
    state: type = np.float64
    memory: type = np.float64


FLOAT_MEMORY = (
    ("double *memory;", "float *memory;"),
    ("remember(double *restrict Z", "remember(float *restrict Z"),
    *((f"InOut Z{k}", f"float *restrict Z{k}") for k in range(6)),
    ("double *Z = a->memory + j * n, *f", "float *Z = a->memory + j * n; double *f"),
)
VARIANTS = {
    "as it is": Variant(168),
    "coordinates of every node": Variant(184, flags=("-DANY_MESH",)),
    "memory of the Prony terms in float32": Variant(120, FLOAT_MEMORY, memory=np.float32),
    "all in float32": Variant(84, (("double", "float"), ("sqrt(", "sqrtf(")), SINGLE, np.float32, np.float32),
}

OWN = {
    "own step": (168, {}),
    "own step, heights of every node": (176, {"y": "Y"}),
    "own step, coordinates of every node": (184, {"x": "X", "y": "Y"}),
}
"""Bytes moved per update by the package, and which coordinates it reads in place of those by column and row."""


def own(start: Problem, coordinates: dict[str, str]) -> NumbaVersion:
    """The package's step on a problem of its own."""
    copy, a = start.copy(), start.model.arrays
    arrays = copy.model.arrays._replace(
        **{name: getattr(a, by_node) for name, by_node in coordinates.items()}
    )
    return NumbaVersion(replace(copy, model=replace(copy.model, arrays=arrays)))


def compiled(variant: Variant, stem: Path) -> ctypes.CDLL:
    """The yardstick with the change in it, with the wider vectors and two loops."""
    text = SOURCE.read_text(encoding="utf-8")
    for old, new in variant.replaced:
        if old not in text:
            raise SystemExit(f"yardstick.c has no {old!r} any more")
        text = text.replace(old, new)
    stem.with_suffix(".c").write_text(text, encoding="utf-8")
    flags = (*FLAGS, *WIDTHS["512 bit"], *LOOPS["two loops"], *variant.flags)
    subprocess.run(["gcc", *flags, "-c", f"{stem}.c", "-o", f"{stem}.o"], check=True)
    subprocess.run(["gcc", "-shared", f"{stem}.o", "-o", f"{stem}.so", "-lm"], check=True)
    return ctypes.CDLL(f"{stem}.so")


class Contender:
    """A problem as a variant steps it."""

    STATE = ("X", "Y", "u", "w", "vx", "vy", "inverse_mass")

    def __init__(self, library: ctypes.CDLL, variant: Variant, start: Problem) -> None:
        model, a = start.model, start.model.arrays
        rows, columns = model.mesh.shape
        self.arrays = {name: getattr(a, name).astype(variant.state) for name in self.STATE}
        self.arrays["memory"] = model.memory.astype(variant.memory)
        for name, shape in (("forces", (2, 8, columns + 2)), ("nothing", (8, columns + 2))):
            self.arrays[name] = np.zeros(shape, variant.state)
        self.arrays["old"] = np.zeros((2, 4, max(rows, columns) + 1), variant.state)
        numbers = [
            *a.moduli[0],
            *a.factors[0, 0, :3],
            start.dt,
            model.boundary.length,
            PLATE_SPEED,
        ]
        self._real = ctypes.c_double if variant.state is np.float64 else ctypes.c_float
        self._library = library
        pointers = [array.ctypes.data for array in self.arrays.values()]
        real = self._real

        class Block(ctypes.Structure):
            _fields_ = (
                ("sizes", ctypes.c_long * 2),
                ("pointers", ctypes.c_void_p * len(pointers)),
                ("numbers", real * len(numbers)),
                ("totals", real * 4),
            )

        self._block = Block()
        self._block.sizes[:] = (rows, columns)
        self._block.pointers[:] = pointers
        self._block.numbers[:] = numbers

    def advance(self, n_steps: int) -> None:
        """Take steps from time 0."""
        self._library.advance(ctypes.byref(self._block), ctypes.c_long(n_steps), self._real(0.0))


def rest(dt: float) -> Problem:
    """The paper's case at rest, struck at full speed."""
    model = parts.paper()
    update_factors(model.arrays.terms, dt, dt, model.arrays.factors)
    return Problem(model, model.boundary, dt)


def error(library: ctypes.CDLL, variant: Variant, exact: np.ndarray | None) -> tuple[np.ndarray, float]:
    """Displacements at the end, and their largest difference from the exact ones over the largest of these."""
    contender = Contender(library, variant, rest(DT))
    contender.advance(round(END / DT))
    u = np.stack([contender.arrays["u"], contender.arrays["w"]]).astype(float)
    return u, 0.0 if exact is None else float(np.abs(u - exact).max() / np.abs(exact).max())


def line(name: str, moved: int, rates: dict[int, dict[str, float]], base: str, error: str) -> str:
    """A row of the table; gains are those over ``base``."""
    gains = (f"{of_size[name] / 1e6:.0f} ({of_size[name] / of_size[base]:.2f})" for of_size in rates.values())
    return f"| {name} | {moved} | {' | '.join(gains)} | {error} |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=int, nargs="+", default=SIZES, help="elements")
    offer_to_keep(parser)
    options = parser.parse_args()
    with tempfile.TemporaryDirectory() as scratch:
        libraries = {
            name: compiled(variant, Path(scratch) / f"variant{k}")
            for k, (name, variant) in enumerate(VARIANTS.items())
        }
        exact, errors = None, {}
        for name, variant in VARIANTS.items():
            u, errors[name] = error(libraries[name], variant, exact)
            exact = u if exact is None else exact
        rates: dict[int, dict[str, float]] = {}
        for size in options.sizes:
            start = problem(size)
            runs = {name: Contender(libraries[name], v, start).advance for name, v in VARIANTS.items()}
            runs |= {name: own(start, coordinates).advance for name, (_, coordinates) in OWN.items()}
            rates[size] = best_rates(runs, start.n_elements, 4)
    head = ("variant", "bytes", *(f"{size:,}" for size in options.sizes), "error")
    print("| " + " | ".join(head) + " |\n|" + " --- |" * len(head))
    for name, variant in VARIANTS.items():
        print(line(name, variant.bytes, rates, "as it is", f"{errors[name]:.1e}"))
    for name, (moved, _) in OWN.items():
        print(line(name, moved, rates, "own step", ""))
    keep({"rates": rates, "errors": errors}, options.out)


if __name__ == "__main__":
    main()
