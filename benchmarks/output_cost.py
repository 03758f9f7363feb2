"""What 500 outputs of surface and fields cost beside the stepping: ``python -m benchmarks.output_cost``.

The paper's case to its end. Fields are computed and written on a thread of their own, so what counts is how long the
stepping is held up: while the state is set aside, and for what is not written yet at the end. The whole run, energies
and stable steps included, is also held against one that stops at the same times without an output. Best of three.
"""

from __future__ import annotations

import argparse
import json
import tempfile
import time
from pathlib import Path

import numpy as np

from benchmarks import parts
from benchmarks.machine import keep, offer_to_keep
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.environment import processor
from wrinklewave.experiments.recording import FieldStore, Recording, SurfaceRecorder
from wrinklewave.experiments.vtkhdf import FieldFile

TIMES = np.linspace(0.0, parts.END_TIME, 501)
HISTORY_INTERVAL = 10e-6  # s, as in the case file
CASES = {"K_0": parts.K_0, "K_i": parts.K_I}


def run(K: float, threads: int, folder: Path) -> dict[str, float]:
    """Steps, seconds of stepping, seconds that it was held up by outputs, and seconds of all, of one run."""
    simulation = _simulation(K, threads)
    mesh, file = simulation.model.mesh, folder / "fields.vtkhdf"
    surface, store = SurfaceRecorder(mesh, parts.HALF), FieldStore(TIMES, FieldFile(file, mesh, TIMES))
    held_up, start = 0.0, time.perf_counter()
    with Recording(frozenset(TIMES), surface, store) as recording:
        for event in simulation.run():
            begin = time.perf_counter()
            recording.take(event.time, simulation)
            held_up += time.perf_counter() - begin
        begin = time.perf_counter()
        recording.flush()
        held_up += time.perf_counter() - begin
    whole = time.perf_counter() - start
    file.unlink()
    return {
        "steps": simulation.step,
        "stepping_s": simulation.stepping_seconds,
        "held_up_s": held_up,
        "whole_s": whole,
    }


def _simulation(K: float, threads: int) -> Simulation:
    return Simulation(parts.paper(K=K, threads=threads), TIMES, history_interval=HISTORY_INTERVAL)


def without_output(K: float, threads: int) -> float:
    """Seconds of the same run that stops at the same times and keeps nothing."""
    simulation, start = _simulation(K, threads), time.perf_counter()
    for _ in simulation.run():
        pass
    return time.perf_counter() - start


def cost(K: float, threads: int, folder: Path, repetitions: int = 3) -> dict[str, float]:
    """The least of each, and for what part of the time of stepping it was held up."""
    run(K, threads, folder)  # compiles
    runs = [run(K, threads, folder) | {"without_s": without_output(K, threads)} for _ in range(repetitions)]
    least = {name: min(found[name] for found in runs) for name in runs[0]}
    return least | {"cost": least["held_up_s"] / least["stepping_s"]}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    offer_to_keep(parser)
    options = parser.parse_args()
    found: dict[str, dict[str, float]] = {}
    with tempfile.TemporaryDirectory() as scratch:
        for name, K in CASES.items():
            for threads in range(1, min(2, processor().usable) + 1):
                found[f"{name}, {threads} threads"] = result = cost(K, threads, Path(scratch))
                print(f"{name}, {threads} threads: {json.dumps(result)}", flush=True)
    keep(found, options.out)


if __name__ == "__main__":
    main()
