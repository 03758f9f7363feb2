"""Processor and GPU do the same: one set of runs, one test body. Without a GPU, numba simulates one."""

import json
import subprocess
import sys

import numpy as np
import pytest

from support.backend_models import BATCHES, EVENTS, MODELS, SHEAR, filmed
from support.backend_runs import CASES, continued
from support.elsewhere import environment, run_elsewhere
from wrinklewave.dynamics.boundary import CONTACT_LOSS, FORCE, FRICTION_LOSS, WORK, position

AGREEMENT = 1e-11
"""Relative to the largest value: rounding, in another order on each device, grown over a hundred steps at most."""
MIXED_AGREEMENT = 2e-5
"""The same, of single precision."""
STATE = ("u", "w", "vx", "vy", "memory", "fields", "totals")
EXACT = ("step", "time_s", "counts")

RESTARTED = ("struck", "filmed")

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
    found, folder = {}, tmp_path_factory.mktemp("runs")
    for device in ("cpu", "cuda"):
        file = folder / f"{device}.npz"
        run_elsewhere("support.backend_runs", device, device, str(file))
        with np.load(file) as data:
            found[device] = dict(data)
    found["cpu"] |= {
        f"continued/{key}": values for key, values in continued(filmed(), "cpu", folder / "cuda.h5").items()
    }
    return found


def of(runs: Runs, name: str) -> Runs:
    return {key.partition("/")[2]: values for key, values in runs.items() if key.startswith(name + "/")}


def agreement(name: str) -> float:
    return MIXED_AGREEMENT if name.endswith("mixed") else AGREEMENT


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


@pytest.mark.parametrize("name", [*MODELS, *(f"{case}_from_case" for case in CASES)])
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
    steps = {
        "struck": "steps",
        "many_terms": "steps",
        "filmed": "row_steps",
        "many_terms_by_rows": "row_steps",
    }
    expected = {name: {kernel, "sample", "snapshot", "stable_steps"} for name, kernel in steps.items()}
    assert {name: set(of_model) for name, of_model in found.items()} == expected
    resources = [of_kernel for of_model in found.values() for of_kernel in of_model.values()]
    assert not any(of_kernel.get("spilled") for of_kernel in resources)


@pytest.mark.parametrize("name", RESTARTED)
@pytest.mark.parametrize("device", ["cpu", "cuda"])
def test_restart_changes_no_bit(runs, device, name):
    whole, restarted = of(runs[device], name), of(runs[device], f"restarted_{name}")
    assert all(np.array_equal(whole[key], restarted[key]) for key in whole)


@pytest.mark.parametrize("device", ["cpu", "cuda"])
def test_a_checkpoint_of_one_device_goes_on_on_the_other(runs, device):
    whole, continued = of(runs[device], "filmed"), of(runs[device], "continued")
    energy = max(whole[key].max() for key in whole if key.endswith("_J_per_m"))
    assert whole.keys() == continued.keys()
    for key in whole:
        scale = energy if key.endswith("_J_per_m") else np.abs(whole[key]).max()
        assert np.abs(continued[key] - whole[key]).max() <= AGREEMENT * scale, key


def test_rows_have_steps_of_their_own(runs):
    counts = {name: of(runs["cuda"], name)["counts"] for name in ("filmed", "filmed_softly", "filmed_evenly")}
    assert counts["filmed"][-1] > counts["filmed_softly"][-1] > 1
    assert (counts["filmed_evenly"] == 1).all()
    assert of(runs["cuda"], "filmed_groove")["counts"][-1] > 1


@pytest.mark.parametrize(
    "name", [m.__name__ for members in BATCHES for m in members] + [f"restarted_{m}" for m in RESTARTED]
)
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
    struck, filmed, grooved, groove = (
        of(runs[device], name)["totals"] for name in ("struck", "filmed", "grooved", "filmed_groove")
    )
    for totals in (struck, filmed):
        assert min(totals[FORCE], totals[WORK], totals[FRICTION_LOSS]) > 0
    assert grooved[CONTACT_LOSS] * groove[CONTACT_LOSS] != 0  # their lips have touched
    sheared = of(runs[device], "sheared")
    assert sheared["w"][-1, 0] == pytest.approx(position(SHEAR, EVENTS[-1]))  # as its history says
    straight = of(runs[device], "bilayer")["w"][:, 0]
    assert straight[-1] > 0
    assert straight == pytest.approx(straight[-1] * np.arange(5) / 4)
