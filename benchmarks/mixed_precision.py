"""Mixed precision beside double: ``python -m benchmarks.mixed_precision``.

Element updates per second of the whole step, in turns, best of all repetitions; and what the paper's impact loses.
"""

from __future__ import annotations

import argparse
import time

import numpy as np

import wrinklewave as ww
from benchmarks.machine import keep, offer_to_keep
from benchmarks.numba_version import NumbaVersion
from benchmarks.problem import PAPER_CASE, problem

SIZES = (15_000, 100_000, 1_000_000, 4_000_000)
UPDATES, REPETITIONS = 6e6, 5
PRECISIONS = ("double", "mixed")
NUMBERS = (
    "wavefront_speed_m_per_s",
    "wrinkle_speed_m_per_s",
    "wrinkle_amplitude_max_m",
    "strain_rate_max_per_s",
)


def rates(n_elements: int, threads: int) -> dict[str, float]:
    """Element updates per second by precision."""
    versions = {p: NumbaVersion(problem(n_elements, p), threads) for p in PRECISIONS}
    best, n_steps = dict.fromkeys(PRECISIONS, 0.0), max(2, round(UPDATES / n_elements))
    for repetition in range(REPETITIONS + 1):
        for precision, version in versions.items():
            begin = time.perf_counter()
            version.advance(n_steps)
            if repetition:  # the first warms up
                rate = n_steps * n_elements / (time.perf_counter() - begin)
                best[precision] = max(best[precision], rate)
    return best


def differences() -> dict[str, float]:
    """Of the paper's impact in mixed precision from that in double, relative."""
    double, mixed = (ww.simulate(PAPER_CASE, overrides=[f"solver.precision={p}"]) for p in PRECISIONS)
    y, y_mixed = (run.surface["y_p"].values for run in (double, mixed))
    rise = np.abs(y - y[0]).max()
    found = {"surface height, over its largest rise": float(np.abs(y_mixed - y).max() / rise)}
    found |= {name: mixed.summary[name] / double.summary[name] - 1 for name in NUMBERS}
    imbalances = (run.summary["energy_imbalance_max"] for run in (double, mixed))
    return found | dict(zip(("imbalance in double", "imbalance in mixed"), imbalances, strict=True))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    offer_to_keep(parser)
    options = parser.parse_args()
    measured = []
    print("| elements | threads | double | mixed | gain |\n| --- | --- | --- | --- | --- |")
    for size in SIZES:
        for threads in (1, 2):
            found = rates(size, threads)
            measured.append({"elements": size, "threads": threads, **found})
            double, mixed = (found[p] for p in PRECISIONS)
            print(
                f"| {size:,} | {threads} | {double / 1e6:.0f} | {mixed / 1e6:.0f} | {mixed / double:.2f} |",
                flush=True,
            )
    changes = differences()
    for name, value in changes.items():
        print(f"{name}: {value:.1e}")
    keep({"rates": measured, "differences": changes}, options.out)


if __name__ == "__main__":
    main()
