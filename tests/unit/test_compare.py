"""Comparing surface motions: made surfaces of known speed, amplitude and wavelength, on other clocks and grids."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave import surface as surfaces
from wrinklewave.config import load_case
from wrinklewave.config.recorded import recorded_analysis
from wrinklewave.errors import InputError
from wrinklewave.experiments.common_grid import CommonGrid, resample
from wrinklewave.experiments.compare import Comparison, Quantity, compare
from wrinklewave.figures.side_by_side import COMPARISON_FIGURES, compared_inputs

QUICK = Path(__file__).parents[2] / "examples" / "quick.toml"
SPEED, WAVELENGTH, LENGTH = 50.0, 2e-3, 50e-3


def made(
    *,
    amplitude: float = 0.1e-3,
    late: float = 0.0,
    pixel: float = 0.1e-3,
    step: float = 10e-6,
    end: float = 0.8e-3,
    name: str = "made",
    pulse: float = 1e-3,
) -> xr.Dataset:
    """A front at SPEED with wrinkles behind it; the struck end moves at 5 m/s from time ``late``."""
    x = np.arange(0.0, LENGTH + pixel / 2, pixel)
    time = np.arange(0.0, end + step / 2, step)
    own = (time - late)[:, None]
    behind = 0.5 * (1 + np.tanh((SPEED * own - x) / 4e-3))
    u_y = (pulse + amplitude * np.sin(2 * np.pi * x / WAVELENGTH)) * behind
    x_boundary = np.maximum(5.0 * own[:, 0], 0.0)
    u_y[x < x_boundary[:, None]] = np.nan
    X = np.array([0.0, 0.5 * LENGTH])
    attrs: dict[str, Any] = {
        "kind": "measurement",
        "name": name,
        "length": LENGTH,
        "critical_wavelength": 2e-3,
    }
    x_p = np.maximum(X, x_boundary[:, None])
    return surfaces.surface_motion(
        time=time, x=x, X=X, attrs=attrs, y=u_y, u_y=u_y, x_boundary=x_boundary, x_p=x_p, y_p=0 * x_p
    )


def compared(*motions: xr.Dataset, overrides: tuple[str, ...] = ()) -> Comparison:
    named = {f"{number}": motion for number, motion in enumerate(motions)}
    return compare(named, recorded_analysis([motion.attrs for motion in motions], overrides))


def row(comparison: Comparison, name: str) -> Quantity:
    return next(quantity for quantity in comparison.quantities if quantity.name == name)


def test_a_motion_agrees_with_itself() -> None:
    found = compared(made(), made())
    assert found.agreements["1"].misfit_rms == 0.0
    ratios = [quantity.ratios[1] for quantity in found.quantities if quantity.ratios[1] is not None]
    assert len(ratios) > 10
    assert ratios == pytest.approx([1.0] * len(ratios))


def test_clocks_are_set_by_the_contact() -> None:
    late = 0.1234e-3
    found = compared(made(), made(late=late, end=1e-3))
    assert found.aligned
    assert found.motions["1"].clock_shift == pytest.approx(-late, abs=1e-8)
    # shifted by a fraction of the 10 us step: what is left is linear interpolation, h^2/8 max|u_tt|;
    # u_tt of the front is at most 0.385 pulse (SPEED / 4 mm)^2 = 6e4 m/s^2
    assert found.agreements["1"].misfit_rms < (10e-6) ** 2 / 8 * 6e4


def test_clocks_stay_where_one_shows_no_contact() -> None:
    still = made(late=0.1e-3)
    still["x_boundary"][:] = 0.0
    found = compared(made(), still)
    assert not found.aligned
    assert found.motions["1"].clock_shift == 0.0


def test_the_common_grid_is_the_coarsest_where_all_overlap() -> None:
    found = compared(made(end=0.7e-3), made(pixel=0.15e-3, step=20e-6))
    assert found.grid.time[-1] <= 0.7e-3 + 1e-12
    assert np.diff(found.grid.time) == pytest.approx(20e-6)
    assert np.diff(found.grid.x) == pytest.approx(0.15e-3)


def test_amplitude_and_misfit_are_what_was_made() -> None:
    found = compared(made(), made(amplitude=0.13e-3), made(pulse=1.05e-3))
    stronger, higher = found.agreements["1"], found.agreements["2"]
    assert stronger.amplitude.mean == pytest.approx(1.3, rel=1e-3)
    assert stronger.wavelength.mean == pytest.approx(1.0, rel=1e-6)
    assert stronger.misfit_rms < 0.1 * 0.03e-3  # at the ends a little of the added wrinkles passes the filter
    behind = np.nanmax(np.abs(higher.misfit))
    assert behind == pytest.approx(0.05 * 1e-3, rel=1e-3)
    assert row(found, "wrinkle_amplitude_ratio").values[1] == pytest.approx(1.3, rel=1e-3)
    assert row(found, "wavefront_speed_m_per_s").values == pytest.approx([SPEED] * 3, rel=0.02)


def test_misfit_is_stated_over_the_largest_displacement() -> None:
    """A pulse 5 % higher: the misfit is a twentieth of the first's displacement, wherever both are known."""
    agreement = compared(made(amplitude=0.0), made(amplitude=0.0, pulse=1.05e-3)).agreements["1"]
    rms = np.sqrt(np.nanmean(agreement.misfit**2))
    assert agreement.misfit_rms == pytest.approx(rms)
    assert agreement.misfit_share == pytest.approx(0.05 * rms / np.nanmax(np.abs(agreement.misfit)), rel=1e-6)
    assert agreement.compared_share == np.isfinite(agreement.misfit).mean()
    assert 0.9 < agreement.compared_share < 1.0  # not where the struck end has been


@given(
    st.floats(-1, 1),
    st.floats(-1, 1),
    st.lists(st.floats(0.0, 4.0), min_size=2, max_size=9, unique=True).map(sorted),
)
def test_resampling_keeps_what_is_bilinear(a: float, b: float, places: list[float]) -> None:
    time, x = np.arange(5.0), np.arange(5.0)
    field = 1.0 + a * time[:, None] + b * x + a * b * time[:, None] * x
    grid = CommonGrid(np.array(places), np.array(places))
    expected = 1.0 + a * grid.time[:, None] + b * grid.x + a * b * grid.time[:, None] * grid.x
    np.testing.assert_allclose(resample(field, time, x, grid), expected, atol=1e-8)


def test_unknown_values_spoil_only_what_lies_beside_them() -> None:
    field = np.ones((4, 4))
    field[1, 1] = np.nan
    axis = np.arange(4.0)
    found = resample(field, axis, axis, CommonGrid(axis, axis))
    assert np.array_equal(np.isnan(found), np.isnan(field))


def test_parameters_come_from_the_first_case_that_is_recorded() -> None:
    case = load_case(QUICK)
    attrs: dict[str, Any] = {"name": "quick", "length": 0.0504, "case": case.to_toml()}
    bare = {"name": "bare", "length": 0.05}
    assert recorded_analysis([attrs, bare]) == case.analysis
    assert recorded_analysis([bare, attrs]) == case.analysis
    assert recorded_analysis([attrs], ["analysis.front_fraction=0.2"]).front_fraction == 0.2
    assert recorded_analysis([bare]).front_window == pytest.approx((0.0125, 0.04))
    with pytest.raises(InputError, match="unknown key"):
        recorded_analysis([attrs], ["analysis.fraction=0.2"])


@pytest.mark.parametrize(
    ("other", "overrides", "message"),
    [
        (lambda: made().assign_coords(x=made().x + 1.0), (), "share nothing"),
        (
            lambda: made().isel(time=slice(0, 8)),
            ("analysis.amplitude_window=['70 mm', '80 mm']",),
            "hardly overlaps",
        ),
        (lambda: made(end=0.02e-3), (), "less than four samples"),
    ],
)
def test_what_cannot_be_compared_is_said(other: Any, overrides: tuple[str, ...], message: str) -> None:
    with pytest.raises(InputError, match=message):
        compared(made(), other(), overrides=overrides)


def test_one_motion_is_no_comparison() -> None:
    with pytest.raises(InputError, match="at least two"):
        compared(made())


def test_every_figure_is_drawn_without_material_points_or_wrinkles(tmp_path: Path) -> None:
    flat = made(amplitude=0.0).isel(point=slice(0, 0))
    inputs = compared_inputs(compared(made(), flat, made(), made()))
    files = COMPARISON_FIGURES.write(tmp_path, inputs, kinds={"measurement"})
    assert set(files) == set(COMPARISON_FIGURES)
    assert all(file.stat().st_size > 10_000 for file in files.values())


def test_names_are_written_as_they_are(tmp_path: Path) -> None:
    """To matplotlib a pair of dollars is a formula, and a label that begins with a low line is none."""
    comparison = compare({"$\\frac$": made(), "_b": made()}, recorded_analysis([made().attrs]))
    inputs = compared_inputs(comparison)
    assert len(COMPARISON_FIGURES.write(tmp_path, inputs, kinds={"measurement"})) == len(COMPARISON_FIGURES)
    curves = COMPARISON_FIGURES["side_2d_boundary"].draw(inputs).axes[0]
    assert curves.get_legend_handles_labels()[1] == [r"\$\frac\$", " _b"]


def test_compare_on_the_command_line(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from wrinklewave.cli.verbs.compare import compare as verb

    paths = [
        surfaces.write(made(name=name, late=1e-5 * i), tmp_path / f"{name}.nc") for i, name in enumerate("ab")
    ]
    out = tmp_path / "results"
    verb(paths, out=out)
    assert "wavefront speed" in capsys.readouterr().out
    table = json.loads((out / "comparison.json").read_text(encoding="utf-8"))
    assert [motion["name"] for motion in table["motions"]] == ["a", "b"]
    assert {"report.html", "boundary-1.csv", "boundary-2.csv", "figures"} <= {p.name for p in out.iterdir()}
    assert "wrinkle amplitude ratio" in (out / "report.html").read_text(encoding="utf-8")
    with pytest.raises(InputError, match="all different"):
        verb(paths, out=out, names="a,a")
    surfaces.write(made(), out / "surface.nc")
    with pytest.raises(InputError, match="holds a run"):
        verb(paths, out=out)
