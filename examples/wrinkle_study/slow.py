"""The quasi-static half of the study: four wrinkles between guides, slowly compressed to 25 % and unloaded."""

from __future__ import annotations

from pathlib import Path

import matplotlib as mpl
import numpy as np

mpl.use("Agg")
import matplotlib.pyplot as plt

from wrinklewave.config import Case, load_case
from wrinklewave.experiments.slow_wrinkles import Modes, critical_strains, doubling_strains, modes, onset
from wrinklewave.experiments.wrinkle_study import surface_of_run
from wrinklewave.materials.moduli import substrate_moduli
from wrinklewave.theory.bifurcation import Bifurcation, bifurcation
from wrinklewave.theory.film import film_material
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude

BASE = Path(__file__).parents[1] / "quasi_static_wrinkles.toml"
ONSET = (
    "drive.strain=0.046",
    "drive.duration=40 ms",
    "drive.unload=false",
    "solver.end_time=40 ms",
    "output.field_interval=20 ms",
)
MODE = 8
"""Of the four wrinkles: eight half waves."""
EXACT = ((0.06, 0.70031), (0.10, 1.23846), (0.16, 1.73197))
"""Strain and amplitude over thickness of static wrinkles at k h = 0.384467, an independent computation to 2e-4."""


def study(out: Path) -> None:
    """Run or read both compressions, print the numbers and draw them."""
    begins = load_case(BASE, ONSET)
    exact = bifurcation(*(film_and_substrate(begins)))
    print_onset(modes(surface_of_run(begins, out / "slow_onset")), begins, exact)

    profile = out / "four_wrinkles.csv"
    write_profile(profile, begins.block.length)
    case = load_case(BASE, [f"film.imperfection={{kind='profile', file='{profile.absolute()}'}}"])
    surface = surface_of_run(case, out / "slow_compression")
    wrinkles = modes(surface)
    print_amplitudes(wrinkles, case, exact)
    draw(wrinkles, case, exact, surface["X"].values, surface["x_p"].values, surface["y_p"].values).savefig(
        out / "slow.png", dpi=130
    )


def film_and_substrate(case: Case):  # type: ignore[no-untyped-def]
    """Relaxing moduli of both."""
    assert case.film is not None
    return film_material(case.film, case.substrate), substrate_moduli(case.substrate)


def write_profile(path: Path, length: float) -> None:
    """An imperfection of 2 um with the wavelength of the wrinkles, and a tenth of it with about twice as long ones.

    With troughs at the guides: when the period doubles, every second trough deepens, which crests there would forbid.
    """
    X = np.linspace(0.0, length, 1001)
    height = -2e-6 * np.cos(MODE * np.pi * X / length)
    height += 2e-7 * np.cos(np.pi * X[:, np.newaxis] / length * np.array([3, 4, 5])).sum(axis=1)
    text = "x_m,height_m\n" + "".join(f"{x:.9g},{y:.9g}\n" for x, y in zip(X, height, strict=True))
    if not path.exists() or path.read_text(encoding="utf-8") != text:  # a new file would make its run anew
        path.write_text(text, encoding="utf-8")


def print_onset(wrinkles: Modes, case: Case, exact: Bifurcation) -> None:
    """Critical strain and wavelength against the exact bifurcation."""
    assert case.film is not None
    numbers = np.arange(6, 12)
    strain, mode = onset(numbers, critical_strains(wrinkles, numbers, near=exact.critical_strain))
    wavelength, expected = wrinkles.wavelength(mode), exact.wavelength * case.film.thickness
    for what, found, true, unit in (
        ("critical strain", strain, exact.critical_strain, ""),
        ("critical wavelength", wavelength * 1e3, expected * 1e3, " mm"),
    ):
        print(f"{what} {found:.5f}{unit}, exact {true:.5f}{unit} ({100 * (found / true - 1):+.1f} %)")


def print_amplitudes(wrinkles: Modes, case: Case, exact: Bifurcation) -> None:
    """Amplitudes against Eq. 1 and exact ones, period doubling, and what is left after unloading."""
    assert case.film is not None
    h, loading = case.film.thickness, wrinkles.loading()
    for strain, expected in EXACT:
        found = float(np.interp(strain, loading.strain, np.abs(loading.amplitudes[MODE])))
        eq_1 = float(eq_1_amplitude(strain, exact, h))
        error, over = 100 * (found / h / expected - 1), found / eq_1
        print(
            f"A/h at {strain:g}: {found / h:.4f}, exact {expected:.4f} ({error:+.1f} %), over Eq. 1 {over:.3f}"
        )
    appears, gone = doubling_strains(wrinkles, MODE)
    print(f"period doubling from a strain of {appears:.4f} in loading, down to {gone:.4f} in unloading")
    first, last = (np.abs(wrinkles.amplitudes[1:, row]).max() * 1e6 for row in (0, -1))
    print(f"largest mode before {first:.2f} um, after unloading {last:.2f} um")


def eq_1_amplitude(strain, exact: Bifurcation, thickness: float):  # type: ignore[no-untyped-def]
    """Eq. 1 with the exact critical strain and wavelength [m]."""
    return wrinkle_amplitude(
        strain, critical_strain=exact.critical_strain, critical_wavelength=exact.wavelength * thickness
    )


def draw(wrinkles: Modes, case: Case, exact: Bifurcation, X, x_p, y_p) -> plt.Figure:  # type: ignore[no-untyped-def]
    """Modes against strain, and the surface at some strains."""
    assert case.film is not None
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.4), layout="constrained")
    top = int(wrinkles.strain.argmax())
    for mode, colour, name in ((MODE, "#c1272d", "wrinkles"), (MODE // 2, "#0000a7", "twice the wavelength")):
        size = np.abs(wrinkles.amplitudes[mode]) * 1e3
        left.plot(wrinkles.strain[:top], size[:top], color=colour, label=f"{name}, loading")
        left.plot(wrinkles.strain[top:], size[top:], "--", color=colour, label=f"{name}, unloading")
    strain = np.linspace(0.0, 0.25, 501)
    left.plot(
        strain, eq_1_amplitude(strain, exact, case.film.thickness) * 1e3, ":", color="black", label="Eq. 1"
    )
    left.plot(
        *zip(*[(e, a * case.film.thickness * 1e3) for e, a in EXACT], strict=True), "ko", ms=5, label="exact"
    )
    for at, name in zip(doubling_strains(wrinkles, MODE), ("doubles", "simple again"), strict=True):
        left.axvline(at, color="0.7", lw=0.8, zorder=0)
        left.annotate(
            name,
            (at, 1.0),
            xycoords=("data", "axes fraction"),
            xytext=(0, 2),
            textcoords="offset points",
            ha="left" if name == "doubles" else "right",
            fontsize=8,
            color="0.4",
        )
    left.set(xlabel="nominal strain", ylabel="amplitude of the mode (mm)", xlim=(0, 0.255), ylim=(0, None))
    left.legend(frameon=False, fontsize=8)
    for number, at in enumerate((0.10, 0.18, 0.21, 0.25)):
        row = int(np.argmin(np.abs(wrinkles.strain[: top + 1] - at)))
        height = y_p[row] - y_p[row].mean()
        right.plot((x_p[row] - x_p[row, 0]) * 1e3, height * 1e3 - 1.3 * number, color="black", lw=1.2)
        right.text(8.7, -1.3 * number, f"strain {at:.2f}", va="center", fontsize=8)
    right.set(
        xlabel="along the film (mm)", ylabel="height (mm), curves set off", xlim=(0, 10), aspect="equal"
    )
    for panel in (left, right):
        panel.spines[["top", "right"]].set_visible(False)
    return figure
