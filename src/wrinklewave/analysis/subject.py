"""What is analysed, and with which parameters."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr

SOURCE = "surface motion"
OPTIONAL_VARIABLES = ("strain_xx", "strain_rate_xx", "stress_xx", "u_y_sigma")
OPTIONAL_ATTRIBUTES = ("critical_strain", "critical_wavelength", "plane_strain_modulus", "stop_distance")


class Settings(Protocol):
    """Parameters of the analysis, as in the case file's section of the same name; lengths in metres."""

    @property
    def front_fraction(self) -> float: ...
    @property
    def front_window(self) -> tuple[float, float]: ...
    @property
    def wrinkle_threshold(self) -> float: ...
    @property
    def filter_wavelength(self) -> float: ...
    @property
    def amplitude_window(self) -> tuple[float, float]: ...
    @property
    def positions(self) -> tuple[float, ...]: ...


@dataclass(frozen=True)
class Subject:
    """A surface motion as plain arrays, named and shaped as in its schema, and what its maker recorded beside
    it.

    Attributes:
        kind, name: "simulation" or "measurement", and what it is called.
        critical_strain, critical_wavelength: eps_c [1] and lambda_c [m] of the film.
        plane_strain_modulus: of the substrate in the long term, E_0 / (1 - nu^2) [Pa].
        stop_distance: travel of the striker to its stoppers [m].
    """

    kind: str
    name: str
    time: Array
    x: Array
    X: Array
    x_p: Array
    y_p: Array
    y: Array
    u_y: Array
    x_boundary: Array
    strain_xx: Array | None
    strain_rate_xx: Array | None
    stress_xx: Array | None
    u_y_sigma: Array | None
    length: float
    critical_strain: float | None
    critical_wavelength: float | None
    plane_strain_modulus: float | None
    stop_distance: float | None

    @property
    def pixel(self) -> float:
        """Spacing of the laboratory grid [m]."""
        return float(self.x[1] - self.x[0])


def subject_of(surface: xr.Dataset) -> Subject:
    """Take a surface motion apart.

    Raises:
        InputError: if there are fewer than four times or positions, or the laboratory grid is uneven.
    """
    names = ("time", "x", "X", "x_p", "y_p", "y", "u_y", "x_boundary")
    required = {name: np.asarray(surface[name].values, dtype=float) for name in names}
    for axis in ("time", "x"):
        if required[axis].size < 4:
            raise InputError(f"{required[axis].size} values", file=SOURCE, key=axis, expected="at least four")
    _check_even(required["x"])
    optional = {name: _array(surface, name) for name in OPTIONAL_VARIABLES}
    attributes = {name: _number(surface, name) for name in OPTIONAL_ATTRIBUTES}
    labels = {name: str(surface.attrs.get(name, "")) for name in ("kind", "name")}
    length = float(surface.attrs["length"])
    return Subject(**labels, **required, **optional, length=length, **attributes)  # type: ignore[arg-type]


def _array(surface: xr.Dataset, name: str) -> Array | None:
    return np.asarray(surface[name].values, dtype=float) if name in surface else None


def _number(surface: xr.Dataset, name: str) -> float | None:
    return float(surface.attrs[name]) if name in surface.attrs else None


def _check_even(x: Array) -> None:
    steps = np.diff(x)
    if np.ptp(steps) > 1e-3 * steps.mean():
        raise InputError(
            f"steps between {steps.min():g} and {steps.max():g}",
            file=SOURCE,
            key="x",
            expected="even spacing",
            cure="resample the surface motion to an even grid",
        )
