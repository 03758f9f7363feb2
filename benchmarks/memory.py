"""Memory of a simulation per element: ``python -m benchmarks.memory``.

Peak of a process that builds the model, steps it, surveys its energies and takes its fields, at two sizes of the mesh;
the difference between them is the elements' own.
"""

from __future__ import annotations

import resource
import subprocess
import sys

import numpy as np

from benchmarks.problem import PAPER_CASE, shape
from wrinklewave.config import load_case
from wrinklewave.dynamics.model import build_model
from wrinklewave.dynamics.simulation import Simulation

SIZES = (1_000_000, 4_000_000)
END = 2e-7  # s


def peak(n_elements: int) -> tuple[int, int]:
    """Elements, and peak of this process in bytes, of a run with about ``n_elements``."""
    columns, rows = shape(n_elements)
    case = load_case(PAPER_CASE, [f"mesh.elements=[{columns}, {rows}]"])
    simulation = Simulation(build_model(case, threads=2), np.array([0.0, END]))
    for _ in simulation.run():
        simulation.fields()
    return columns * rows, resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024


def main() -> None:
    if len(sys.argv) > 1:
        print(*peak(int(sys.argv[1])))
        return
    command = [sys.executable, "-m", "benchmarks.memory"]
    runs = [subprocess.run([*command, str(n)], check=True, capture_output=True, text=True) for n in SIZES]
    (n, small), (N, large) = ((int(word) for word in run.stdout.split()) for run in runs)
    print(f"{(large - small) / (N - n):.0f} bytes per element ({large / 2**30:.2f} GiB for {N:,} elements)")


if __name__ == "__main__":
    main()
