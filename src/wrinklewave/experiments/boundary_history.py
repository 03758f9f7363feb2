"""The motion of the struck end, taken from a surface motion to drive a simulation: the paper's way."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr

CORNER_STRETCH = 0.5e-3
"""Where no material point marks the corner, a line through this stretch of surface leads to it [m]."""
FEWEST_HEIGHTS = 4
CORNER_WAVELENGTHS = 3.0
"""With a film: the surface without wrinkles is told from them over so many critical wavelengths."""
TRIED_WAVELENGTHS = np.linspace(0.75, 1.05, 25)
"""Of the wrinkles there, over the critical one: compressed, for the most part."""


def boundary_columns(surface: xr.Dataset) -> dict[str, Array]:
    """Displacement of the struck end and of its top corner, from time 0 (contact, until when it rests) on.

    Displacements count from the mean place before contact, or from the first one where the motion starts at
    contact. The corner is the material point X = 0 where the surface motion follows it. Otherwise the height of
    the surface is continued to the struck end: in a straight line through its first half millimetre, or, if the
    surface motion names its film, by a parabola through three critical wavelengths, fitted together with a
    wrinkle of the wavelength that fits best. (A wrinkle's crest at the end is no motion of the substrate: it
    would be driven 0.3 mm too high in the paper's impact.) Gaps are bridged linearly in time. Nothing is
    smoothed: ``drive.smoothing`` does that.

    Returns:
        Columns ``time_s``, ``u_x_m`` and ``u_y_m`` of a file for ``drive.kind = "history"``.

    Raises:
        InputError: if the struck end is seen at fewer than two times from contact on.
    """
    time = np.asarray(surface["time"].values, dtype=float)
    u_x = _from_rest(time, np.asarray(surface["x_boundary"].values, dtype=float))
    u_y = _from_rest(time, _corner_height(surface))
    seen = np.flatnonzero(np.isfinite(u_x) & (time >= 0.0))
    if seen.size < 2:
        raise InputError(
            f"the struck end is seen at {seen.size} times from contact on",
            file="surface motion",
            key="x_boundary",
            expected="two at least",
        )
    last = time[seen[-1]]
    contact = int(np.searchsorted(time, 0.0))
    if time[contact] > 0.0:  # contact lies between two frames: the end is at rest until then
        time, u_x, u_y = (np.insert(values, contact, 0.0) for values in (time, u_x, u_y))
    during = (time >= 0.0) & (time <= last)
    columns = {"time_s": time, "u_x_m": _bridged(time, u_x), "u_y_m": _bridged(time, u_y)}
    return {name: column[during] for name, column in columns.items()}


def _corner_height(surface: xr.Dataset) -> Array:
    """Height of the top corner of the struck end over its undeformed height [m], shape [n_times]."""
    X, x = surface["X"].values, surface["x"].values
    spacing = float(x[1] - x[0])
    corner = np.flatnonzero(np.abs(X) <= 0.5 * spacing)
    if corner.size:
        return np.asarray(surface["y_p"].values[:, corner[0]], dtype=float)
    heights, ends = surface["u_y"].values, surface["x_boundary"].values
    wavelength = surface.attrs.get("critical_wavelength")
    return np.array([_continued(x, row, end, wavelength) for row, end in zip(heights, ends, strict=True)])


def _continued(x: Array, height: Array, end: float, wavelength: float | None) -> float:
    known = np.isfinite(height) & (x >= end)
    if wavelength is not None:
        reach = CORNER_WAVELENGTHS * wavelength
        near = np.flatnonzero(known & (x <= end + reach))
        if near.size > 0.75 * reach / (x[1] - x[0]):
            return _without_wrinkles(x[near] - end, height[near], wavelength)
    near = np.flatnonzero(known & (x <= end + CORNER_STRETCH))
    if near.size < FEWEST_HEIGHTS:
        return float("nan")
    return float(np.polyfit(x[near] - end, height[near], 1)[1])


def _without_wrinkles(distance: Array, height: Array, wavelength: float) -> float:
    """Height at distance 0 of the parabola under wrinkles of a wavelength near the critical one."""
    shares = distance / distance[-1]
    parabola = [np.ones_like(shares), shares, shares**2]
    fits = []
    for tried in wavelength * TRIED_WAVELENGTHS:
        phase = 2 * np.pi * distance / tried
        terms = np.stack([*parabola, np.cos(phase), np.sin(phase)], axis=1)
        coefficients = np.linalg.lstsq(terms, height, rcond=None)[0]
        residual = height - terms @ coefficients
        fits.append((float(residual @ residual), float(coefficients[0])))
    return min(fits)[1]


def _from_rest(time: Array, position: Array) -> Array:
    known = np.isfinite(position)
    resting = known & (time < 0.0)
    if resting.any():
        return position - position[resting].mean()
    return position - position[known.argmax()]


def _bridged(time: Array, values: Array) -> Array:
    known = np.isfinite(values)
    return np.interp(time, time[known], values[known]) if known.any() else np.zeros_like(values)
