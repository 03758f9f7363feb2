"""How near the stepping is to what the machine can do: ``python -m benchmarks.limits --out FILE.json``.

Bytes of an element update are counted from the arrays of the model, operations from the kernels' source
(:mod:`benchmarks.operations`); copies of as many bytes as the state has, multiply-adds and the yardstick in C are
measured in the same run, in turns with the stepping.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.c_version import CVersion, compiled
from benchmarks.machine import arithmetic_rate, copy_bandwidth, description, keep, offer_to_keep
from benchmarks.numba_version import NumbaVersion
from benchmarks.operations import per_update
from benchmarks.problem import problem
from wrinklewave.dynamics.model import Model
from wrinklewave.environment import processor

SIZES = (1e4, 1e5, 1e6, 4e6, 1e7)
UPDATES = 6e6
"""Per timing."""
READ, WRITTEN = ("x", "y", "inverse_mass"), ("u", "w", "vx", "vy")
"""Nodal arrays that a step reads only, or reads and writes."""

COLUMNS = (
    *("elements", "state", "copy, 1 thread", "step, 1 thread", "of copy", "of arithmetic", "of C"),
    *("copy, 2 threads", "step, 2 threads", "of copy", "of 1 thread", "of C"),
)
HEADING = "| " + " | ".join(COLUMNS) + " |\n|" + " --- |" * len(COLUMNS)


def bytes_per_update(model: Model) -> dict[str, float]:
    """Bytes of one element and its node that a step needs, and that it moves if only single rows stay in a cache."""
    arrays = {name: getattr(model.arrays, name) for name in (*READ, *WRITTEN)}
    of_nodes = {name: values.itemsize for name, values in arrays.items() if values.ndim == 2}
    memory = model.memory.shape[0] * model.memory.itemsize
    written = sum(of_nodes[name] for name in WRITTEN) + memory
    needed = sum(of_nodes.values()) + memory
    return {"needed": needed, "moved": needed + written}


def best_rates(runs: dict[str, Callable[[int], None]], n_elements: int, repetitions: int) -> dict[str, float]:
    """Element updates per second of each contender, the best of its turns."""
    n_steps = max(2, round(UPDATES / n_elements))
    rates = dict.fromkeys(runs, 0.0)
    for repetition in range(repetitions + 1):
        for name, run in runs.items():
            begin = time.perf_counter()
            run(n_steps)
            if repetition:  # the first warms up
                rates[name] = max(rates[name], n_steps * n_elements / (time.perf_counter() - begin))
    return rates


def measure(size: float, libraries: dict[str, Any], threads: int, repetitions: int) -> dict[str, float]:
    """What one mesh does, and what the machine does with as many bytes."""
    start = problem(round(size))
    n, moved = start.n_elements, bytes_per_update(start.model)
    runs: dict[str, Callable[[int], None]] = {}
    for t in range(1, threads + 1):
        runs[f"step_{t}"] = NumbaVersion(start.copy(), t).advance
    for name, library in libraries.items():
        runs[f"c_{name}"] = CVersion(library, start.copy()).advance
    rates = best_rates(runs, n, repetitions)
    state = n * moved["needed"]
    copies = {f"copy_{t}_bytes_per_s": copy_bandwidth(state, t) for t in range(1, threads + 1)}
    return {"elements": n, "state_bytes": state, **rates, **copies}


def line(found: dict[str, float], moved: float, operations: float, arithmetic: float) -> str:
    """A row of the table."""
    one, two = found["step_1"], found.get("step_2", np.nan)
    copy_1, copy_2 = (found.get(f"copy_{t}_bytes_per_s", np.nan) for t in (1, 2))
    c = max((rate for name, rate in found.items() if name.startswith("c_")), default=np.nan)
    cells = (
        f"{found['elements']:,}",
        f"{found['state_bytes'] / 1e6:.0f} MB",
        f"{copy_1 / 1e9:.0f} GB/s",
        f"{one / 1e6:.0f}",
        f"{one * moved / copy_1:.2f}",
        f"{one * operations / arithmetic:.2f}",
        f"{one / c:.2f}",
        f"{copy_2 / 1e9:.0f} GB/s",
        f"{two / 1e6:.0f}",
        f"{two * moved / copy_2:.2f}",
        f"{two / one:.2f}",
        f"{two / c:.2f}",
    )
    return "| " + " | ".join(cells) + " |"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--sizes", type=float, nargs="+", default=SIZES, help="elements")
    parser.add_argument("--repetitions", type=int, default=8)
    offer_to_keep(parser)
    options = parser.parse_args()
    threads = min(2, processor().usable)
    counted = per_update()
    operations = sum(sum(kinds.values()) for kinds in counted.values())
    moved = bytes_per_update(problem(100).model)
    rates = {t: arithmetic_rate(t) for t in range(1, threads + 1)}
    machine = description()
    print(
        f"{machine['processor']}, {machine['cores']} cores, {machine['date']}; million element updates per second"
    )
    print(f"an update: {operations} operations, {moved['moved']} bytes moved of {moved['needed']} needed;")
    print(
        f"multiply-adds: {', '.join(f'{r / 1e9:.0f}' for r in rates.values())} billion operations/s\n\n{HEADING}"
    )
    found = []
    with tempfile.TemporaryDirectory() as scratch:
        libraries = compiled(Path(scratch))
        for size in options.sizes:
            found.append(measure(size, libraries, threads, options.repetitions))
            print(line(found[-1], moved["moved"], operations, rates[1]), flush=True)
    kept = {"operations": counted, "bytes": moved, "arithmetic_per_s": rates, "meshes": found}
    keep(kept, options.out)


if __name__ == "__main__":
    main()
