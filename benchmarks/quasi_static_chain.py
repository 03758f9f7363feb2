"""The quasi-static test from images to critical values, against films of compressions whose numbers are known.

    python -m benchmarks.quasi_static_chain [DOCS]

writes ``tables/quasi_static.md`` and ``images/quasi_static_*.png`` into DOCS, by default ``docs``. Takes half a minute,
most of it the simulated compression.
"""

from __future__ import annotations

import shutil
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np

import wrinklewave as ww
from wrinklewave.report.quasi_static import present_measured_test
from wrinklewave.wrinkling.slow_compression import SlowCompression

ROOT = Path(__file__).parents[1]
CONTRAST_TO_NOISE = 20.0
STRAINS = tuple(np.linspace(0.0, 0.2, 41).tolist())
WINDOW = 'analysis.amplitude_window=["12 mm", "45 mm"]'
FITTED = "fit.strains=[0.0, 0.17]"  # the period doubles at 0.17
MARGINS = (6e-3, 2.5e-3)
COMPRESSIONS = {
    "first wrinkles": SlowCompression(strains=STRAINS, margins=MARGINS),
    "wrinkled before, 10 µm": SlowCompression(strains=STRAINS, margins=MARGINS, initial_amplitude=10e-6),
    "period doubles at 0.17": SlowCompression(strains=STRAINS, margins=MARGINS, doubling_strain=0.17),
    "another film": SlowCompression(
        strains=STRAINS, margins=MARGINS, critical_strain=0.06, wavelength=1.4e-3
    ),
}
SHOWN = {"1d_amplitude": "amplitude", "s6_repetition": "repetition"}


def main() -> None:
    """Film, measure, write table and pictures."""
    docs = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs"
    with tempfile.TemporaryDirectory() as folder:
        text = "\n".join(table(Path(folder))) + "\n"
        pictures(Path(folder), docs / "images")
    print(text)
    (docs / "tables" / "quasi_static.md").write_text(text, encoding="utf-8")


def table(folder: Path) -> Iterator[str]:
    """Fitted against true values, a line for each compression."""
    yield (
        "| compression | ε_c true | ε_c fitted | error | λ_c true (mm) | λ_c fitted (mm) | error "
        "| A_i true, fitted (µm) |"
    )
    yield "| --- | --- | --- | --- | --- | --- | --- | --- |"
    for number, (name, made) in enumerate(COMPRESSIONS.items()):
        ww.write_surface(made.surface(), folder / f"{number}.nc")
        changes = [WINDOW, *([FITTED] if made.doubling_strain else [])]
        yield line(name, made, measured(folder / f"{number}.nc", number, changes))
    run = ww.simulate(ROOT / "examples" / "quasi_static_compression.toml", out=folder / "run")
    assert run.folder is not None
    film = SlowCompression(critical_strain=0.043, wavelength=2e-3)
    yield line("the paper's block, simulated", film, measured(run.folder, len(COMPRESSIONS), []))


def measured(motion: Path, seed: int, changes: list[str]) -> dict[str, Any]:
    """Film a surface motion, measure it, return the summary."""
    film = ww.film_run(motion, motion.with_suffix(".tif"), contrast_to_noise=CONTRAST_TO_NOISE, seed=seed)
    return ww.measure_quasi_static(film.experiment, overrides=changes).summary


def line(name: str, made: SlowCompression, found: dict[str, Any]) -> str:
    """One line of the table."""
    strain, wavelength = found["critical_strain"], found["critical_wavelength_m"]
    cells = (
        name,
        f"{made.critical_strain:g}",
        f"{strain:.4f} ± {found['critical_strain_sigma']:.4f}",
        f"{strain / made.critical_strain - 1:+.1%}",
        f"{1e3 * made.wavelength:g}",
        f"{1e3 * wavelength:.4f} ± {1e3 * found['critical_wavelength_sigma_m']:.4f}",
        f"{wavelength / made.wavelength - 1:+.2%}",
        f"{1e6 * made.initial_amplitude:g}, {1e6 * found['initial_amplitude_m']:.1f} ± "
        f"{1e6 * found['initial_amplitude_sigma_m']:.1f}",
    )
    return f"| {' | '.join(cells)} |"


def pictures(folder: Path, images: Path) -> None:
    """The figures of two tests on one sample, the first wrinkled before, the second at a larger strain."""
    both = {
        "first": SlowCompression(
            strains=STRAINS, margins=MARGINS, initial_amplitude=10e-6, doubling_strain=0.17
        ),
        "second": SlowCompression(
            strains=STRAINS, margins=MARGINS, critical_strain=0.047, doubling_strain=0.17
        ),
    }
    for seed, (name, made) in enumerate(both.items()):
        ww.write_surface(made.surface(), folder / f"{name}.nc")
        ww.film_run(
            folder / f"{name}.nc", folder / f"{name}.tif", contrast_to_noise=CONTRAST_TO_NOISE, seed=seed
        )
    text = (folder / "first.experiment.toml").read_text(encoding="utf-8")
    (folder / "both.toml").write_text(f'{text}\n[second_series]\nfile = "second.tif"\n', encoding="utf-8")
    found = ww.measure_quasi_static(folder / "both.toml", out=folder / "both", overrides=[WINDOW, FITTED])
    present_measured_test(found)
    images.mkdir(parents=True, exist_ok=True)
    for figure, name in SHOWN.items():
        shutil.copyfile(
            folder / "both" / "figures" / f"fig_{figure}.png", images / f"quasi_static_{name}.png"
        )


if __name__ == "__main__":
    main()
