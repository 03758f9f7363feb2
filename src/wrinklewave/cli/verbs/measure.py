"""``wrinklewave measure``: from a recording to surface motion, speeds and wrinkles."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

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
    options = {"threads": threads, "resume": resume, "overwrite": overwrite}
    if loaded.kind == "impact":
        from wrinklewave.experiments.measure import measure as measure_impact
        from wrinklewave.report.measurement import present_measurement

        _carry_out(measure_impact, present_measurement, HEADLINE, loaded, folder, options)
    else:
        from wrinklewave.experiments.measure_quasi_static import measure_quasi_static
        from wrinklewave.report.quasi_static import present_measured_test

        _carry_out(
            measure_quasi_static, present_measured_test, QUASI_STATIC_HEADLINE, loaded, folder, options
        )


def _carry_out(
    procedure: Callable[..., Any],
    present: Callable[[Any], Path],
    headline: Sequence[str],
    experiment: Experiment,
    folder: Path,
    options: dict[str, Any],
) -> None:
    """Measure by a procedure and show what came out; exit code 130 if it was interrupted."""
    from wrinklewave.cli.console import console
    from wrinklewave.cli.progress import COMPILING, shown_progress
    from wrinklewave.experiments.interruption import Outcome
    from wrinklewave.report import summary_table

    screen = console()
    begin = time.perf_counter()
    with shown_progress(experiment.name, COMPILING) as progress:
        found = procedure(experiment, out=folder, progress=progress, **options)
    if found.outcome is not Outcome.FINISHED:
        screen.print(found.outcome.value)
        raise typer.Exit(130)
    report = present(found)
    screen.print(summary_table(found.summary, headline))
    for warning in found.warnings:
        screen.print(f"[yellow]{warning}[/yellow]")
    screen.print(f"finished in {time.perf_counter() - begin:.1f} s; look at {report}")
