"""Runs of the small models on one device, a restart, and a case by its file.

``python -m support.backend_runs DEVICE FILE.npz`` in a process of its own, since numba decides when it is imported
whether CUDA is simulated. It leaves a checkpoint beside the file, and goes on from that of another device if one is
there.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from support.backend_models import (
    BATCHES,
    MODELS,
    compressed,
    filmed,
    filmed_softly,
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

RESTARTED = (struck, filmed)


def write_half(model: Model, device: Device, file: Path) -> None:
    """Write a checkpoint in the middle of a run."""
    simulation = simulation_of(model, device)
    events = simulation.run()
    next(events)
    next(events)
    write_checkpoint(file, simulation, Record({"nothing": np.zeros(1)}), "")


def half_done(model: Callable[[], Model], device: Device) -> Simulation:
    """That of a model from a checkpoint in the middle."""
    second = simulation_of(model(), device)
    with TemporaryDirectory() as folder:
        file = Path(folder) / "checkpoint.h5"
        write_half(model(), device, file)
        read_checkpoint(file, second, "")
    return second


def finished(simulation: Simulation) -> dict[str, Array]:
    """What a run leaves behind that goes on from a checkpoint."""
    for _ in simulation.run():
        pass
    return results(simulation)


def continued(model: Model, device: Device, checkpoint: Path) -> dict[str, Array]:
    """As :func:`run`, from a checkpoint on, whichever device it comes from."""
    simulation = simulation_of(model, device)
    read_checkpoint(checkpoint, simulation, "")
    return finished(simulation)


def of_batches() -> dict[str, dict[str, Array]]:
    """Members of batches by the names of their models, and one that joins another half done."""
    found = {}
    for members in BATCHES:
        done = run_together([simulation_of(model(), "cuda") for model in members])
        found |= {f"together_{model.__name__}": of for model, of in zip(members, done, strict=True)}
    for first, model in ((compressed, struck), (filmed_softly, filmed)):
        both = [simulation_of(first(), "cuda"), half_done(model, "cuda")]
        found[f"together_restarted_{model.__name__}"] = run_together(both)[1]
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


CASES = {
    "quick": ("mesh.elements=[6, 3]", "solver.end_time=0.2 ms", "output.surface_interval=0.05 ms"),
    "paper_resolved": (
        *("mesh.elements=[4, 10]", "film.imperfection.wavelength=30 mm", "drive.rise_time=0.01 ms"),
        *("solver.end_time=0.02 ms", "output.surface_interval=5 us", "output.field_interval=0.01 ms"),
        *("output.pixel_size=1 mm", "analysis.times=['0.01 ms']", "analysis.filter_wavelength=30 mm"),
    ),
}
"""Cases and choices that make them small; in the second one rows of elements have steps of their own."""


def from_case(name: str, device: Device) -> dict[str, Array]:
    """A case file in a handful of elements, as the command line runs it: history and surface motion."""
    done = simulate(EXAMPLES / f"{name}.toml", device=device, threads=1, overrides=CASES[name])
    assert done.summary["device"] == device
    assert (done.summary["steps_of_fastest_row"] > 1) == (name == "paper_resolved")
    surface = done.surface
    assert surface is not None  # the run has finished
    return done.history | {name: surface[name].values for name in ("x_p", "y_p", "strain_xx")}


def main(device: Device, file: str) -> None:
    """Run all and write their results."""
    sys.setswitchinterval(
        1e-4
    )  # the simulator's threads wait for each other far more often than they compute
    runs = {name: run(model(), device) for name, model in MODELS.items()}
    runs |= {f"restarted_{model.__name__}": finished(half_done(model, device)) for model in RESTARTED}
    runs |= {f"{name}_from_case": from_case(name, device) for name in CASES}
    folder, other = Path(file).parent, "cpu" if device == "cuda" else "cuda"
    write_half(filmed(), device, folder / f"{device}.h5")
    if (folder / f"{other}.h5").exists():
        runs["continued"] = continued(filmed(), device, folder / f"{other}.h5")
    if device == "cuda":
        others = (model for members in BATCHES for model in members if model.__name__ not in runs)
        runs |= {model.__name__: as_arrays(alone(model())) for model in others} | of_batches()
    np.savez(
        file, **{f"{name}/{key}": values for name, found in runs.items() for key, values in found.items()}
    )


if __name__ == "__main__":
    main("cuda" if sys.argv[1] == "cuda" else "cpu", sys.argv[2])
