"""All that is to be known of the GPU backend, on a machine with a GPU: ``python -m benchmarks.gpu --out FILE.json``.

Needs numba, numba-cuda, NumPy, SciPy and h5py, no pydantic and no pint; about five minutes. In order, each result
written as soon as it is there, so that a run that is cut off leaves what it has:

1. the backends' test body: every small model of the tests on both devices, to 1e-10;
2. the paper's case, its first 1,000 steps on both devices, to 1e-10;
3. element updates per second by mesh size, and what fraction of the copy bandwidth they move;
4. stepping times of the paper's case with K_i and of the resolved one, to the end;
5. output: the same run with 500 snapshots copied to the host;
6. runs per minute of paper-sized cases, one after the other.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np
from numba import config, cuda

from benchmarks import parts
from benchmarks.machine import REPOSITORY, description
from wrinklewave.dynamics.backends import Device, March
from wrinklewave.dynamics.model import Model
from wrinklewave.dynamics.simulation import Simulation

SIZES = (1e4, 1e5, 1e6, 4e6, 1e7)
AGREEMENT = 1e-10
COMPARED_STEPS = 1000
SECONDS_PER_SIZE = 1.0
STATE = ("u", "w", "vx", "vy")
READ, WRITTEN, READ_AGAIN, FORCES, MEMORY = 3, 2 * 4, 4, 2 * 8, 2 * 6
TRAFFIC = 8 * (READ + WRITTEN + READ_AGAIN + FORCES + MEMORY)
"""Bytes of an update: coordinates and mass read; displacements and velocities read and written, and read once more
since elements and nodes take turns; forces on four corners and the memory of one Prony term written and read."""
CPU: Device = "cuda" if config.ENABLE_CUDASIM else "cpu"
"""What the GPU is held against; the simulator excludes compiled code, and is compared with itself."""

Result = dict[str, Any]


def differences(ours: dict[str, np.ndarray], theirs: dict[str, np.ndarray]) -> dict[str, float]:
    """Largest difference of each array, relative to its largest value."""
    return {
        name: float(np.abs(ours[name] - theirs[name]).max() / max(np.abs(theirs[name]).max(), 1e-300))
        for name in theirs
    }


def test_body() -> Result:
    """Every model of the tests: largest relative difference between the devices, and between two runs on the GPU."""
    sys.path.insert(0, str(REPOSITORY / "tests"))
    from support import backend_models

    found, again = {}, {}
    for name, model in backend_models.MODELS.items():
        gpu, other, cpu = (backend_models.run(model(), device) for device in ("cuda", "cuda", CPU))
        found[name] = max(differences(gpu, cpu).values())
        again[name] = max(differences(other, gpu).values())
    passed = max(found.values()) < AGREEMENT and not any(again.values())
    return {"to_cpu": found, "to_itself": again, "passed": passed}


def advanced(model: Model, device: Device, n_steps: int) -> dict[str, np.ndarray]:
    """State after a number of steps of one length."""
    simulation = Simulation(model, np.zeros(1), device=device)
    dt = 0.5 * simulation.stable_step()
    totals = simulation.backend.march(March(n_steps, 0.0, 0.0, dt)).totals
    simulation.backend.fetch_all()
    return {name: getattr(model.arrays, name) for name in STATE} | {"memory": model.memory, "totals": totals}


def paper_case() -> Result:
    """The paper's case on both devices."""
    n = 20 if config.ENABLE_CUDASIM else COMPARED_STEPS
    size = (6, 3) if config.ENABLE_CUDASIM else (202, 74)
    gpu, cpu = (advanced(parts.paper(*size), device, n) for device in ("cuda", CPU))
    found = differences(gpu, cpu)
    return {"steps": n, "differences": found, "passed": max(found.values()) < AGREEMENT}


def copy_bandwidth(n_bytes: float) -> float:
    """Bytes per second, read and written, of copies on the device."""
    source = cuda.to_device(np.ones(int(n_bytes / 16)))
    target = cuda.device_array(source.shape)
    best = 0.0
    for _ in range(6):
        cuda.synchronize()
        begin = time.perf_counter()
        for _ in range(10):
            target.copy_to_device(source)
        cuda.synchronize()
        best = max(best, 10 * 2 * source.nbytes / (time.perf_counter() - begin))
    return best


def throughput(size: float) -> Result:
    """Updates per second of one mesh, from rest and struck, in marches of 64 steps."""
    model = parts.paper(*parts.shape(size))
    simulation = Simulation(model, np.zeros(1), device="cuda")
    dt = 0.5 * simulation.stable_step()
    n, best, spent = 64, np.inf, 0.0
    while spent < SECONDS_PER_SIZE:
        seconds = simulation.backend.march(March(n, 0.0, dt, dt)).seconds
        best, spent = min(best, seconds / n), spent + seconds
    elements = model.mesh.n_elements
    rate, copy = elements / best, copy_bandwidth(max(104.0 * elements, 1e6))
    return {
        "elements": elements,
        "updates_per_s": rate,
        "copy_bytes_per_s": copy,
        "of_copy": rate * TRAFFIC / copy,
        "microseconds_per_step": 1e6 * best,
    }


def whole_run(model: Model, outputs: int = 0) -> Result:
    """A case to its end; with ``outputs`` snapshots brought to the host on the way."""
    simulation = Simulation(
        model, np.linspace(0.0, parts.END_TIME, max(outputs, 50) + 1), device="cuda", history_interval=1e-4
    )
    begin, taken = time.perf_counter(), []
    for _ in simulation.run():
        if outputs:
            taken.append(simulation.backend.snapshot())
        if len(taken) > 4:
            taken.pop(0)()
    for wait in taken:
        wait()
    return {
        "steps": simulation.step,
        "stepping_s": simulation.stepping_seconds,
        "wall_s": time.perf_counter() - begin,
        "imbalance": simulation.imbalance,
    }


def outputs() -> Result:
    """The paper's case with K_i without and with 500 outputs; compiled by then."""
    without, with_them = whole_run(parts.paper(K=parts.K_I)), whole_run(parts.paper(K=parts.K_I), 500)
    return {"without": without, "with_500": with_them, "cost": with_them["wall_s"] / without["wall_s"] - 1}


def one_after_the_other() -> Result:
    """Paper-sized runs per minute."""
    begin, n = time.perf_counter(), 5
    for _ in range(n):
        whole_run(parts.paper())
    return {"runs": n, "runs_per_minute": 60 * n / (time.perf_counter() - begin)}


def checks() -> Iterator[tuple[str, Callable[[], Result]]]:
    """Name and measurement of everything, the most important first."""
    yield "test_body", test_body
    yield "paper_case_against_cpu", paper_case
    if config.ENABLE_CUDASIM:
        return  # the rest measures, and there is nothing to be measured
    for size in SIZES:
        yield f"throughput_{size:.0e}", lambda size=size: throughput(size)
    yield "paper_K_i", lambda: whole_run(parts.paper(K=parts.K_I))
    yield "resolved", lambda: whole_run(parts.resolved())
    yield "outputs", outputs
    yield "runs", one_after_the_other


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="file for the numbers, JSON")
    options = parser.parse_args()
    if not config.ENABLE_CUDASIM and not cuda.is_available():
        raise SystemExit("no GPU that can be used; wrinklewave doctor says why")
    found: Result = description()
    for name, measure in checks():
        begin = time.perf_counter()
        try:
            found[name] = measure()
        except Exception as error:  # the other measurements are worth having
            found[name] = {"failed": f"{type(error).__name__}: {error}"}
        print(f"{name} ({time.perf_counter() - begin:.1f} s): {json.dumps(found[name])}", flush=True)
        if options.out:
            options.out.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
