"""Floating-point operations of one element update, counted as the kernels do them: ``python -m benchmarks.operations``.

The kernels' own source runs on numbers that count: additions, multiplications, divisions and square roots, of one
element and of the node that belongs to it. Comparisons are not counted; what a compiler may save is counted all the
same.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections import Counter
from typing import Any, ClassVar

import numpy as np

KINDS = ("add", "multiply", "divide", "root")
INTERPRETED = {"NUMBA_DISABLE_JIT": "1"}


class Counting:
    """A number that counts what is done with it, in ``done``."""

    done: ClassVar[Counter[str]] = Counter()

    def __init__(self, value: float) -> None:
        self.value = float(value)

    def __float__(self) -> float:
        Counting.done["root"] += 1  # math.sqrt is the only one to ask
        return self.value

    def __neg__(self) -> Counting:
        return Counting(-self.value)

    def __lt__(self, other: Any) -> bool:
        return self.value < _value(other)

    def __gt__(self, other: Any) -> bool:
        return self.value > _value(other)


def _value(number: Any) -> float:
    return number.value if isinstance(number, Counting) else number


def _counted(kind: str, operation: Any) -> tuple[Any, Any]:
    def forward(self: Counting, other: Any) -> Counting:
        Counting.done[kind] += 1
        return Counting(operation(self.value, _value(other)))

    def backward(self: Counting, other: Any) -> Counting:
        Counting.done[kind] += 1
        return Counting(operation(_value(other), self.value))

    return forward, backward


for _name, _kind, _operation in (
    ("add", "add", lambda x, y: x + y),
    ("sub", "add", lambda x, y: x - y),
    ("mul", "multiply", lambda x, y: x * y),
    ("truediv", "divide", lambda x, y: x / y),
):
    _forward, _backward = _counted(_kind, _operation)
    setattr(Counting, f"__{_name}__", _forward)
    setattr(Counting, f"__r{_name}__", _backward)


def counting(array: np.ndarray) -> np.ndarray:
    """The same numbers as ones that count."""
    return np.vectorize(Counting, otypes=[object])(array)


def count() -> dict[str, dict[str, int]]:
    """Operations of an element and of a node of the paper's case, by kind."""
    from benchmarks.parts import paper
    from wrinklewave.dynamics.rows import move_node
    from wrinklewave.dynamics.step import element, update_factors

    model = paper(2, 2)
    a = model.arrays
    a.u[:], a.w[:] = 1e-5 * np.random.default_rng(1).standard_normal((2, *a.u.shape))
    update_factors(a.terms, 1e-6, 1e-6, a.factors)
    X, Y, u, w, vx, vy, mass, factors, moduli = map(
        counting, (a.X, a.Y, a.u, a.w, a.vx, a.vy, a.inverse_mass, a.factors[0], a.moduli[0])
    )
    memory, forces = tuple(map(counting, model.memory)), counting(np.zeros((8, 4)))
    found = {}
    Counting.done.clear()
    element(0, 0, X, Y, u, w, vx, vy, memory, model.terms, factors, moduli, forces)
    found["element"] = {kind: Counting.done[kind] for kind in KINDS}
    Counting.done.clear()
    dt = Counting(1e-6)
    move_node(1, 1, forces, forces, mass, dt, dt, u, w, vx, vy)
    found["node"] = {kind: Counting.done[kind] for kind in KINDS}
    return found


def per_update() -> dict[str, dict[str, int]]:
    """As :func:`count`, from a process of its own, in which nothing is compiled."""
    command = [sys.executable, "-m", "benchmarks.operations"]
    done = subprocess.run(command, env=os.environ | INTERPRETED, check=True, capture_output=True, text=True)
    return json.loads(done.stdout)


if __name__ == "__main__":
    if "NUMBA_DISABLE_JIT" in os.environ:
        print(json.dumps(count()))
    else:
        for thing, kinds in per_update().items():
            print(thing, kinds, "in all", sum(kinds.values()))
