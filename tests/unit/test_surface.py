"""The surface motion: what its schema refuses, and that both ways of writing it give the same file back."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from wrinklewave import surface as surfaces
from wrinklewave.errors import InputError
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

ATTRS = {"kind": "measurement", "name": "made up", "length": 0.05}


def made() -> xr.Dataset:
    return TravellingPulse(end_time=1e-4, interval=20e-6, pixel=1e-3, n_points=7).surface()


def reversed_along(axis: str) -> Callable[[xr.Dataset], xr.Dataset]:
    return lambda surface: surface.isel({axis: slice(None, None, -1)})


def standing_still(axis: str) -> Callable[[xr.Dataset], xr.Dataset]:
    return lambda surface: surface.isel({axis: [0, 1, 1, 2]})


def with_attrs(**attrs: object) -> Callable[[xr.Dataset], xr.Dataset]:
    return lambda surface: surface.assign_attrs(attrs)


def in_millimetres(surface: xr.Dataset) -> xr.Dataset:
    surface["y"].attrs["units"] = "mm"
    return surface


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda surface: surface.drop_vars("x_p"), "no variable 'x_p'"),
        (lambda surface: surface.assign(u_y=surface["u_y"].T), "has dimensions"),
        (in_millimetres, "has units 'mm'"),
        (reversed_along("time"), "time.*does not increase"),
        (reversed_along("x"), "x.*does not increase"),
        (standing_still("time"), "time.*does not increase"),
        (standing_still("x"), "x.*does not increase"),
        (with_attrs(kind="dream"), "kind is 'dream'"),
        (with_attrs(length=0.0), "no undeformed length"),
        (with_attrs(length=-1.0), "no undeformed length"),
    ],
)
def test_what_breaks_the_schema_is_refused(
    change: Callable[[xr.Dataset], xr.Dataset], message: str, tmp_path: Path
) -> None:
    broken = change(made())
    with pytest.raises(InputError, match=f"(?s){message}"):
        surfaces.write(broken, tmp_path / "surface.nc")
    broken.to_netcdf(tmp_path / "by_hand.nc", engine="h5netcdf")
    with pytest.raises(InputError, match=r"by_hand\.nc"):
        surfaces.read(tmp_path / "by_hand.nc")
    assert [file.name for file in tmp_path.iterdir()] == ["by_hand.nc"]


def test_a_single_time_is_a_surface_motion() -> None:
    assert surfaces.check(made().isel(time=[0])).sizes["time"] == 1


def test_a_surface_motion_reads_back_as_it_was(tmp_path: Path) -> None:
    surface = made()
    xr.testing.assert_identical(surfaces.read(surfaces.write(surface, tmp_path / "surface.nc")), surface)
    xr.testing.assert_identical(surfaces.read(tmp_path), surface)  # the folder of a run


def test_a_file_written_in_pieces_is_the_same_as_one_written_at_once(tmp_path: Path) -> None:
    whole = made()
    axes = {name: whole[name].values for name in ("time", "x", "X")}
    with surfaces.SurfaceFile(tmp_path / "pieces.nc", **axes, attrs=whole.attrs) as file:
        for first, stop in ((0, 2), (2, 6)):
            for name in whole.data_vars:
                file.write(str(name), whole[name].values[first:stop], first)
        assert not (tmp_path / "pieces.nc").exists()
    xr.testing.assert_identical(surfaces.read(tmp_path / "pieces.nc"), whole)


def test_what_was_not_written_is_unknown_and_a_failure_leaves_no_file(tmp_path: Path) -> None:
    axes = {"time": np.arange(3.0), "x": np.arange(2.0), "X": np.arange(1.0)}

    def written(name: str) -> None:
        with surfaces.SurfaceFile(tmp_path / "surface.nc", **axes, attrs=ATTRS) as file:
            for required in surfaces.REQUIRED:
                size = [np.size(axes[{"point": "X"}.get(d, d)]) for d in surfaces.DIMENSIONS[required]]
                file.write(required, np.ones((1, *size[1:])), first=1)
            file.write(name, np.ones((1, 2)))

    with pytest.raises(InputError, match="unknown variable 'height'"):
        written("height")
    assert not (tmp_path / "surface.nc").exists()
    written("u_y_sigma")
    np.testing.assert_array_equal(surfaces.read(tmp_path)["x_boundary"], [np.nan, 1.0, np.nan])
