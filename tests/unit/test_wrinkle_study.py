"""The study of wrinkling models: its cases, and what it makes of surfaces that are known."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from wrinklewave.config import load_case
from wrinklewave.experiments.wrinkle_study import Member, agreement, delay, surface_of_run

EXAMPLES = Path(__file__).parents[2] / "examples"
CASE = load_case(EXAMPLES / "paper_resolved.toml")
TIME, NODES = np.linspace(0.0, 4e-3, 401), np.linspace(0.0, 50.4e-3, 721)
SPEED, GROWTH = 50.0, 500.0


def surface(*, factor: float = 1.0, late: float = 1.0) -> xr.Dataset:
    """A strain of 0.1 arrives with a front, wrinkles of 30 um grow behind it, ``factor`` times as much, ``late`` times
    as late."""
    behind = np.maximum(TIME[:, np.newaxis] - late * (2e-4 + NODES / SPEED), 0.0)
    amplitude = 30e-6 * (1 + factor * np.expm1(GROWTH * behind))
    arrived = np.clip((TIME[:, np.newaxis] - NODES / SPEED) / 1e-4, 0.0, 1.0)
    x_p = NODES + np.cumsum((0.1 * arrived)[:, ::-1], axis=1)[:, ::-1] * NODES[1]
    y_p = 18.5e-3 + amplitude * np.cos(2 * np.pi * NODES / 2e-3)
    shape = ("time", "X")
    return xr.Dataset(
        {"amplitude": (shape, amplitude), "x_p": (shape, x_p), "y_p": (shape, y_p)},
        coords={"time": TIME, "X": NODES},
    )


def member(**other: float) -> Member:
    return Member("known", CASE, {"resolved": surface(), "rate-dependent": surface(**other)})


def test_a_model_that_is_right() -> None:
    fit = agreement(member(), "rate-dependent")
    assert (fit.median, fit.low, fit.high, fit.mean, fit.onset) == pytest.approx((1.0,) * 5)


def test_a_model_that_is_late_and_small() -> None:
    assert agreement(member(late=1.1), "rate-dependent").onset > 1.02
    fit = agreement(member(factor=0.5), "rate-dependent")
    assert 0.5 < fit.low < fit.median < fit.high < 1.0


def test_delay_of_wrinkles_that_stay_on_their_points() -> None:
    """Amplitudes double ln 2 / growth after they begin, 0.2 ms after the front, whose strain takes 43 us to 0.043."""
    found = delay(member())
    assert found.delay == pytest.approx(2e-4 + np.log(2) / GROWTH - 0.43e-4, abs=5e-5)
    assert found.strain == pytest.approx(0.1, rel=0.05)
    assert found.phase_shift < 20e-6


def test_members_are_cases(monkeypatch: pytest.MonkeyPatch) -> None:
    """Every run of the study can be made from its line in members.toml, and has a folder of its own."""
    monkeypatch.setattr(sys, "path", [str(EXAMPLES / "wrinkle_study"), *sys.path])
    import study  # type: ignore[import-not-found]

    groups = tomllib.loads((EXAMPLES / "wrinkle_study" / "members.toml").read_text(encoding="utf-8"))["group"]
    members = [(entry, group.get("set", [])) for group in groups for entry in group["members"]]
    cases = [study.case_of(entry, [study.TIMES, *shared]) for entry, shared in members]
    assert all(case.wrinkles.model == "resolved" for case in cases)
    assert len({study.folder(entry["name"]) for entry, _ in members}) == len(members)


def test_cells_show_uncertainties_and_what_there_is_not(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [str(EXAMPLES / "wrinkle_study"), *sys.path])
    import study

    row = {
        "ratio": 0.9555,
        "ratio_sigma": 0.066,
        "delay_s": 7.09e-4,
        "speed": float("nan"),
        "speed_sigma": 1.0,
    }
    assert study.cell(row, "ratio", 1, ".2f") == "0.96 ± 0.07"
    assert study.cell(row, "delay_s", 1e3, ".2f") == "0.71"
    assert study.cell(row, "nothing", 1, ".2f") == study.cell({}, "speed", 1, ".2f") == "-"


def test_finished_runs_are_used_again(tmp_path: Path) -> None:
    case = load_case(
        EXAMPLES / "quick.toml", ["mesh.elements=[40, 12]", "solver.end_time=0.2 ms", "analysis.times=[]"]
    )
    first = surface_of_run(case, tmp_path / "run")
    written = (tmp_path / "run" / "surface.nc").stat().st_mtime_ns
    again = surface_of_run(case, tmp_path / "run")
    assert (tmp_path / "run" / "surface.nc").stat().st_mtime_ns == written
    np.testing.assert_array_equal(again["y"], first["y"])
    surface_of_run(case.overridden("drive.velocity=3 m/s"), tmp_path / "run")
    assert (tmp_path / "run" / "surface.nc").stat().st_mtime_ns > written
