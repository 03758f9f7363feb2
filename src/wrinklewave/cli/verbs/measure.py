"""``wrinklewave measure``: from a recording to surface motion, speeds and wrinkles."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from wrinklewave.cli.options import Overrides

if TYPE_CHECKING:
    from wrinklewave.config.experiment import Experiment

QUASI_STATIC_HEADLINE = (
    "images",
    "strain_max",
    "critical_strain",
    "critical_strain_sigma",
    "critical_wavelength_m",
    "critical_wavelength_sigma_m",
    "critical_wavelength_compressed_m",
    "initial_amplitude_m",
    "period_doubling_strain",
    "second_critical_strain",
    "second_to_first_amplitude_median",
)
HEADLINE = (
    "frames_measured",
    "contrast_to_noise",
    "striker_velocity_m_per_s",
    "wavefront_speed_m_per_s",
    "wavefront_speed_origin_line_m_per_s",
    "wrinkle_speed_m_per_s",
    "wrinkle_amplitude_max_m",
    "wavelength_m",
    "surface_sigma_px",
    "struck_end_sigma_px",
    "wire_sigma_px",
    "pixel_locking_px",
)

ExperimentFile = Annotated[Path, typer.Argument(metavar="EXPERIMENT", help="Experiment file (TOML).")]
Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Folder for the results; default runs/NAME-OF-THE-FILE."),
]
Threads = Annotated[
    int | None,
    typer.Option("--threads", metavar="N", min=1, help="Default: all cores. Results do not depend on it."),
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with an interrupted measurement in DIR.")]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace an earlier measurement in DIR.")]


def measure(
    experiment: ExperimentFile,
    out: Out = None,
    threads: Threads = None,
    overrides: Overrides = None,
    resume: Resume = False,
    overwrite: Overwrite = False,
) -> None:
    """Measure a recording; write surface motion, moments, speeds, wrinkles, figures and a report.

    Of a quasi-static test: amplitude and wavelength against strain, critical strain and wavelength.
    """
    from wrinklewave.config.experiment import load_experiment

    loaded = load_experiment(experiment, overrides or ())
    folder = out or Path("runs") / experiment.name.removesuffix(".toml").removesuffix(".experiment")
    procedure = _measure_impact if loaded.kind == "impact" else _measure_quasi_static
    procedure(loaded, folder, threads=threads, resume=resume, overwrite=overwrite)


def _measure_impact(
    experiment: Experiment, folder: Path, *, threads: int | None, resume: bool, overwrite: bool
) -> None:
    from wrinklewave.cli.console import console
    from wrinklewave.cli.progress import COMPILING, shown_progress
    from wrinklewave.experiments.interruption import Outcome
    from wrinklewave.experiments.measure import measure as measure_experiment
    from wrinklewave.report import summary_table
    from wrinklewave.report.measurement import present_measurement

    screen = console()
    with shown_progress(experiment.name, COMPILING) as progress:
        found = measure_experiment(
            experiment, out=folder, threads=threads, resume=resume, overwrite=overwrite, progress=progress
        )
    if found.outcome is not Outcome.FINISHED:
        screen.print(found.outcome.value)
        raise typer.Exit(130)
    report = present_measurement(found)
    screen.print(summary_table(found.summary, HEADLINE))
    for warning in found.warnings:
        screen.print(f"[yellow]{warning}[/yellow]")
    screen.print(f"finished in {found.summary['wall_time_s']:.1f} s; look at {report}")


def _measure_quasi_static(
    experiment: Experiment, folder: Path, *, threads: int | None, resume: bool, overwrite: bool
) -> None:
    from wrinklewave.cli.console import console
    from wrinklewave.cli.progress import COMPILING, shown_progress
    from wrinklewave.experiments.interruption import Outcome
    from wrinklewave.experiments.measure_quasi_static import measure_quasi_static
    from wrinklewave.report import summary_table
    from wrinklewave.report.quasi_static import present_measured_test

    screen = console()
    with shown_progress(experiment.name, COMPILING) as progress:
        found = measure_quasi_static(
            experiment, out=folder, threads=threads, resume=resume, overwrite=overwrite, progress=progress
        )
    if found.outcome is not Outcome.FINISHED:
        screen.print(found.outcome.value)
        raise typer.Exit(130)
    report = present_measured_test(found)
    shown = [name for name in QUASI_STATIC_HEADLINE if name in found.summary]
    screen.print(summary_table(found.summary, shown))
    for warning in found.warnings:
        screen.print(f"[yellow]{warning}[/yellow]")
    screen.print(f"look at {report}")
