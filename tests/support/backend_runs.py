"""Runs of the small models on one device, a restart, and a case by its file.

``python -m support.backend_runs DEVICE FILE.npz`` in a process of its own, since numba decides when it is imported
whether CUDA is simulated.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from support.backend_models import (
    BATCHES,
    MODELS,
    compressed,
    results,
    run,
    run_together,
    simulation_of,
    struck,
)
from support.cases import EXAMPLES
from support.models import Array
from wrinklewave.dynamics.backends import Device
from wrinklewave.dynamics.checkpoint import Record, read_checkpoint, write_checkpoint
from wrinklewave.dynamics.model import Model
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.errors import RunError
from wrinklewave.experiments.simulate import simulate


def half_done(device: Device) -> Simulation:
    """That of :func:`struck` from a checkpoint in the middle."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "checkpoint.h5"
        first = simulation_of(struck(), device)
        events = first.run()
        next(events)
        next(events)
        write_checkpoint(file, first, Record({"nothing": np.zeros(1)}), "")
        second = simulation_of(struck(), device)
        read_checkpoint(file, second, "")
    return second


def restarted(device: Device) -> dict[str, Array]:
    """As :func:`run` of :func:`struck`, through a checkpoint in the middle."""
    second = half_done(device)
    for _ in second.run():
        pass
    return results(second)


def of_batches() -> dict[str, dict[str, Array]]:
    """Members of batches by the names of their models, and one that joins another half done."""
    found = {}
    for members in BATCHES:
        done = run_together([simulation_of(model(), "cuda") for model in members])
        found |= {f"together_{model.__name__}": of for model, of in zip(members, done, strict=True)}
    _, found["together_restarted"] = run_together([simulation_of(compressed(), "cuda"), half_done("cuda")])
    return {name: as_arrays(of) for name, of in found.items()}


def alone(model: Model) -> dict[str, Array] | RunError:
    """A run of its own on the GPU, or the error that it fails with."""
    try:
        return run(model, "cuda")
    except RunError as error:
        return error


def as_arrays(of: dict[str, Array] | RunError) -> dict[str, Array]:
    """Results, or the words of an error."""
    return {"error": np.array(str(of))} if isinstance(of, RunError) else of


def from_case(device: Device) -> dict[str, Array]:
    """A case file in a handful of elements, as the command line runs it: history and surface motion."""
    choices = ("mesh.elements=[6, 3]", "solver.end_time=0.2 ms", "output.surface_interval=0.05 ms")
    done = simulate(EXAMPLES / "quick.toml", device=device, threads=1, overrides=choices)
    assert done.summary["device"] == device
    surface = done.surface
    assert surface is not None  # the run has finished
    return done.history | {name: surface[name].values for name in ("x_p", "y_p", "strain_xx")}


def main(device: Device, file: str) -> None:
    """Run all and write their results."""
    sys.setswitchinterval(
        1e-4
    )  # the simulator's threads wait for each other far more often than they compute
    runs = {name: run(model(), device) for name, model in MODELS.items()}
    runs |= {"restarted": restarted(device), "from_case": from_case(device)}
    if device == "cuda":
        others = (model for members in BATCHES for model in members if model.__name__ not in runs)
        runs |= {model.__name__: as_arrays(alone(model())) for model in others} | of_batches()
    np.savez(
        file, **{f"{name}/{key}": values for name, found in runs.items() for key, values in found.items()}
    )


if __name__ == "__main__":
    main("cuda" if sys.argv[1] == "cuda" else "cpu", sys.argv[2])
