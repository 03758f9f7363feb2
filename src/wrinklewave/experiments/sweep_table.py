"""Results of a sweep as one labelled dataset, and as a table with one row per run."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.config import Case
    from wrinklewave.experiments.sweep import Member

Axis = tuple[str, tuple[str, ...]]


def write_tables(
    out: Path, axes: Sequence[Axis], runs: Sequence[tuple[Member, dict[str, Any]]]
) -> xr.Dataset:
    """Write ``sweep.nc`` and ``sweep.csv``, and return the dataset.

    Args:
        out: folder.
        axes: keys and values that the sweep goes over.
        runs: of every combination, with the scalar results; empty if it has not ended.
    """
    out.mkdir(parents=True, exist_ok=True)
    table = as_dataset(axes, runs)
    for name, write in (("sweep.nc", _write_netcdf), ("sweep.csv", _write_csv)):
        partial = out / f"{name}.part"
        write(partial, table, runs)
        partial.replace(out / name)
    return table


def as_dataset(axes: Sequence[Axis], runs: Sequence[tuple[Member, dict[str, Any]]]) -> xr.Dataset:
    """One dimension per axis; its coordinate is in SI units, or as it was given if it is no number."""
    import xarray as xr

    shape, dims = tuple(len(values) for _, values in axes), tuple(key for key, _ in axes)
    coordinates = {
        key: [_value(member.case, key, member.overrides[axis]) for member, _ in _along(runs, axis)]
        for axis, key in enumerate(dims)
    }
    names = dict.fromkeys(name for _, summary in runs for name, value in summary.items() if _is_number(value))
    variables: dict[str, Any] = {
        name: (dims, np.array([summary.get(name, np.nan) for _, summary in runs], dtype=float).reshape(shape))
        for name in names
    }
    outcome = np.array([summary.get("outcome", "not run") for _, summary in runs], dtype=object)
    folder = np.array([f"runs/{member.folder.name}" for member, _ in runs], dtype=object)
    variables |= {"outcome": (dims, outcome.reshape(shape)), "folder": (dims, folder.reshape(shape))}
    return xr.Dataset(variables, coordinates)


def _along(runs: Sequence[tuple[Member, dict[str, Any]]], axis: int) -> list[tuple[Member, dict[str, Any]]]:
    """The runs along one axis, at the beginning of all others."""
    return [run for run in runs if not any(k for n, k in enumerate(run[0].place) if n != axis)]


def _value(case: Case, key: str, override: str) -> Any:
    """What a case has at a dotted key, if that is a number; else what was asked for."""
    found: Any = case.model_dump(mode="python")
    for part in key.split("."):
        found = found[int(part)] if isinstance(found, list | tuple) else found.get(part)
        if found is None:
            break
    return float(found) if _is_number(found) else override.partition("=")[2]


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)


def _write_netcdf(path: Path, table: xr.Dataset, runs: object) -> None:
    table.to_netcdf(path, engine="h5netcdf")


def _write_csv(path: Path, table: xr.Dataset, runs: Sequence[tuple[Member, dict[str, Any]]]) -> None:
    keys, names = list(table.dims), list(table.data_vars)
    with path.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow([*keys, *names])
        for member, _ in runs:
            row = table.isel(dict(zip(keys, member.place, strict=True)))
            writer.writerow([*(row[name].item() for name in (*keys, *names))])
