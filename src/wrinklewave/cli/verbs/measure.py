"""``wrinklewave measure``: from a recording to surface motion, speeds and wrinkles."""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
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
    "critical_wavelength_m",
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
    begin = time.perf_counter()
    from wrinklewave.config.experiment import load_experiment

    loaded = load_experiment(experiment, overrides or ())
    folder = out or Path("runs") / experiment.name.removesuffix(".toml").removesuffix(".experiment")
    options = {"threads": threads, "resume": resume, "overwrite": overwrite}
    if loaded.kind == "impact":
        from wrinklewave.experiments.measure import measure as measure_impact
        from wrinklewave.report.measurement import present_measurement

        _carry_out(measure_impact, present_measurement, HEADLINE, loaded, folder, options, begin)
    else:
        from wrinklewave.experiments.measure_quasi_static import measure_quasi_static
        from wrinklewave.report.quasi_static import present_measured_test

        _carry_out(
            measure_quasi_static, present_measured_test, QUASI_STATIC_HEADLINE, loaded, folder, options, begin
        )


def _carry_out(
    procedure: Callable[..., Any],
    present: Callable[..., Path],
    headline: Sequence[str],
    experiment: Experiment,
    folder: Path,
    options: dict[str, Any],
    begin: float,
) -> None:
    """Measure by a procedure and show what came out; exit code 130 if it was interrupted.

    ``begin`` is when the command was given, on the clock of ``time.perf_counter``.
    """
    from rich.markup import escape

    from wrinklewave.cli.console import console
    from wrinklewave.cli.progress import MEASURING, shown_progress
    from wrinklewave.experiments.interruption import Outcome
    from wrinklewave.figures.beside import helper_beside
    from wrinklewave.report import summary_table

    screen = console()
    with helper_beside() as helper, _resumable(folder):
        with shown_progress(experiment.name, MEASURING) as progress:
            found = procedure(experiment, out=folder, progress=progress, **options)
        if found.outcome is not Outcome.FINISHED:
            raise KeyboardInterrupt
        measured = time.perf_counter()
        with screen.status("figures and report"):
            report = present(found, helper)
    screen.print(summary_table(found.summary, headline))
    for warning in found.warnings:
        screen.print(f"[yellow]{escape(warning)}[/yellow]")
    end = time.perf_counter()
    print(
        f"finished in {end - begin:.1f} s, {end - measured:.1f} s of them for figures and report; look at {report}"
    )


@contextmanager
def _resumable(folder: Path) -> Iterator[None]:
    """Say how to go on after Ctrl-C, once there is something to go on with."""
    try:
        yield
    except KeyboardInterrupt as interrupt:
        if not (folder / "experiment.toml").exists():
            raise
        print("interrupted; go on with the same command and --resume")
        raise typer.Exit(130) from interrupt
