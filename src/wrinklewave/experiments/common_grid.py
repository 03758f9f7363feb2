"""Surface motions on one clock and one grid, so that they can be subtracted from each other."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.boundary import contact_time, moved
from wrinklewave.errors import InputError
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr

FEWEST_SAMPLES = 4


@dataclass(frozen=True, eq=False)
class CommonGrid:
    """Times [s], shape [n_times], and positions [m], shape [n_x], that all surface motions have in common."""

    time: Array
    x: Array


def contact_times(surfaces: Mapping[str, xr.Dataset]) -> tuple[float, ...]:
    """When the struck end of each has moved by 50 um, on its own clock [s]; NaN where it never does."""
    return tuple(
        contact_time(surface["time"].values, moved(surface["x_boundary"].values))
        for surface in surfaces.values()
    )


def on_one_clock(surfaces: Mapping[str, xr.Dataset]) -> dict[str, xr.Dataset]:
    """The surface motions with their clocks set so that all make contact when the first one does.

    Where one of them shows no contact all clocks stay as they are.
    """
    contacts = np.array(contact_times(surfaces))
    shifts = contacts[0] - contacts if np.isfinite(contacts).all() else np.zeros(contacts.size)
    pairs = zip(surfaces.items(), shifts, strict=True)
    return {
        name: surface.assign_coords(time=surface["time"] + shift).assign_attrs(clock_shift=float(shift))
        for (name, surface), shift in pairs
    }


def common_grid(surfaces: Mapping[str, xr.Dataset]) -> CommonGrid:
    """Where all surface motions overlap, as finely as the coarsest of them.

    Raises:
        InputError: if they share no time or no positions, with the range of each.
    """
    axes = {
        key: {name: np.asarray(surface[key].values, dtype=float) for name, surface in surfaces.items()}
        for key in ("time", "x")
    }
    return CommonGrid(_overlap(axes["time"], "time", "ms"), _overlap(axes["x"], "x", "mm"))


def cropped(surface: xr.Dataset, grid: CommonGrid) -> xr.Dataset:
    """The part of a surface motion that the common grid lies in, to the next sample on either side."""
    return surface.isel(
        time=_around(surface["time"].values, grid.time), x=_around(surface["x"].values, grid.x)
    )


def resample(field: Array, time: Array, x: Array, grid: CommonGrid) -> Array:
    """A field on the common grid, linear in time and in x; NaN beside unknown values.

    Args:
        field: shape [n_times, n_x].
        time, x: where its values are [s], [m], increasing.
    """
    in_time = resample_rows(field, time, grid.time)
    columns, shares = _neighbours(x, grid.x)
    return _between(in_time[:, columns], in_time[:, columns + 1], shares[None, :])


def resample_rows(values: Array, time: Array, new_times: Array) -> Array:
    """Values at new times, linear along their first axis; NaN beside unknown values and outside."""
    rows, shares = _neighbours(time, new_times)
    return _between(values[rows], values[rows + 1], shares.reshape(-1, *[1] * (values.ndim - 1)))


def _neighbours(places: Array, wanted: Array) -> tuple[np.ndarray, Array]:
    before = np.clip(np.searchsorted(places, wanted, side="right") - 1, 0, places.size - 2)
    return before, (wanted - places[before]) / (places[before + 1] - places[before])


def _between(before: Array, after: Array, shares: Array) -> Array:
    """Linear interpolation in which a neighbour without a share cannot spoil the value."""
    tiny = 1e-9
    return np.where(
        shares <= tiny, before, np.where(shares >= 1 - tiny, after, (1 - shares) * before + shares * after)
    )


def _around(axis: Array, wanted: Array) -> slice:
    tolerance = 1e-6 * (wanted[1] - wanted[0])
    first = int(np.searchsorted(axis, wanted[0] + tolerance, side="right")) - 1
    last = int(np.searchsorted(axis, wanted[-1] - tolerance, side="left"))
    return slice(max(first, 0), last + 1)


def _overlap(axes: Mapping[str, Array], key: str, unit: str) -> Array:
    start, stop = max(axis[0] for axis in axes.values()), min(axis[-1] for axis in axes.values())
    step = max(float(np.median(np.diff(axis))) for axis in axes.values())
    n = int(np.floor((stop - start) / step * (1 + 1e-9) + 1e-9)) + 1 if stop > start else 0
    if n < FEWEST_SAMPLES:
        raise InputError(
            f"the surface motions share {'less than four samples' if n else 'nothing'}: {_ranges(axes, unit)}",
            key=key,
            expected="ranges that overlap",
            cure="compare surface motions of the same stretch, with contact at time 0 and the struck end at x = 0",
        )
    return start + step * np.arange(n)


def _ranges(axes: Mapping[str, Array], unit: str) -> str:
    return "; ".join(
        f"{name} {1e3 * axis[0]:.4g} to {1e3 * axis[-1]:.4g} {unit}" for name, axis in axes.items()
    )
