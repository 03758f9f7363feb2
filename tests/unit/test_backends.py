"""Processor and GPU do the same: one set of runs, one test body. Without a GPU, numba simulates one."""

import json
import subprocess
import sys

import numpy as np
import pytest

from support.backend_models import BATCHES, EVENTS, MODELS, SHEAR
from support.elsewhere import environment, run_elsewhere
from wrinklewave.dynamics.boundary import CONTACT_LOSS, FORCE, FRICTION_LOSS, WORK, position

AGREEMENT = 1e-11
"""Relative to the largest value: rounding, in another order on each device, grown over a hundred steps at most."""
MIXED_AGREEMENT = 2e-5
"""The same, of single precision."""
STATE = ("u", "w", "vx", "vy", "memory", "fields", "totals")
EXACT = ("step", "time_s")

Runs = dict[str, np.ndarray]


def can_compile() -> bool:
    """Whether numba can compile for a GPU, be there one or not; asked elsewhere, to leave this process alone."""
    command = [
        sys.executable,
        "-c",
        "from wrinklewave.environment import require_cuda_compilers as f; f()",
    ]
    return subprocess.run(command, env=environment(), capture_output=True, check=False).returncode == 0


@pytest.fixture(scope="module")
def runs(tmp_path_factory) -> dict[str, Runs]:
    """Results of all runs, by device."""
    pytest.importorskip("numba_cuda")
    found = {}
    for device in ("cpu", "cuda"):
        file = tmp_path_factory.mktemp("runs") / f"{device}.npz"
        run_elsewhere("support.backend_runs", device, device, str(file))
        with np.load(file) as data:
            found[device] = dict(data)
    return found


def of(runs: Runs, name: str) -> Runs:
    return {key.partition("/")[2]: values for key, values in runs.items() if key.startswith(name + "/")}


def agreement(name: str) -> float:
    return MIXED_AGREEMENT if name == "mixed" else AGREEMENT


@pytest.mark.parametrize("name", MODELS)
def test_devices_agree(runs, name):
    cpu, cuda = of(runs["cpu"], name), of(runs["cuda"], name)
    assert cpu.keys() == cuda.keys()
    for key in EXACT:
        assert cuda[key] == pytest.approx(cpu[key], rel=1e-14)
    for key in STATE:
        scale = np.abs(cpu[key]).max()
        assert scale > 0
        assert np.abs(cuda[key] - cpu[key]).max() <= agreement(name) * scale, key


@pytest.mark.parametrize("name", [*MODELS, "from_case"])
def test_histories_agree(runs, name):
    cpu, cuda = of(runs["cpu"], name), of(runs["cuda"], name)
    energy = max(cpu[key].max() for key in cpu if key.endswith("_J_per_m"))
    for key in set(cpu) - set(STATE) - set(EXACT):
        scale = energy if key.endswith("_J_per_m") else np.abs(cpu[key]).max()
        assert np.abs(cuda[key] - cpu[key]).max() <= agreement(name) * scale, key


def test_a_new_law_needs_no_line_for_a_device(runs, tmp_path):
    found = {}
    for device in ("cpu", "cuda"):
        file = tmp_path / f"{device}.npz"
        run_elsewhere("support.new_law", device, device, str(file))
        with np.load(file) as data:
            found[device] = dict(data)
    for key in STATE:
        scale = np.abs(found["cpu"][key]).max()
        assert np.abs(found["cuda"][key] - found["cpu"][key]).max() <= AGREEMENT * scale, key
    known = of(runs["cpu"], "struck")["u"]
    assert np.abs(found["cpu"]["u"] - known).max() > 1e-3 * np.abs(known).max()  # it is another solid


def test_kernels_compile_for_a_gpu(tmp_path):
    """All that the backend launches, for one Prony term and for many, without a spilled register."""
    pytest.importorskip("numba_cuda")
    if not can_compile():
        pytest.skip("no libNVVM or NVRTC: numba-cuda[cu13] brings them")
    file = tmp_path / "kernels.json"
    subprocess.run([sys.executable, "-m", "support.cuda_targets", str(file)], env=environment(), check=True)
    found = json.loads(file.read_text())
    kernels = {"steps", "sample", "snapshot", "stable_steps"}
    assert {name: set(of_model) for name, of_model in found.items()} == {
        "struck": kernels,
        "many_terms": kernels,
    }
    resources = [of_kernel for of_model in found.values() for of_kernel in of_model.values()]
    assert not any(of_kernel.get("spilled") for of_kernel in resources)


@pytest.mark.parametrize("device", ["cpu", "cuda"])
def test_restart_changes_no_bit(runs, device):
    whole, restarted = of(runs[device], "struck"), of(runs[device], "restarted")
    assert all(np.array_equal(whole[key], restarted[key]) for key in whole)


@pytest.mark.parametrize("name", [model.__name__ for members in BATCHES for model in members] + ["restarted"])
def test_a_batch_changes_no_bit_of_its_members(runs, name):
    alone, together = of(runs["cuda"], name), of(runs["cuda"], f"together_{name}")
    assert alone.keys() == together.keys()
    assert all(np.array_equal(alone[key], together[key]) for key in alone)


def test_members_of_batches_differ_and_one_fails(runs):
    assert "not finite" in str(of(runs["cuda"], "together_overrun")["error"])
    steps = {len(of(runs["cuda"], f"together_{name}")["step"]) for name in ("struck", "compressed")}
    assert len(steps) == 2
    for one, other in (("sheared", "sheared_otherwise"), ("grooved", "grooved_softly")):
        assert not np.array_equal(of(runs["cuda"], one)["u"], of(runs["cuda"], other)["u"])


@pytest.mark.parametrize("device", ["cpu", "cuda"])
def test_runs_show_what_they_are_for(runs, device):
    struck, grooved = of(runs[device], "struck")["totals"], of(runs[device], "grooved")["totals"]
    assert struck[FORCE] > 0
    assert struck[WORK] > 0
    assert struck[FRICTION_LOSS] > 0
    assert grooved[CONTACT_LOSS] != 0  # its lips have touched
    sheared = of(runs[device], "sheared")
    assert sheared["w"][-1, 0] == pytest.approx(position(SHEAR, EVENTS[-1]))  # as its history says
    straight = of(runs[device], "bilayer")["w"][:, 0]
    assert straight[-1] > 0
    assert straight == pytest.approx(straight[-1] * np.arange(5) / 4)
