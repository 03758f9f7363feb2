"""Batches on the GPU, be it simulated: a run in a batch leaves what it leaves alone; sweeps use them."""

import json

import pytest
import xarray as xr

from support.cases import EXAMPLES
from support.elsewhere import run_elsewhere
from wrinklewave.config import load_case
from wrinklewave.dynamics.asking import answered_together
from wrinklewave.errors import RunError
from wrinklewave.experiments.batch import batches

QUICK = EXAMPLES / "quick.toml"
RUNS, FAILED = range(4), (1, 3)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    """What ``support.batch_runs`` leaves."""
    pytest.importorskip("numba_cuda")
    place = tmp_path_factory.mktemp("batches")
    run_elsewhere("support.batch_runs", "cuda", str(place))
    return place


def assert_same(one, other):
    """The folders of two runs have the same in them."""
    left, others = ({file.name for file in run.iterdir()} for run in (one, other))
    assert left ^ others <= {"checkpoint.h5"}  # which one that has failed keeps if it was interrupted before
    for name in ("case.toml", "history.csv", "boundary.csv"):
        if name in left:
            assert (one / name).read_bytes() == (other / name).read_bytes()
    if "surface.nc" in left:
        motions = [xr.load_dataset(run / "surface.nc", engine="h5netcdf") for run in (one, other)]
        xr.testing.assert_equal(*motions)
    ours, theirs = (json.loads((run / "summary.json").read_text()) for run in (one, other))
    assert ours.keys() == theirs.keys()
    for name in ("outcome", "steps", "device"):
        assert ours[name] == theirs[name]


@pytest.mark.parametrize("n", RUNS)
def test_a_run_of_a_batch_leaves_what_it_leaves_alone(folder, n):
    run = f"{n:04d}"
    assert_same(folder / "sweep" / "runs" / run, folder / "single" / run)


def test_an_interrupted_batch_goes_on(folder):
    assert_same(folder / "interrupted" / "0000", folder / "single" / "0000")


def test_a_sweep_in_batches(folder):
    outcomes = json.loads((folder / "sweep" / "outcomes.json").read_text())
    assert (outcomes["first"], outcomes["second"]) == ("INTERRUPTED", "FINISHED")
    table = xr.load_dataset(folder / "sweep" / "sweep.nc", engine="h5netcdf")
    expected = ["failed" if n in FAILED else "finished" for n in RUNS]
    assert table["outcome"].values.ravel().tolist() == expected
    assert table["steps"].isnull().values.ravel().tolist() == [n in FAILED for n in RUNS]


def test_ended_members_of_a_sweep_are_not_run_again(folder):
    outcomes = json.loads((folder / "sweep" / "outcomes.json").read_text())
    ended = [folder / "sweep" / "runs" / f"{n:04d}" / "summary.json" for n in (0, 1)]
    for summary in ended:
        assert outcomes["written"][str(summary)] == summary.stat().st_mtime_ns


@pytest.mark.parametrize(
    ("processes", "most", "sizes"),
    [(1, 64, [5, 3]), (4, 64, [2, 2, 1, 2, 1]), (1, 2, [2, 2, 1, 2, 1]), (100, 64, [1] * 8)],
)
def test_cases_are_shared_out_by_their_shape(monkeypatch, processes, most, sizes):
    pytest.importorskip("numba_cuda")
    monkeypatch.setattr("wrinklewave.dynamics.cuda.backend.most_members", lambda model, processes: most)
    meshes, n_wide = ["[6, 3]", "[5, 3]"], 5
    choices = [f"mesh.elements={meshes[n >= n_wide]}" for n in range(8)]
    found = batches([load_case(QUICK, [choice]) for choice in choices], processes)
    assert [len(places) for places in found] == sizes
    assert sorted(place for places in found for place in places) == list(range(8))
    assert all(len({place < n_wide for place in places}) == 1 for places in found)


def asks(marches, fails=False):
    """Asks for some marches, then returns the samples, or fails."""
    samples = []
    for march in marches:
        samples.append((yield march))
    if fails:
        raise RunError("as it had to")
    return samples


def test_all_that_ask_are_answered_at_the_same_time():
    launches = []

    def march(wanted):
        launches.append(dict(wanted))
        return {place: -number for place, number in wanted.items()}

    asking = [asks([1, 2, 3]), asks([10]), asks([]), asks([20, 30], fails=True)]
    ends = dict(answered_together(asking, march))
    assert launches == [{0: 1, 1: 10, 3: 20}, {0: 2, 3: 30}, {0: 3}]
    assert {place: ends[place] for place in range(3)} == {0: [-1, -2, -3], 1: [-10], 2: []}
    assert str(ends[3]) == "as it had to"


def test_those_that_wait_are_closed_when_a_launch_fails():
    closed = []

    def asking():
        try:
            yield 1
        finally:
            closed.append(True)

    def march(wanted):
        raise MemoryError

    with pytest.raises(MemoryError):
        list(answered_together([asking(), asking()], march))
    assert closed == [True, True]
