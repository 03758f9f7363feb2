"""Sweeps: every combination runs, results equal those of single runs, failures and interrupts are part of it."""

import csv
import signal

import pytest
import xarray as xr

from support.cases import EXAMPLES
from wrinklewave.config import load_case
from wrinklewave.config.overrides import alternatives
from wrinklewave.errors import InputError
from wrinklewave.experiments.interruption import Outcome
from wrinklewave.experiments.simulate import simulate
from wrinklewave.experiments.sweep import sweep

SMALL = ("mesh.elements=[24, 8]", "solver.end_time=0.5 ms", "output.field_interval=0.25 ms")
QUICK = EXAMPLES / "quick.toml"


@pytest.mark.parametrize(
    ("text", "key", "values"),
    [
        ("drive.velocity=5 m/s, 10 m/s", "drive.velocity", ("5 m/s", "10 m/s")),
        ("mesh.elements = [101, 37], [202, 74]", "mesh.elements", ("[101, 37]", "[202, 74]")),
        ('case.name="a, b", c', "case.name", ('"a, b"', "c")),
        ("solver.safety=0.9", "solver.safety", ("0.9",)),
    ],
)
def test_values_to_go_over(text, key, values):
    assert alternatives(text) == (key, values)


@pytest.mark.parametrize("text", ["drive.velocity", "drive.velocity=", "=1, 2", "drive..velocity=1", "a=,"])
def test_nothing_to_go_over(text):
    with pytest.raises(InputError, match="--over"):
        alternatives(text)


def test_a_key_twice(tmp_path):
    with pytest.raises(InputError, match="twice"):
        sweep(QUICK, ["solver.safety=0.9", "solver.safety=0.8"], out=tmp_path)
    with pytest.raises(InputError, match=r"--over: solver\.safety: a value twice"):
        sweep(QUICK, ["solver.safety=0.9, 0.9"], out=tmp_path)


def test_wrong_values_are_found_before_anything_runs(tmp_path):
    with pytest.raises(InputError, match=r"--over: drive\.velocity"):
        sweep(QUICK, ["drive.velocity=10 m/s, 10 kg"], out=tmp_path)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("file", ["case.toml", "experiment.toml"])
def test_a_folder_of_something_else_is_left_alone(tmp_path, file):
    (tmp_path / file).touch()
    with pytest.raises(InputError, match="holds a run or a measurement"):
        sweep(QUICK, ["drive.velocity=5 m/s, 10 m/s"], out=tmp_path, overwrite=True)
    assert [path.name for path in tmp_path.iterdir()] == [file]


def test_interrupted_and_resumed_sweep_has_what_single_runs_have(tmp_path):
    over = ["drive.velocity=6 m/s, 10 m/s", "wrinkles.model=quasi-static, none"]

    def interrupt(state):
        signal.raise_signal(signal.SIGINT)

    outcome, _ = sweep(QUICK, over, out=tmp_path, overrides=SMALL, jobs=1, progress=interrupt)
    assert outcome is Outcome.INTERRUPTED
    first = tmp_path / "runs" / "0000" / "summary.json"
    written = first.stat().st_mtime_ns
    with pytest.raises(InputError, match="holds a sweep already"):
        sweep(QUICK, over, out=tmp_path, overrides=SMALL)
    with pytest.raises(InputError, match="another sweep"):
        sweep(QUICK, over, out=tmp_path, resume=True)
    outcome, table = sweep(QUICK, over, out=tmp_path, overrides=SMALL, jobs=2, resume=True)
    assert outcome is Outcome.FINISHED
    assert first.stat().st_mtime_ns == written
    assert table["drive.velocity"].values.tolist() == [6.0, 10.0]
    assert table["wrinkles.model"].values.tolist() == ["quasi-static", "none"]
    with xr.open_dataset(tmp_path / "sweep.nc", engine="h5netcdf") as kept:
        xr.testing.assert_identical(kept.load(), table)
    single = simulate(load_case(QUICK, [*SMALL, "drive.velocity=6 m/s"]), threads=1)
    of_sweep = table.sel({"drive.velocity": 6.0, "wrinkles.model": "quasi-static"})
    for name in ("wavefront_speed_m_per_s", "strain_rate_max_per_s", "steps"):
        assert of_sweep[name].item() == single.summary[name]
    with (tmp_path / "sweep.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert [row["drive.velocity"] for row in rows] == ["6.0", "6.0", "10.0", "10.0"]
    assert {row["outcome"] for row in rows} == {"finished"}


def test_a_run_that_fails_leaves_the_others_alone(tmp_path):
    over = ["drive.velocity=10 m/s, 1000 m/s"]
    choices = (*SMALL, "drive.rise_time=0 ms", "solver.bulk_viscosity=[0, 0]")
    outcome, table = sweep(QUICK, over, out=tmp_path, overrides=choices, jobs=1)
    assert outcome is Outcome.FINISHED
    assert table["outcome"].values.tolist() == ["finished", "failed"]
    assert table["wavefront_speed_m_per_s"].notnull().values.tolist() == [True, False]
