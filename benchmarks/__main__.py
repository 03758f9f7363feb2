"""Speed of the stepping on this machine beside the same arithmetic in C and in NumPy: ``python -m benchmarks``.

Contenders take turns within each repetition, so that what else the machine does hits all of them alike. The table has
element updates per second (best of all repetitions) and the ratio to the fastest form of the C version.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from benchmarks.c_version import CVersion, compiled
from benchmarks.machine import description, keep, offer_to_keep
from benchmarks.numba_version import NumbaVersion
from benchmarks.numpy_version import NumpyVersion
from benchmarks.problem import STATE, Problem, problem
from wrinklewave.environment import processor

SIZES = (10_000, 15_000, 100_000, 1_000_000, 4_000_000)
QUICK_SIZES = (10_000, 100_000)
UPDATES = 6e6  # per timing
CHECKED_STEPS = 50
TOLERANCE = 1e-9
STATE_BYTES = 7 * 8 + 6 * 8
"""Kept per element: coordinates, displacements, velocities, inverse mass of a node; six numbers of a Prony term."""
TRAFFIC_BYTES = (2 * 2 + 2 * 2 + 1 + 2 * 6) * 8
"""Moved per update, if nothing but single rows stays in a cache: reads, and writes where there are any."""


def check(n_elements: int, folder: Path) -> dict[str, float]:
    """Largest relative difference from the package, of each form of C and of NumPy, after some steps."""
    start = problem(n_elements)
    ours, in_numpy = start.copy(), start.copy()
    NumbaVersion(ours).advance(CHECKED_STEPS)
    NumpyVersion(in_numpy).advance(CHECKED_STEPS)
    found = {"NumPy": difference(ours, in_numpy)}
    for name, library in compiled(folder).items():
        in_c = start.copy()
        CVersion(library, in_c).advance(CHECKED_STEPS)
        found[f"C, {name}"] = difference(ours, in_c)
    return found


def difference(ours: Problem, theirs: Problem) -> float:
    """Largest difference between two states, relative to the largest value."""
    pairs = ((getattr(ours.model.arrays, name), getattr(theirs.model.arrays, name)) for name in STATE)
    return max(float(np.abs(a - b).max() / np.abs(a).max()) for a, b in pairs)


def contenders(n_elements: int, folder: Path, threads: int) -> dict[str, Callable[[int], None]]:
    """What is timed, by name; each takes a number of steps."""
    start = problem(n_elements)
    found: dict[str, Callable[[int], None]] = {}
    for name, library in compiled(folder).items():
        c = CVersion(library, start.copy())
        found |= {f"C kernel, {name}": c.kernel, f"C step, {name}": c.advance}
    one = NumbaVersion(start.copy())
    found |= {"kernel": one.kernel, "step, 1 thread": one.advance}
    if threads > 1:
        found["step, 2 threads"] = NumbaVersion(start.copy(), 2).advance
    return found | {"NumPy step": NumpyVersion(start.copy()).advance}


def measure(n_elements: int, folder: Path, threads: int, repetitions: int) -> dict[str, float]:
    """Best element updates per second of every contender."""
    runs = contenders(n_elements, folder, threads)
    rates = dict.fromkeys(runs, 0.0)
    for repetition in range(repetitions + 1):
        for name, run in runs.items():
            updates = UPDATES / 20 if name.startswith("NumPy") else UPDATES
            n_steps = max(2, round(updates / n_elements))
            begin = time.perf_counter()
            run(n_steps)
            if repetition:  # the first warms up
                rates[name] = max(rates[name], n_steps * n_elements / (time.perf_counter() - begin))
    return rates


def copy_bandwidth() -> float:
    """Bytes per second of a large copy, read and written."""
    source = np.ones(30_000_000)
    target = np.empty_like(source)
    best = 0.0
    for _ in range(6):
        begin = time.perf_counter()
        np.copyto(target, source)
        best = max(best, 2 * source.nbytes / (time.perf_counter() - begin))
    return best


def line(n_elements: int, rates: dict[str, float], bandwidth: float) -> str:
    """A row of the table."""
    kernel = max(rate for name, rate in rates.items() if name.startswith("C kernel"))
    step = max(rate for name, rate in rates.items() if name.startswith("C step"))
    one, two = rates["step, 1 thread"], rates.get("step, 2 threads", float("nan"))
    cells = (
        f"{n_elements:,}",
        f"{rates['kernel'] / 1e6:.1f}",
        f"{rates['kernel'] / kernel:.2f}",
        f"{one / 1e6:.1f}",
        f"{one / step:.2f}",
        f"{two / 1e6:.1f}",
        f"{two / one:.2f}",
        f"{two / step:.2f}",
        f"{one * TRAFFIC_BYTES / bandwidth:.2f}",
        f"{rates['NumPy step'] / 1e6:.1f}",
    )
    return "| " + " | ".join(cells) + " |"


COLUMNS = (
    *("elements", "kernel", "of C", "step, 1 thread", "of C", "step, 2 threads", "of 1 thread", "of C"),
    *("of copy bandwidth", "NumPy step"),
)
HEADING = "| " + " | ".join(COLUMNS) + " |\n|" + " --- |" * len(COLUMNS)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="two sizes, fewer repetitions")
    offer_to_keep(parser)
    options = parser.parse_args()
    threads = min(2, processor().usable)
    machine, rates = description(), {}
    with tempfile.TemporaryDirectory() as scratch:
        differences = check(QUICK_SIZES[0], Path(scratch))
        for name, found_difference in differences.items():
            if not found_difference < TOLERANCE:
                raise SystemExit(f"{name} differs by {found_difference:.1e} after {CHECKED_STEPS} steps")
        bandwidth = copy_bandwidth()
        print(f"{machine['processor']}, {machine['date']}; million element updates per second")
        print(
            f"C and NumPy agree with it to {max(differences.values()):.1e} after {CHECKED_STEPS} steps; "
            f"copy {bandwidth / 1e9:.1f} GB/s;"
        )
        print(
            f"{STATE_BYTES} bytes kept per element, {TRAFFIC_BYTES} moved per update\n\n{HEADING}", flush=True
        )
        for size in QUICK_SIZES if options.quick else SIZES:
            rates[size] = measure(size, Path(scratch), threads, 3 if options.quick else 12)
            print(line(size, rates[size], bandwidth), flush=True)
    found = {"differences_after_50_steps": differences, "copy_bytes_per_s": bandwidth, "rates": rates}
    keep(found, options.out)


if __name__ == "__main__":
    main()
