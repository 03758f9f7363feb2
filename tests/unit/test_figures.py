"""Every registered figure is drawn, fits its page, and is written."""

from __future__ import annotations

import importlib
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from support.settings import SETTINGS
from wrinklewave import figures
from wrinklewave.analysis.analyse import analyse
from wrinklewave.figures.beside import Helper
from wrinklewave.figures.compression import COMPRESSION_FIGURES
from wrinklewave.figures.registry import Registry
from wrinklewave.figures.side_by_side import COMPARISON_FIGURES
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

TIMES = (0.38e-3, 1.2e-3)


def _snapshots() -> figures.StrainSnapshots:
    X, Y = np.meshgrid(np.linspace(0.0, 50.4e-3, 41), np.linspace(0.0, 18.5e-3, 16))
    travel = np.minimum(10.0 * np.array(TIMES), 6.3e-3)[:, None, None]
    strain = travel / 50.4e-3 * (1 + np.cos(Y[:-1, :-1] / 6e-3))
    x = X + travel * (1 - X / 50.4e-3)
    return figures.StrainSnapshots(np.array(TIMES), X, Y, x, np.broadcast_to(Y, x.shape), strain)


def _history() -> dict[str, np.ndarray]:
    time = np.linspace(0.0, 3e-3, 200)
    work = 10.0 * (1 - np.exp(-time / 1e-3))
    energies = {
        "elastic_J_per_m": 0.5,
        "kinetic_J_per_m": 0.2,
        "viscous_work_J_per_m": 0.295,
        "springs_J_per_m": 0.1,
        "hourglass_J_per_m": 0.005,
    }
    return {"time_s": time, "external_work_J_per_m": work, "imbalance_J_per_m": 1e-4 * work} | {
        name: share * work for name, share in energies.items()
    }


@pytest.fixture(scope="module")
def inputs() -> figures.FigureInputs:
    surface = TravellingPulse(end_time=3e-3, interval=20e-6, pixel=1e-4).surface()
    surface["stress_xx"] = surface["strain_xx"] * 200e3
    surface["stress_xx"].attrs["units"] = "Pa"
    surface.attrs["plane_strain_modulus"] = 172.5e3
    return figures.figure_inputs(
        surface,
        analyse(surface, SETTINGS),
        positions=SETTINGS.positions,
        times=TIMES,
        snapshots=_snapshots(),
        history=_history(),
    )


@pytest.mark.parametrize("name", figures.FIGURES)
def test_figure_fits_its_page(name: str, inputs: figures.FigureInputs) -> None:
    """Nothing is cut off, every axis is labelled, and every map has a colour bar."""
    drawing = figures.FIGURES[name].draw(inputs)
    box = drawing.get_tightbbox()
    assert box.x0 >= 0.0
    assert box.y0 >= 0.0
    assert box.x1 <= drawing.get_figwidth()
    assert box.y1 <= drawing.get_figheight()
    for axes in drawing.axes:
        assert axes.get_ylabel(), f"an axis of {name} has no label"


def test_all_figures_are_written(inputs: figures.FigureInputs, tmp_path: Path) -> None:
    files = figures.FIGURES.write(tmp_path / "figures", inputs, kinds={"simulation"})
    assert list(files) == list(figures.FIGURES)
    for path in files.values():
        assert path.read_bytes().startswith(b"\x89PNG")


def test_another_process_draws_the_same(inputs: figures.FigureInputs, tmp_path: Path) -> None:
    alone = figures.FIGURES.write(tmp_path / "alone", inputs, kinds={"simulation"})
    helper = Helper()
    helper.begin(figures.FIGURES.place, inputs, {name: tmp_path / f"{name}.png" for name in alone})
    assert helper.has_drawn()
    for name, file in alone.items():
        assert (tmp_path / f"{name}.png").read_bytes() == file.read_bytes()


def test_what_another_process_does_not_bring_is_drawn_here(
    inputs: figures.FigureInputs, tmp_path: Path
) -> None:
    helper = Helper()
    helper.end()
    files = figures.FIGURES.write(tmp_path, inputs, kinds={"simulation"}, helper=helper)
    assert list(files) == list(figures.FIGURES)
    assert all(file.exists() for file in files.values())


@pytest.mark.parametrize("registry", [figures.FIGURES, COMPARISON_FIGURES, COMPRESSION_FIGURES])
def test_another_process_finds_the_registry(registry: Registry[Any]) -> None:
    module, name = registry.place.split(":")
    assert getattr(importlib.import_module(module), name) is registry


def test_figures_without_their_inputs_are_left_out(inputs: figures.FigureInputs, tmp_path: Path) -> None:
    bare = replace(
        inputs,
        analysis=replace(inputs.analysis, strains=None, quasi_static=None),
        snapshots=None,
        history=None,
    )
    files = figures.FIGURES.write(tmp_path, bare, kinds={"simulation"})
    numbers = {figures.FIGURES[name].number for name in files}
    assert numbers == {"2C", "2D", "3", "4B", "5D", "S5"}


def test_a_measured_surface_motion_is_shown_under_the_papers_numbers_for_it() -> None:
    specs = [spec.of({"measurement"}) for spec in figures.FIGURES.values()]
    assert {"2B", "4A", "5C"} <= {spec.number for spec in specs}
    assert not {"2C", "4B", "5D"} & {spec.number for spec in specs}
    assert len({spec.name for spec in specs}) == len(specs)


def test_a_sample_at_rest_can_be_drawn(tmp_path: Path) -> None:
    motion = TravellingPulse(
        velocity=0.0, travel=0.0, height=0.0, amplitude=0.0, end_time=1e-4, pixel=1e-4
    ).surface()
    inputs = figures.figure_inputs(
        motion, analyse(motion, SETTINGS), positions=SETTINGS.positions, times=TIMES
    )
    files = figures.FIGURES.write(tmp_path, inputs, kinds={"simulation"})
    assert {figures.FIGURES[name].number for name in files} == {"4C", "4D", "5A"}


def test_moments_that_the_eye_could_not_part_are_one_line(inputs: figures.FigureInputs) -> None:
    for separation, labels in ((1.001e-3, ["stop, separation"]), (1.3e-3, ["stop", "separation"])):
        boundary = replace(inputs.analysis.boundary, stop_time=1e-3, separation_time=separation)
        moved = replace(inputs, analysis=replace(inputs.analysis, boundary=boundary))
        motion = figures.FIGURES["fig_2d_boundary_spectrum"].draw(moved).axes[0]
        assert motion.get_legend_handles_labels()[1] == labels


def test_importing_figures_does_not_import_matplotlib() -> None:
    code = "import sys, wrinklewave.figures; sys.exit('matplotlib' in sys.modules)"
    subprocess.run([sys.executable, "-c", code], check=True)
