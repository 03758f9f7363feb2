"""Resolved film, rate-dependent model and Eq. 1 in the paper's impact. One command makes numbers and figures:

    python examples/wrinkle_study/study.py --out runs/wrinkle_study

Every resolved run takes about a minute on a free core; finished runs in the folder are used again.
"""

from __future__ import annotations

import argparse
import csv
from pathlib import Path

import matplotlib as mpl

mpl.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from wrinklewave.config import load_case
from wrinklewave.experiments.wrinkle_study import (
    Member,
    amplitudes,
    run_member,
    speeds_and_amplitudes,
    surface_of_run,
)

BASE = Path(__file__).parents[1] / "paper_resolved.toml"
IMPERFECTIONS = ("10 um", "30 um")
MATERIALS = {
    "viscous": (),
    # without viscosity the strain behind a plate is its speed over 13 m/s: at 10 m/s the bare surface would fold
    "elastic": ("substrate.prony=[]", "drive.velocity=2 m/s"),
}
SUBSTRATE_ALONE = ("wrinkles.model=none", "mesh.elements=[202, 74]", "mesh.grading=[1, 1]")
POSITIONS = (15e-3, 25e-3, 35e-3)
STYLES = {"resolved": "-", "rate-dependent": "--", "quasi-static": ":"}
COLOURS = ("#c1272d", "#0000a7", "#008176")


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--out", type=Path, default=Path("runs/wrinkle_study"))
    parser.add_argument(
        "--set", dest="overrides", action="append", default=[], help="key=value for every run"
    )
    arguments = parser.parse_args()
    members = run_study(arguments.out, arguments.overrides)
    write_table(arguments.out / "study.csv", members)
    draw_amplitudes(members).savefig(arguments.out / "amplitude_against_time.png", dpi=130)
    draw_profiles(members).savefig(arguments.out / "amplitude_against_position.png", dpi=130)


def run_study(out: Path, overrides: list[str]) -> list[Member]:
    """Every member of the matrix, from new or finished runs."""
    members = []
    for material, changes in MATERIALS.items():
        alone = load_case(BASE, [*changes, *overrides, *SUBSTRATE_ALONE])
        substrate = surface_of_run(alone, out / f"{material}_substrate")
        for amplitude in IMPERFECTIONS:
            case = load_case(BASE, [*changes, *overrides, f"film.imperfection.amplitude={amplitude}"])
            name = f"{material}, {amplitude}"
            folder = out / name.replace(", ", "_").replace(" ", "")
            print(f"{name}: {folder}", flush=True)
            members.append(run_member(name, case, substrate, out=folder))
    return members


def write_table(path: Path, members: list[Member]) -> None:
    """Numbers of the study, to a file and to the terminal."""
    rows = speeds_and_amplitudes(members)
    with path.open("w", newline="") as stream:
        writer = csv.DictWriter(stream, rows[0])
        writer.writeheader()
        writer.writerows(rows)
    for row in rows:
        print(
            "  ".join(
                f"{value:.4g}" if isinstance(value, float) else f"{value:16s}" for value in row.values()
            )
        )


def title(member: Member) -> str:
    """Substrate, speed of the plate and imperfection."""
    material, imperfection = member.name.split(", ")
    speed = getattr(member.case.drive, "velocity", float("nan"))
    return f"{material} substrate, {speed:g} m/s, imperfection {imperfection.replace('um', 'µm')}"


def draw_amplitudes(members: list[Member]) -> plt.Figure:
    """Amplitude against time at three material points, one panel per member."""
    figure, axes = plt.subplots(2, 2, figsize=(9, 7.4), sharex=True, sharey=True, layout="constrained")
    for panel, member in zip(axes.flat, members, strict=True):
        for model, style in STYLES.items():
            time = member.surfaces[model]["time"].values
            curves = amplitudes(member, model, np.array(POSITIONS)).T
            for X, colour, curve in zip(POSITIONS, COLOURS, curves, strict=True):
                label = f"X = {X * 1e3:g} mm, {model}"
                panel.plot(time * 1e3, curve * 1e3, style, color=colour, lw=1.2, label=label)
        panel.set_title(title(member))
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=8)
    figure.supxlabel("time (ms)")
    figure.supylabel("wrinkle amplitude (mm)")
    return figure


def draw_profiles(members: list[Member], times: tuple[float, ...] = (0.8e-3, 1.2e-3, 2e-3)) -> plt.Figure:
    """Amplitude against material position at three times, one panel per member."""
    figure, axes = plt.subplots(2, 2, figsize=(9, 7.4), sharex=True, sharey=True, layout="constrained")
    X = np.linspace(4e-3, 46e-3, 200)
    for panel, member in zip(axes.flat, members, strict=True):
        for model, style in STYLES.items():
            known = member.surfaces[model]["time"].values
            curves = amplitudes(member, model, X)
            for time, colour in zip(times, COLOURS, strict=True):
                curve = curves[int(np.argmin(np.abs(known - time)))]
                label = f"t = {time * 1e3:g} ms, {model}"
                panel.plot(X * 1e3, curve * 1e3, style, color=colour, lw=1.2, label=label)
        panel.set_title(title(member))
    figure.legend(*axes[0, 0].get_legend_handles_labels(), loc="outside upper center", ncols=3, fontsize=8)
    figure.supxlabel("undeformed position X (mm)")
    figure.supylabel("wrinkle amplitude (mm)")
    return figure


if __name__ == "__main__":
    main()
