"""Surface motion: the labelled dataset in which every experiment and every simulation ends.

Dimensions ``time``, ``x`` (a fixed laboratory grid) and ``point`` (material points: mesh nodes of the surface, or
probe wires). SI units, each named in the variable's ``units`` attribute. NaN where nothing was detected or outside
the sample. ``x`` points from the struck end (0 before impact) to the held end, ``y`` out of the sample.

============================  ===========  ====  ============================================================
variable                      dimensions   unit  meaning
============================  ===========  ====  ============================================================
``y``                         time, x      m     height of the visible surface, wrinkles included
``u_y``                       time, x      m     ``y`` minus its value in the undeformed state
``x_boundary``                time         m     position of the struck end at the surface
``x_p``, ``y_p``              time, point  m     positions of material points (without the wrinkle model)
``y_smooth``, ``u_y_smooth``  time, x      m     optional: the substrate's surface without wrinkles
``u_y_sigma``                 time, x      m     optional: standard uncertainty of ``u_y``
``strain_xx``                 time, point  1     optional: depth-averaged nominal strain, compression > 0
``strain_rate_xx``            time, point  1/s   optional: depth-averaged rate of the same
``stress_xx``                 time, point  Pa    optional: depth-averaged nominal stress, compression > 0
``amplitude``                 time, point  m     optional: wrinkle amplitude that a model gives
============================  ===========  ====  ============================================================

Coordinates: ``time`` [s], ``x`` [m], ``X`` (point) [m]: the material points' undeformed positions. Attributes:
``kind`` ("simulation" or "measurement"), ``name``, ``length`` [m] (undeformed), and what else its maker records.
"""

from __future__ import annotations

from pathlib import Path
from types import TracebackType
from typing import TYPE_CHECKING, Any, Self

import numpy as np

from wrinklewave.errors import InputError

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import ArrayLike

DIMENSIONS = {
    "y": ("time", "x"),
    "u_y": ("time", "x"),
    "x_boundary": ("time",),
    "x_p": ("time", "point"),
    "y_p": ("time", "point"),
    "y_smooth": ("time", "x"),
    "u_y_smooth": ("time", "x"),
    "u_y_sigma": ("time", "x"),
    "strain_xx": ("time", "point"),
    "strain_rate_xx": ("time", "point"),
    "stress_xx": ("time", "point"),
    "amplitude": ("time", "point"),
}
UNITS = dict.fromkeys(DIMENSIONS, "m") | {"strain_xx": "1", "strain_rate_xx": "1/s", "stress_xx": "Pa"}
REQUIRED = ("y", "u_y", "x_boundary", "x_p", "y_p")
KINDS = ("simulation", "measurement")


def surface_motion(
    *, time: ArrayLike, x: ArrayLike, X: ArrayLike, attrs: dict[str, Any], **variables: ArrayLike
) -> xr.Dataset:
    """Build and check a surface motion.

    Args:
        time: shape [n_times], seconds, increasing.
        x: laboratory grid, shape [n_x], metres, increasing.
        X: undeformed positions of the material points, shape [n_points], metres.
        attrs: at least ``kind``, ``name`` and ``length``.
        variables: arrays named and shaped as in the module's table.

    Raises:
        InputError: if the dataset breaks the schema.
    """
    import xarray as xr

    data_vars = {
        name: (DIMENSIONS[name], np.asarray(values), {"units": UNITS[name]})
        for name, values in variables.items()
        if _known(name)
    }
    coords = {
        "time": ("time", np.asarray(time, dtype=float), {"units": "s"}),
        "x": ("x", np.asarray(x, dtype=float), {"units": "m"}),
        "X": ("point", np.asarray(X, dtype=float), {"units": "m"}),
    }
    return check(xr.Dataset(data_vars, coords=coords, attrs=attrs))


def check(surface: xr.Dataset, *, source: object = "surface motion") -> xr.Dataset:
    """Return ``surface`` unchanged if it keeps the schema.

    Raises:
        InputError: naming the variable that is missing, or has other dimensions or units than the schema's.
    """
    for name in (*REQUIRED, "X"):
        if name not in surface.variables:
            raise InputError(
                f"no variable {name!r}", file=source, expected=f"a surface motion with {', '.join(REQUIRED)}"
            )
    for name in (known for known in DIMENSIONS if known in surface):
        dims, units = surface[name].dims, surface[name].attrs.get("units")
        if dims != DIMENSIONS[name]:
            raise InputError(f"has dimensions {dims}", file=source, key=name, expected=str(DIMENSIONS[name]))
        if units != UNITS[name]:
            raise InputError(f"has units {units!r}", file=source, key=name, expected=UNITS[name])
    for axis in ("time", "x"):
        if surface[axis].size > 1 and not (np.diff(surface[axis].values) > 0).all():
            raise InputError("does not increase", file=source, key=axis, expected="increasing values")
    if surface.attrs.get("kind") not in KINDS:
        raise InputError(
            f"kind is {surface.attrs.get('kind')!r}", file=source, key="kind", expected=" or ".join(KINDS)
        )
    if not float(surface.attrs.get("length", 0)) > 0:
        raise InputError(
            "no undeformed length", file=source, key="length", expected="a positive number of metres"
        )
    return surface


def write(surface: xr.Dataset, path: str | Path) -> Path:
    """Write as NetCDF-4, atomically: the file appears whole or not at all."""
    target = Path(path)
    partial = target.with_name(target.name + ".part")
    check(surface).to_netcdf(partial, engine="h5netcdf", invalid_netcdf=False)
    partial.replace(target)
    return target


class SurfaceFile:
    """A surface motion that is written a few times at a time, so that it need never be in memory as a whole.

    A context: the file appears under its name when all has been written, or not at all.

    Args:
        path: of the file.
        time, x, X, attrs: as in :func:`surface_motion`.
    """

    def __init__(
        self, path: str | Path, *, time: ArrayLike, x: ArrayLike, X: ArrayLike, attrs: dict[str, Any]
    ) -> None:
        import h5netcdf

        self.path = Path(path)
        self._partial = self.path.with_name(self.path.name + ".part")
        self._file = h5netcdf.File(self._partial, "w")
        axes = {"time": ("time", time, "s"), "x": ("x", x, "m"), "X": ("point", X, "m")}
        self._file.dimensions = {dimension: np.size(values) for dimension, values, _ in axes.values()}
        for name, (dimension, values, unit) in axes.items():
            self._create(name, (dimension,), unit)[:] = np.asarray(values, dtype=float)
        self._file.attrs.update(attrs)

    def write(self, name: str, values: ArrayLike, first: int = 0) -> None:
        """Write values of a variable from the time with number ``first`` on, shaped as in the module's table."""
        _known(name)
        values = np.asarray(values, dtype=float)
        if name not in self._file.variables:
            self._create(name, DIMENSIONS[name], UNITS[name])
        self._file.variables[name][first : first + values.shape[0]] = values

    def _create(self, name: str, dimensions: tuple[str, ...], unit: str) -> Any:
        variable = self._file.create_variable(name, dimensions, "f8", fillvalue=np.nan)
        variable.attrs["units"] = unit
        if "point" in dimensions and name != "X":
            variable.attrs["coordinates"] = "X"
        return variable

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._file.close()
        if error is None:
            self._partial.replace(self.path)


def read(path: str | Path) -> xr.Dataset:
    """Read a surface motion into memory, from its file or from the folder of a run that holds ``surface.nc``.

    Raises:
        InputError: if the file is missing, is no NetCDF-4 file, or breaks the schema.
    """
    import xarray as xr

    file = Path(path) / "surface.nc" if Path(path).is_dir() else Path(path)
    if not file.exists():
        raise InputError(
            "no such file", file=file, cure="give a surface.nc, or the folder of a run that holds one"
        )
    try:
        surface = xr.load_dataset(file, engine="h5netcdf")
    except (OSError, ValueError) as error:
        raise InputError(
            f"cannot be read ({error})", file=file, expected="a NetCDF-4 surface motion"
        ) from error
    return check(surface, source=file)


def _known(name: str) -> bool:
    if name not in DIMENSIONS:
        raise InputError(f"unknown variable {name!r}", key=name, expected=", ".join(DIMENSIONS))
    return True
