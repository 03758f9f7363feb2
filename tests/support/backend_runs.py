"""Runs of the small models on one device, a restart, and a case by its file.

``python -m support.backend_runs DEVICE FILE.npz`` in a process of its own, since numba decides when it is imported
whether CUDA is simulated.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from support.backend_models import EVENTS, MODELS, results, run, struck
from support.cases import EXAMPLES
from support.models import Array
from wrinklewave.dynamics.backends import Device
from wrinklewave.dynamics.checkpoint import Record, read_checkpoint, write_checkpoint
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.experiments.simulate import simulate


def restarted(device: Device) -> dict[str, Array]:
    """As :func:`run` of :func:`struck`, through a checkpoint in the middle."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "checkpoint.h5"
        first = Simulation(struck(), EVENTS, device=device, history_interval=2.5e-5)
        events = first.run()
        next(events)
        next(events)
        write_checkpoint(file, first, Record({"nothing": np.zeros(1)}), "")
        second = Simulation(struck(), EVENTS, device=device, history_interval=2.5e-5)
        read_checkpoint(file, second, "")
    for _ in second.run():
        pass
    return results(second)


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
    np.savez(
        file, **{f"{name}/{key}": values for name, found in runs.items() for key, values in found.items()}
    )


if __name__ == "__main__":
    main("cuda" if sys.argv[1] == "cuda" else "cpu", sys.argv[2])
