"""A small simulation from case to files: contents, restart, threads, interruption."""

import csv
import json
import os
import signal
import time
from pathlib import Path

import h5py
import numpy as np
import pytest

from wrinklewave import surface
from wrinklewave.config import load_case
from wrinklewave.dynamics import cpu
from wrinklewave.dynamics.fields import FIELDS
from wrinklewave.dynamics.model import build_model
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.errors import InputError, RunError
from wrinklewave.experiments.interruption import Outcome
from wrinklewave.experiments.simulate import output_times, simulate

QUICK = Path(__file__).parents[2] / "examples" / "quick.toml"
SMALL = (
    "mesh.elements=[24, 8]",
    "solver.end_time=0.5 ms",
    "output.field_interval=0.1 ms",
    'analysis.times=["0.2 ms", "0.4 ms"]',
)


@pytest.fixture(scope="module")
def case():
    return load_case(QUICK, SMALL)


@pytest.fixture(scope="module")
def run(case, tmp_path_factory):
    return simulate(case, out=tmp_path_factory.mktemp("run") / "small")


def results(folder: Path) -> dict[str, bytes]:
    """Every array of a run's files, and its history."""
    found = {"history": (folder / "history.csv").read_bytes()}
    for name in ("surface.nc", "fields.vtkhdf"):
        with h5py.File(folder / name) as file:

            def keep(key, item, name=name):
                if isinstance(item, h5py.Dataset):
                    found[f"{name}/{key}"] = np.ascontiguousarray(item[()]).tobytes()

            file.visititems(keep)
    return found


def test_output_times_end_at_the_end():
    assert output_times(0.3, 1.0) == pytest.approx([0, 0.3, 0.6, 0.9, 1.0])
    assert output_times(0.25, 1.0) == pytest.approx([0, 0.25, 0.5, 0.75, 1.0])


def test_run_leaves_its_files(run):
    names = {path.name for path in run.folder.iterdir()}
    assert names == {
        "case.toml",
        "surface.nc",
        "fields.vtkhdf",
        "history.csv",
        "boundary.csv",
        "probes.csv",
        "summary.json",
    }


def test_surface_on_disk_is_that_of_the_run(run):
    stored = surface.read(run.folder)
    assert np.array_equal(stored.x_p, run.surface.x_p)
    assert stored.time.values == pytest.approx(np.arange(51) * 1e-5)
    assert stored.attrs["kind"] == "simulation"


def test_resolved_case_on_disk_gives_an_equal_case(run):
    assert load_case(run.folder / "case.toml") == run.case


def test_summary_names_units_and_versions(run):
    summary = json.loads((run.folder / "summary.json").read_text())
    assert summary["outcome"] == "finished"
    assert summary["steps"] == run.history["step"][-1]
    assert 0 <= summary["energy_imbalance_max"] < 1e-2  # coarse in space and time
    assert {
        "wavefront_speed_m_per_s",
        "element_updates_per_s",
        "hourglass_energy_share_max",
    } <= summary.keys()
    assert summary["versions"]["wrinklewave"]


def test_history_keeps_all_digits(run):
    with (run.folder / "history.csv").open() as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["kinetic_J_per_m"]) for row in rows] == run.history["kinetic_J_per_m"].tolist()


def test_probes_follow_material_points(run):
    table = np.genfromtxt(run.folder / "probes.csv", delimiter=",", names=True)
    probes = run.case.output.probes
    assert np.unique(table["X_m"]) == pytest.approx(probes)
    for X in probes:
        rows = table[np.isclose(table["X_m"], X)]
        assert rows["time_s"] == pytest.approx(run.surface.time.values)
        for column, name in (("x_m", "x_p"), ("y_m", "y_p"), ("strain_xx", "strain_xx")):
            found = [np.interp(X, run.surface.X, values) for values in run.surface[name].values]
            assert rows[column] == pytest.approx(found, rel=1e-12)


def test_replacing_a_run_leaves_nothing_of_the_old_one(case, tmp_path):
    simulate(case, out=tmp_path)

    def interrupt(state):
        signal.raise_signal(signal.SIGINT)

    simulate(case, out=tmp_path, overwrite=True, progress=interrupt)
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"case.toml", "checkpoint.h5", "fields.vtkhdf.part", "history.csv", "summary.json"}


def test_outputs_far_apart_do_not_make_the_step_too_long(case):
    # an element is squeezed by a third between two outputs, and its stable step with it
    rare = case.overridden(
        "output.surface_interval=0.15 ms", "output.field_interval=0.5 ms", "output.history_interval=0.5 ms"
    )
    often, seldom = simulate(case), simulate(rare)
    assert seldom.surface.y_p.values[-1] == pytest.approx(often.surface.y_p.values[-1], rel=5e-3)


def test_paraview_reads_the_fields(run):
    vtk = pytest.importorskip("vtk")
    from vtk.util.numpy_support import vtk_to_numpy

    reader = vtk.vtkHDFReader()
    reader.SetFileName(str(run.folder / "fields.vtkhdf"))
    reader.UpdateInformation()
    assert reader.GetNumberOfSteps() == 6
    reader.SetStep(5)
    reader.Update()
    grid = reader.GetOutput()
    assert grid.GetNumberOfCells() == run.mesh.n_elements
    assert {grid.GetCellData().GetArrayName(k) for k in range(grid.GetCellData().GetNumberOfArrays())} >= set(
        FIELDS
    )
    displacement = vtk_to_numpy(grid.GetPointData().GetArray("displacement"))
    top = displacement.reshape(*run.mesh.X.shape, 3)[-1, :, 0]
    assert top == pytest.approx(run.surface.x_p.values[-1] - run.mesh.X[-1], abs=1e-8)
    assert vtk_to_numpy(grid.GetPoints().GetData())[:, 0] == pytest.approx(run.mesh.X.ravel())


def test_threads_change_no_bit(case, run, tmp_path):
    if len(os.sched_getaffinity(0)) < 2:
        pytest.skip("one core")
    one = simulate(case, out=tmp_path / "one", threads=1)
    two = simulate(case, out=tmp_path / "two", threads=2)
    assert results(one.folder) == results(two.folder) == results(run.folder)


@pytest.mark.parametrize("stop_at", [1, 17, 49])
def test_interrupted_and_resumed_run_equals_an_undisturbed_one(case, run, tmp_path, stop_at):
    def interrupt(state):
        if state.time >= (stop_at - 0.5) * 1e-5:
            signal.raise_signal(signal.SIGINT)

    stopped = simulate(case, out=tmp_path, progress=interrupt)
    assert stopped.outcome is Outcome.INTERRUPTED
    assert json.loads((tmp_path / "summary.json").read_text())["outcome"] == "interrupted"
    resumed = simulate(case, out=tmp_path, resume=True)
    assert resumed.outcome is Outcome.FINISHED
    assert results(tmp_path) == results(run.folder)


def test_earlier_run_is_not_overwritten_unasked(case, run):
    with pytest.raises(InputError, match="holds a run already"):
        simulate(case, out=run.folder)


def test_checkpoint_of_another_case_is_refused(case, tmp_path):
    def interrupt(state):
        signal.raise_signal(signal.SIGINT)

    simulate(case, out=tmp_path, progress=interrupt)
    with pytest.raises(InputError, match="another case"):
        simulate(case, out=tmp_path, resume=True, overrides=["drive.velocity=9 m/s"])
    assert simulate(case, out=tmp_path, resume=True).outcome is Outcome.FINISHED  # it can still go on


def test_a_finished_run_of_another_case_is_not_resumed_over(case, run):
    before = results(run.folder)
    with pytest.raises(InputError, match=r"another case, with another drive\.velocity\n"):
        simulate(case, out=run.folder, resume=True, overrides=["drive.velocity=9 m/s"])
    assert results(run.folder) == before
    assert load_case(run.folder / "case.toml") == case


def test_a_finished_run_is_not_run_again(case, tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from wrinklewave.cli import application

    file, folder = tmp_path / "case.toml", tmp_path / "[run]"
    file.write_text(case.to_toml())
    first = CliRunner().invoke(application(), ["simulate", str(file), "--out", str(folder)])
    assert f"for figures and report; look at {folder}/report.html" in first.output
    monkeypatch.setattr(cpu, "advance", None)  # it would fail
    for command in (["restart", str(folder)], ["simulate", str(file), "--resume", "--out", str(folder)]):
        again = CliRunner().invoke(application(), command)
        assert (again.exit_code, again.output) == (0, f"finished already; look at {folder}/report.html\n")


def test_an_interrupt_while_results_are_written_says_how_to_go_on(case, tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from wrinklewave.cli import application
    from wrinklewave.experiments import simulate as procedure

    def interrupted(*arguments):
        raise KeyboardInterrupt

    file, folder = tmp_path / "case.toml", tmp_path / "a run"
    file.write_text(case.to_toml())
    monkeypatch.setattr(procedure, "analyse", interrupted)
    stopped = CliRunner().invoke(application(), ["simulate", str(file), "--out", str(folder)])
    assert stopped.exit_code == 130
    assert f"go on with:  wrinklewave restart '{folder}'" in stopped.output


@pytest.mark.parametrize("damage", ["cut", "emptied"])
def test_damaged_checkpoint_is_refused(case, tmp_path, damage):
    def interrupt(state):
        signal.raise_signal(signal.SIGINT)

    simulate(case, out=tmp_path, progress=interrupt)
    checkpoint = tmp_path / "checkpoint.h5"
    if damage == "cut":
        checkpoint.write_bytes(checkpoint.read_bytes()[:1000])
    else:
        with h5py.File(checkpoint, "a") as file:
            del file["state/memory"]
    with pytest.raises(InputError, match=r"cannot be read|damaged"):
        simulate(case, out=tmp_path, resume=True)


def test_run_without_a_folder_keeps_its_fields(case, run):
    free = simulate(case)
    assert len(free.fields) == 6
    assert np.array_equal(free.surface.y, run.surface.y, equal_nan=True)


def test_a_filter_that_does_not_suit_the_grid_is_found_before_the_run(case, tmp_path):
    with pytest.raises(InputError, match=r"filter_wavelength.*samples"):
        simulate(case, out=tmp_path / "run", overrides=["analysis.filter_wavelength=0.01 mm"])
    assert not (tmp_path / "run").exists()


def test_time_left_comes_from_the_pace_of_the_steps(case):
    found = []
    simulate(case, progress=lambda state: found.append((state.time, state.seconds_left)))
    assert np.isnan([left for _, left in found[:2]]).all()  # at rest, and after the first steps
    assert found[-1] == (pytest.approx(0.5e-3), 0.0)


def test_the_compiler_does_not_count_as_stepping(case, monkeypatch):
    advance, compiled = cpu.advance, []

    def slow_at_first(*arguments):
        if not compiled:
            time.sleep(0.3)  # stands for the compiler
            compiled.append(True)
        advance(*arguments)

    monkeypatch.setattr(cpu, "advance", slow_at_first)
    simulation = Simulation(build_model(case), np.array([0.0, 1e-5]))
    for _ in simulation.run():
        pass
    assert compiled
    assert simulation.step > 0
    assert simulation.stepping_seconds < 0.3


def test_too_many_threads_is_an_error(case):
    with pytest.raises(InputError, match="cores"):
        simulate(case, threads=10_000)


def test_collapsing_elements_stop_the_run_and_keep_what_was_computed(tmp_path):
    crushing = load_case(
        QUICK,
        [*SMALL, "drive.stop_distance=45 mm", "drive.velocity=300 m/s", "solver.bulk_viscosity=[0.06, 0.0]"],
    )
    with pytest.raises(RunError) as caught:
        simulate(crushing, out=tmp_path)
    assert "row" in str(caught.value)
    assert "to mend" in str(caught.value)
    summary = json.loads((tmp_path / "summary.json").read_text())
    assert summary["outcome"] == "failed"
    assert (tmp_path / "history.csv").stat().st_size > 200


def test_an_interrupt_while_the_report_is_written_costs_no_step(case, run, tmp_path, monkeypatch):
    from typer.testing import CliRunner

    from wrinklewave.cli import application
    from wrinklewave.report import run as report_of_run

    def interrupted(*arguments):
        raise KeyboardInterrupt

    file, folder = tmp_path / "case.toml", tmp_path / "run"
    file.write_text(case.to_toml())
    with monkeypatch.context() as patch:
        patch.setattr(report_of_run, "present", interrupted)
        stopped = CliRunner().invoke(application(), ["simulate", str(file), "--out", str(folder)])
    assert stopped.exit_code == 130
    assert "wrinklewave restart" in stopped.output
    steps = []
    monkeypatch.setattr(cpu, "advance", lambda n, *rest: steps.append(n))
    assert CliRunner().invoke(application(), ["restart", str(folder)]).exit_code == 0
    assert sum(steps) == 0
    assert results(folder) == results(run.folder)
    assert (folder / "report.html").exists()
    assert not (folder / "checkpoint.h5").exists()
