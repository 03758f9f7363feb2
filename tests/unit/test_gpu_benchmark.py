"""The GPU's benchmark runs to its end: in the simulator if there is no GPU, and with no more packages than it names."""

import json
import subprocess
import sys

import pytest

from support.elsewhere import SIMULATED, TESTS, environment

UNUSED = (
    *("pydantic", "pint", "xarray", "h5netcdf", "typer", "rich", "matplotlib", "jinja2", "tifffile"),
    *("threadpoolctl", "av", "vtk", "pandas"),
)
CODE = """
import runpy, sys
sys.modules.update(dict.fromkeys(sys.argv[2:]))
sys.argv[1:] = ["--out", sys.argv[1]]
runpy.run_module("benchmarks.gpu", run_name="__main__")
"""


def test_every_check_runs(tmp_path):
    pytest.importorskip("numba_cuda")
    file = tmp_path / "gpu.json"
    command = [sys.executable, "-c", CODE, str(file), *UNUSED]
    subprocess.run(command, env=environment() | SIMULATED, cwd=TESTS.parent, check=True)
    found = json.loads(file.read_text())
    checks = {
        name: result for name, result in found.items() if isinstance(result, dict) and name != "versions"
    }
    assert not [name for name, result in checks.items() if "failed" in result or "skipped" in result]
    assert checks["paper_case_against_cpu"]["passed"]
    assert checks["test_body"]["passed"]
    resolved = checks["resolved_1"]
    assert resolved["times_fewer_updates"] > 1.5
    assert all(resolved[way]["done"] == 1.0 for way in ("own_steps", "one_step_for_all"))
    batches = [result for name, result in checks.items() if name.startswith("batch_")]
    assert [result["runs"] for result in batches] == [1, 1, 2, 2]
    assert all(result["done"] == 1.0 and result["runs_per_minute"] > 0 for result in batches)
    assert not any(result["failures"] for result in batches)
