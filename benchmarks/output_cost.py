"""What 500 outputs of surface and fields cost beside the stepping: ``python -m benchmarks.output_cost``.

The paper's case to its end through the same 500 times, without and with outputs, in turns; best of three.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks import parts
from benchmarks.machine import description
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.environment import processor
from wrinklewave.experiments.recording import FieldStore, Recording, SurfaceRecorder
from wrinklewave.experiments.vtkhdf import FieldFile

TIMES = np.linspace(0.0, parts.END_TIME, 501)
CASES = {"K_0": parts.K_0, "K_i": parts.K_I}


def seconds(K: float, threads: int, folder: Path | None) -> tuple[float, float]:
    """Wall-clock time of a run, and the stepping's part of it; outputs go to ``folder`` if there is one."""
    simulation = Simulation(parts.paper(K=K, threads=threads), TIMES)
    begin = time.perf_counter()
    if folder is None:
        for _ in simulation.run():
            pass
        return time.perf_counter() - begin, simulation.stepping_seconds
    mesh, file = simulation.model.mesh, folder / "fields.vtkhdf"
    surface, store = SurfaceRecorder(mesh, parts.HALF), FieldStore(TIMES, FieldFile(file, mesh, TIMES))
    with Recording(frozenset(TIMES), surface, store) as recording:
        for event in simulation.run():
            recording.take(event.time, simulation)
    file.unlink()
    return time.perf_counter() - begin, simulation.stepping_seconds


def cost(K: float, threads: int, folder: Path, repetitions: int = 3) -> dict[str, float]:
    """Best times without and with outputs [s], and what the outputs add, over the time of stepping."""
    runs = [(seconds(K, threads, None), seconds(K, threads, folder)) for _ in range(repetitions + 1)][1:]
    without, with_them = min(a for (a, _), _ in runs), min(a for _, (a, _) in runs)
    stepping = min(s for (_, s), _ in runs)
    return {
        "without_s": without,
        "with_s": with_them,
        "stepping_s": stepping,
        "cost": (with_them - without) / stepping,
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="also write the numbers as JSON")
    options = parser.parse_args()
    found: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, K in CASES.items():
            for threads in range(1, min(2, processor().usable) + 1):
                found[f"{name}, {threads} threads"] = result = cost(K, threads, Path(scratch))
                print(f"{name}, {threads} threads: {json.dumps(result)}", flush=True)
    if options.out:
        options.out.write_text(json.dumps(description() | found, indent=1) + "\n")


if __name__ == "__main__":
    main()
