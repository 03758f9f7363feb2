"""All that is to be known of the GPU backend, on a machine with a GPU: ``python -m benchmarks.gpu --out FILE.json``.

Needs numba, numba-cuda, NumPy, SciPy and h5py, no pydantic and no pint; about five minutes, and no check is begun after
six. In order, each result written as soon as it is there, so that a run that is cut off leaves what it has:

1. the paper's case, its first 1,000 steps on both devices, to 1e-10;
2. element updates per second by mesh size, and what fraction of the copy bandwidth they move;
3. stepping time of the resolved case, to its end, with steps of their own for rows of elements and with one step for
   all, and how many element updates the first way saves; of one run and of a batch;
4. the same of the paper's case, K_0 and K_i, and runs per minute in batches of 1 to 256, each struck at its own speed;
5. the backends' test body: every small model of the tests on both devices, to 1e-10;
6. output: the same with 500 snapshots copied to the host, of one run and of a batch;
7. steps with registers for more threads, some of which then do not suffice.

In numba's simulator (``NUMBA_ENABLE_CUDASIM=1 NUMBA_DISABLE_JIT=1``) all of it runs on a handful of elements, to no
purpose but to show that it runs.
"""

from __future__ import annotations

import argparse
import json
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
from numba import config, cuda

from benchmarks import parts
from benchmarks.machine import REPOSITORY, description
from wrinklewave.dynamics import drives
from wrinklewave.dynamics.asking import answered_together
from wrinklewave.dynamics.backends import Device, March
from wrinklewave.dynamics.cuda import kernels
from wrinklewave.dynamics.cuda.backend import USED_MEMORY, Batch, memory_of
from wrinklewave.dynamics.model import Model, subcycled
from wrinklewave.dynamics.simulation import Simulation


@dataclass(frozen=True)
class Extent:
    """How much is measured.

    Args:
        paper: columns and rows of the paper's mesh.
        resolved: the same of the resolved case's, of its substrate.
        sizes: numbers of elements, for the throughput.
        large: those that are tried with fewer registers.
        compared_steps: of the paper's case, on both devices.
        steps: of a march, for the throughput.
        end_time: of whole runs [s].
        outputs: of a run with output.
        batches: numbers of members, of the paper's case.
        resolved_batches: the same of the resolved case.
        models: of the tests, at most.
        seconds: that a measurement of one mesh, and at most one of a batch, takes.
    """

    paper: tuple[int, int] = (202, 74)
    resolved: tuple[int, int] = (720, 51)
    sizes: tuple[float, ...] = (1e4, 1e5, 1e6, 4e6, 1e7)
    large: float = 4e6
    compared_steps: int = 1000
    steps: int = 64
    end_time: float = parts.END_TIME
    outputs: int = 500
    batches: tuple[int, ...] = (1, 4, 16, 64, 256)
    resolved_batches: tuple[int, ...] = (1, 8)
    models: int = 100
    seconds: tuple[float, float] = (1.0, 20.0)


SIMULATED = Extent((4, 2), (3, 8), (8, 18), 18, 8, 2, 2e-5, 2, (1, 2), (1,), 1, (0.0, 20.0))
EXTENT = SIMULATED if config.ENABLE_CUDASIM else Extent()
LIMIT = 360.0
"""Seconds after which no check is begun."""
AGREEMENT = 1e-10
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

    found, again, batched = {}, {}, {}
    for name, model in list(backend_models.MODELS.items())[: EXTENT.models]:
        gpu, other, cpu = (backend_models.run(model(), device) for device in ("cuda", "cuda", CPU))
        found[name] = max(differences(gpu, cpu).values())
        again[name] = max(differences(other, gpu).values())
        simulations = [backend_models.simulation_of(model(), "cuda") for _ in range(2)]
        batched[name] = max(
            max(differences(member, gpu).values()) for member in backend_models.run_together(simulations)
        )
    exact = not any(again.values()) and not any(batched.values())
    within = all(error < (AGREEMENT if name != "mixed" else 1e-4) for name, error in found.items())
    return {"to_cpu": found, "to_itself": again, "in_a_batch": batched, "passed": within and exact}


def advanced(model: Model, device: Device, n_steps: int) -> dict[str, np.ndarray]:
    """State after a number of steps of one length."""
    simulation = Simulation(model, np.zeros(1), device=device)
    dt = 0.5 * simulation.stable_step()
    totals = simulation.backend.march(March(n_steps, 0.0, 0.0, dt)).totals
    simulation.backend.fetch_all()
    return {name: getattr(model.arrays, name) for name in STATE} | {"memory": model.memory, "totals": totals}


def paper_case() -> Result:
    """The paper's case on both devices."""
    gpu, cpu = (
        advanced(parts.paper(*EXTENT.paper), device, EXTENT.compared_steps) for device in ("cuda", CPU)
    )
    found = differences(gpu, cpu)
    return {
        "steps": EXTENT.compared_steps,
        "differences": found,
        "passed": max(found.values()) < AGREEMENT,
    }


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
        best = max(best, 10 * 2 * 8 * source.size / (time.perf_counter() - begin))
    return best


def throughput(size: float) -> Result:
    """Updates per second of one mesh, from rest and struck, in marches of 64 steps with their surveys."""
    model = parts.paper(*parts.shape(size))
    simulation = Simulation(model, np.zeros(1), device="cuda")
    dt = 0.5 * simulation.stable_step()
    n, best, spent = EXTENT.steps, np.inf, 0.0
    while not spent or spent < EXTENT.seconds[0]:
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


def struck_at(velocity: float, K: float) -> Model:
    """The paper's case at another speed [m/s]."""
    model = parts.paper(*EXTENT.paper, K=K)
    drive = SimpleNamespace(**{**vars(parts.DRIVE), "velocity": velocity})
    return replace(model, boundary=model.boundary._replace(motion=drives.striker(drive)))


def to_the_end(simulation: Simulation, outputs: int, deadline: float) -> Iterator[March]:
    """Ask for the marches of a whole run, or as far as it gets in time; ``outputs`` are brought to the host."""
    taken = []
    while simulation.has_events and time.perf_counter() < deadline:
        yield from simulation.to_next_event()
        if outputs:
            taken.append(simulation.backend.snapshot())
        if len(taken) > 4:
            taken.pop(0)()
    for wait in taken:
        wait()


def whole_runs(models: Sequence[Model], outputs: int = 0) -> Result:
    """A batch of runs to their end, or to the limit of time for a measurement: then runs per minute say what the rest
    would take at the same pace.
    """
    events = np.linspace(0.0, EXTENT.end_time, max(outputs, min(50, EXTENT.compared_steps)) + 1)
    simulations = [Simulation(model, events, device="cuda", history_interval=1e-4) for model in models]
    batch = Batch(models)
    for simulation, member in zip(simulations, batch.members(), strict=True):
        simulation.backend = member
        simulation.stable_step()  # the state goes to the device
    simulations[0].backend.snapshot()()  # compiles; the steps have been compiled for other meshes
    begin = time.perf_counter()
    deadline = begin + EXTENT.seconds[1]
    running = [to_the_end(s, outputs, deadline) for s in simulations]
    failures = [str(end) for _, end in answered_together(running, batch.march) if end is not None]
    seconds = time.perf_counter() - begin
    done = float(np.mean([s.time for s in simulations])) / EXTENT.end_time
    updates = sum(s.updates for s in simulations)
    return {
        "runs": len(models),
        "steps": sum(s.step for s in simulations),
        "updates": updates,
        "done": done,
        "stepping_s": sum(s.stepping_seconds for s in simulations),
        "wall_s": seconds,
        "updates_per_s_of_wall": updates / seconds,
        "runs_per_minute": 60 * done * len(models) / seconds,
        "imbalance": max(s.imbalance for s in simulations),
        "failures": failures,
    }


def batch_of(n: int, K: float, outputs: int = 0) -> Result:
    """Runs of the paper's case at speeds of 8 to 12 m/s, if the device has room for them."""
    first = struck_at(8.0, K)
    free = cuda.current_context().get_memory_info().free
    if n * memory_of(first) > USED_MEMORY * free:
        return {"skipped": f"{n * memory_of(first) / 1e9:.3g} GB, and {free / 1e9:.3g} GB are free"}
    return whole_runs([struck_at(velocity, K) for velocity in np.linspace(8.0, 12.0, n)], outputs)


def with_fewer_registers() -> Result:
    """A large mesh and a batch with registers for at least twice as many threads."""
    usual = kernels.steps
    options = {} if config.ENABLE_CUDASIM else {"max_registers": 128}
    kernels.steps = cuda.jit(**options)(usual.py_func)
    try:
        return {
            "throughput": throughput(EXTENT.large),
            "batch": batch_of(EXTENT.batches[-2], parts.K_0),
        }
    finally:
        kernels.steps = usual


def resolved(n: int) -> Result:
    """Runs of the resolved case with steps of their own for rows of elements, and with one step for all."""
    models = [parts.resolved(*EXTENT.resolved) for _ in range(2 * n)]
    own, equal = whole_runs([subcycled(model) for model in models[:n]]), whole_runs(models[n:])
    fewer = equal["updates"] / equal["done"] * own["done"] / own["updates"]
    return {
        "own_steps": own,
        "one_step_for_all": equal,
        "times_fewer_updates": fewer,
        "updates_saved": 1 - 1 / fewer,
    }


def checks() -> Iterator[tuple[str, Callable[[], Result]]]:
    """Name and measurement of everything, the most important first."""
    yield "paper_case_against_cpu", paper_case
    for size in EXTENT.sizes:
        yield f"throughput_{size:.0e}", lambda size=size: throughput(size)
    for n in EXTENT.resolved_batches:
        yield f"resolved_{n}", lambda n=n: resolved(n)
    for n in EXTENT.batches:
        for name, K in (("K_0", parts.K_0), ("K_i", parts.K_I)):
            yield f"batch_{n}_{name}", lambda n=n, K=K: batch_of(n, K)
    yield "test_body", test_body
    for n in EXTENT.batches[:3]:
        yield f"outputs_{n}", lambda n=n: batch_of(n, parts.K_I, EXTENT.outputs)
    yield "with_fewer_registers", with_fewer_registers


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, help="file for the numbers, JSON")
    options = parser.parse_args()
    if not config.ENABLE_CUDASIM and not cuda.is_available():
        raise SystemExit("no GPU that can be used; wrinklewave doctor says why")
    if config.ENABLE_CUDASIM:
        sys.setswitchinterval(1e-4)  # its threads wait for each other far more often than they compute
    found: Result = description()
    started = time.perf_counter()
    for name, measure in checks():
        begin = time.perf_counter()
        try:
            late = begin - started > LIMIT
            found[name] = {"skipped": "no time left"} if late else measure()
        except Exception as error:  # the other measurements are worth having
            found[name] = {"failed": f"{type(error).__name__}: {error}"}
        print(f"{name} ({time.perf_counter() - begin:.1f} s): {json.dumps(found[name])}", flush=True)
        if options.out:
            options.out.write_text(json.dumps(found, indent=1) + "\n")


if __name__ == "__main__":
    main()
