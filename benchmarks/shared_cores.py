"""Two threads beside a process that keeps a core busy: ``python -m benchmarks.shared_cores``.

The paper's impact for a millisecond, on one thread and on two, in turns, alone and beside the other process.
"""

from __future__ import annotations

import subprocess
import sys

import numpy as np

from benchmarks.problem import PAPER_CASE
from wrinklewave.config import load_case
from wrinklewave.dynamics.model import build_model
from wrinklewave.dynamics.simulation import Simulation

CHANGES = ("substrate.bulk_response=elastic-instantaneous",)
EVENTS = np.linspace(0.0, 1e-3, 11)
REPETITIONS = 3


def rate(threads: int) -> float:
    """Element updates per second."""
    case = load_case(PAPER_CASE, CHANGES)
    simulation = Simulation(build_model(case, threads=threads), EVENTS, history_interval=1e-5)
    for _ in simulation.run():
        pass
    return simulation.updates_per_second


def compare() -> tuple[float, float]:
    """Median rates of one thread and of two."""
    rate(2)  # compiled, warm
    pairs = [(rate(1), rate(2)) for _ in range(REPETITIONS)]
    one, two = np.median(pairs, axis=0)
    return float(one), float(two)


def main() -> None:
    print("| | 1 thread | 2 threads | ratio |\n| --- | --- | --- | --- |")
    alone = compare()
    busy = subprocess.Popen([sys.executable, "-c", "while True: pass"])
    try:
        beside = compare()
    finally:
        busy.kill()
    for name, (one, two) in (("alone", alone), ("beside a busy process", beside)):
        print(f"| {name} | {one / 1e6:.0f} million/s | {two / 1e6:.0f} | {two / one:.2f} |")


if __name__ == "__main__":
    main()
