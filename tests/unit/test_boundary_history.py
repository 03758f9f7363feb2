"""The motion of the struck end as a drive: read off a surface motion, and put back into a simulation."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr

from wrinklewave.config import Case, case_from_text, load_case
from wrinklewave.config.writing import toml_text
from wrinklewave.errors import InputError
from wrinklewave.experiments.boundary_history import boundary_columns
from wrinklewave.experiments.simulate import simulate
from wrinklewave.surface import surface_motion

EXAMPLES = Path(__file__).parents[2] / "examples"


def tilted(time: np.ndarray, X: tuple[float, ...]) -> xr.Dataset:
    """A surface that slopes, 0.1 up for 1 along, rises at 1 m/s and is pushed at 2 m/s from time 0 on."""
    own = np.maximum(time, 0.0)[:, None]
    x, end = np.arange(0.0, 10e-3, 0.05e-3), 2.0 * own[:, 0]
    u_y = own + 0.1 * x
    u_y[x < end[:, None]] = np.nan
    x_p = np.tile(X, (time.size, 1))
    attrs = {"kind": "measurement", "name": "tilted", "length": 0.01}
    y_p = own + 0.1 * end[:, None] + 0 * x_p
    return surface_motion(time=time, x=x, X=X, attrs=attrs, y=u_y, u_y=u_y, x_boundary=end, x_p=x_p, y_p=y_p)


@pytest.mark.parametrize("X", [(0.0, 4e-3), (4e-3,)], ids=["corner followed", "corner from the surface"])
def test_history_starts_at_contact_and_counts_from_rest(X: tuple[float, ...]) -> None:
    time = np.arange(-5, 50) * 20e-6
    surface = tilted(time, X)
    surface["x_boundary"][20:24] = np.nan
    surface["u_y"][20:24] = np.nan
    found = boundary_columns(surface)
    t = found["time_s"]
    assert (t[0], t.size) == (0.0, 50)
    np.testing.assert_allclose(found["u_x_m"], 2.0 * t, atol=1e-12)
    np.testing.assert_allclose(found["u_y_m"], (1.0 + 0.2) * t, atol=1e-9)


@pytest.mark.parametrize(("phase", "curvature"), [(0.0, 0.0), (1.0, 0.0), (2.5, 3.0)])
def test_a_wrinkle_at_the_corner_is_no_motion_of_the_end(phase: float, curvature: float) -> None:
    time = np.arange(-5, 50) * 20e-6
    surface = tilted(time, (4e-3,))
    surface.attrs["critical_wavelength"] = 2e-3
    distance = (surface["x"] - surface["x_boundary"]).transpose("time", "x").values
    crest = 0.2e-3 * np.cos(2 * np.pi * distance / 1.78e-3 + phase) + curvature * distance**2
    for name in ("y", "u_y"):
        surface[name].values += np.where(time[:, None] > 0.0, crest, 0.0)
    found = boundary_columns(surface)
    np.testing.assert_allclose(found["u_y_m"], 1.2 * found["time_s"], atol=0.01e-3)


def test_a_curved_surface_is_continued_by_the_slope_that_it_has_at_the_end() -> None:
    """A straight line through half a millimetre misses 3/m x^2 by a sixth of 3/m (0.5 mm)^2, and grid points."""
    surface = tilted(np.arange(-5, 50) * 20e-6, (4e-3,))
    distance = (surface["x"] - surface["x_boundary"]).transpose("time", "x").values
    surface["u_y"].values += np.where(surface["time"].values[:, None] > 0.0, 3.0 * distance**2, 0.0)
    found = boundary_columns(surface)
    np.testing.assert_allclose(found["u_y_m"], 1.2 * found["time_s"], atol=0.25e-6)


def test_without_a_time_of_rest_the_first_place_seen_counts() -> None:
    surface = tilted(np.arange(0, 50) * 20e-6, (0.0, 4e-3))
    surface["x_boundary"][:3] = np.nan
    found = boundary_columns(surface)
    np.testing.assert_allclose(found["u_x_m"], np.maximum(2.0 * (found["time_s"] - 60e-6), 0.0), atol=1e-12)


def test_history_starts_at_a_contact_between_frames() -> None:
    time = (np.arange(-5, 50) + 0.3) * 20e-6
    surface = tilted(time, (4e-3,))
    surface["u_y"][2:9] = np.nan  # the corner is out of sight around contact
    found = boundary_columns(surface)
    assert [found[name][0] for name in ("time_s", "u_x_m", "u_y_m")] == [0.0, 0.0, 0.0]
    np.testing.assert_allclose(found["u_x_m"], 2.0 * found["time_s"], atol=1e-12)
    np.testing.assert_allclose(found["u_y_m"], 1.2 * found["time_s"], atol=1e-9)


def test_an_end_out_of_sight_drives_nothing() -> None:
    surface = tilted(np.arange(10) * 20e-6, (0.0,))
    surface["x_boundary"][:] = np.nan
    with pytest.raises(InputError, match="seen at 0 times"):
        boundary_columns(surface)


def coarse_paper(drive: dict[str, Any] | None = None) -> Case:
    """The paper's case for 1.4 ms on a coarse mesh, long enough for the front to pass the window."""
    changes = ("mesh.elements=[60, 22]", "solver.end_time=1.4 ms", 'analysis.times=["0.5 ms"]')
    tables = tomllib.loads(load_case(EXAMPLES / "paper_impact.toml", changes).to_toml())
    return case_from_text(toml_text({**tables, "drive": drive or tables["drive"]}))


HELD_END = {
    "kind": "end-motion",
    "velocity": "10 m/s",
    "stop_distance": "6.3 mm",
    "overshoot": "9 mm",
    "overshoot_time": "1 ms",
    "smoothing": "0.1 ms",
    "transverse": "held",
}
SPEEDS = ("wavefront_speed_m_per_s", "wrinkle_speed_m_per_s")


@pytest.mark.parametrize(
    ("drive", "names", "tolerance"),
    [
        # the end's nodes stay at their height, which is linear: the history says everything but what happens
        # between its samples, 10 us apart
        (HELD_END, (*SPEEDS, "displacement_max_m", "wrinkle_amplitude_max_m"), 0.002),
        (None, SPEEDS, 0.02),  # a striker lets the end bulge, which a line from corner to axis does not
    ],
    ids=["held end", "striker"],
)
def test_a_run_repeated_from_its_boundary_history(
    tmp_path: Path, drive: dict[str, Any] | None, names: tuple[str, ...], tolerance: float
) -> None:
    first = simulate(coarse_paper(drive), out=tmp_path / "run")
    again = simulate(coarse_paper({"kind": "history", "file": str(tmp_path / "run" / "boundary.csv")}))
    assert first.surface is not None
    assert again.surface is not None
    ends = [run.surface["x_boundary"].values for run in (first, again)]  # type: ignore[index]
    np.testing.assert_allclose(*ends, atol=1e-9)
    for name in names:
        assert again.summary[name] == pytest.approx(first.summary[name], rel=tolerance), name
