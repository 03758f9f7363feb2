"""The state of a run on disk: written atomically, read back bit for bit."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import h5py
import numpy as np

from wrinklewave._version import __version__
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

    from numpy.typing import NDArray

    from wrinklewave.dynamics.simulation import Simulation

STATE = ("u", "w", "vx", "vy", "factors")
WHOLE = ("next_event", "step", "updates", "last_step", "patience")
COUNTERS = (*WHOLE, "dt", "first_dt", "last_dt", "largest_dt", "power_time", "stepping_seconds")
START_AGAIN = "start again: wrinklewave simulate CASE --overwrite"
SUMS = ("counts", "totals", "work", "power")


@dataclass(frozen=True, eq=False)
class Record:
    """What a checkpoint keeps beside the state: the outputs gathered so far, by name."""

    arrays: dict[str, NDArray[np.float64]]


def write_checkpoint(path: Path, simulation: Simulation, record: Record, case_text: str) -> None:
    """Write everything that :func:`read_checkpoint` needs; the file appears whole or not at all."""
    simulation.backend.fetch_all()
    partial = path.with_name(path.name + ".part")
    with h5py.File(partial, "w") as file:
        file.attrs.update(version=__version__, case=case_text)
        for name in COUNTERS:
            file.attrs[name] = getattr(simulation, name)
        for name in SUMS:
            file[f"sums/{name}"] = getattr(simulation, name)
        for name in STATE:
            file[f"state/{name}"] = getattr(simulation.model.arrays, name)
        file["state/memory"] = simulation.model.memory
        if simulation.model.row_steps is not None:
            for name, values in simulation.model.row_steps._asdict().items():
                file[f"row_steps/{name}"] = values
        file["history"] = np.array(simulation.history, dtype=float)
        for name, values in record.arrays.items():
            file[f"record/{name}"] = values
    partial.replace(path)


def read_checkpoint(path: Path, simulation: Simulation, case_text: str) -> Record:
    """Bring ``simulation`` (freshly built from the same case) to the checkpoint's state; returns the record.

    Raises:
        InputError: if the file cannot be read, or belongs to another case or version.
    """
    try:
        file = h5py.File(path, "r")
    except OSError as error:
        raise InputError(f"cannot be read ({error})", file=path, cure=START_AGAIN) from error
    with file:
        if file.attrs.get("version") != __version__ or file.attrs.get("case") != case_text:
            raise InputError(
                "is the checkpoint of another case or version of wrinklewave",
                file=path,
                expected="the case that the run was started with",
                cure="give the same case and --set values, or start again with --overwrite",
            )
        try:
            return _restore(file, simulation)
        except (KeyError, OSError) as error:
            raise InputError(f"is damaged ({error})", file=path, cure=START_AGAIN) from error


def _restore(file: h5py.File, simulation: Simulation) -> Record:
    for name in COUNTERS:
        value = file.attrs[name]
        setattr(simulation, name, int(value) if name in WHOLE else float(value))
    for name in SUMS:
        getattr(simulation, name)[:] = file[f"sums/{name}"][()]
    for name in STATE:
        getattr(simulation.model.arrays, name)[:] = file[f"state/{name}"][()]
    simulation.model.memory[:] = file["state/memory"][()]
    if simulation.model.row_steps is not None:
        for name, values in simulation.model.row_steps._asdict().items():
            values[:] = file[f"row_steps/{name}"][()]
    simulation.history = [tuple(row) for row in file["history"][()]]
    return Record({name: values[()] for name, values in file["record"].items()})
