"""``wrinklewave simulate``: from a case file to fields, figures and numbers."""

from __future__ import annotations

import shlex
import time
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from wrinklewave.cli.options import CaseFile, Overrides

if TYPE_CHECKING:
    from wrinklewave.config import Case
    from wrinklewave.experiments.run_folder import RunFolder
    from wrinklewave.experiments.simulate import Run

HEADLINE = (
    "wavefront_speed_m_per_s",
    "wavefront_speed_origin_line_m_per_s",
    "wrinkle_speed_m_per_s",
    "strain_rate_max_per_s",
    "wrinkle_amplitude_max_m",
    "energy_imbalance_max",
    "hourglass_energy_share_max",
    "steps",
    "element_updates_per_s",
)

Out = Annotated[
    Path | None,
    typer.Option("--out", metavar="DIR", help="Folder for the results; default runs/NAME-OF-THE-CASE-FILE."),
]
Threads = Annotated[
    int | None,
    typer.Option("--threads", metavar="N", help="Default: all cores. Results do not depend on it."),
]
Device = Annotated[
    str,
    typer.Option(
        "--device", metavar="cpu|cuda|auto", help="Where to step; auto takes the GPU if there is one."
    ),
]
Resume = Annotated[
    bool, typer.Option("--resume", help="Go on from the last checkpoint in DIR, if there is one.")
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace an earlier run in DIR.")]
AllBulk = Annotated[
    bool,
    typer.Option(
        "--all-bulk",
        help="Also run the other two choices of bulk response, for the comparison with the paper.",
    ),
]


def simulate(
    case: CaseFile,
    out: Out = None,
    threads: Threads = None,
    device: Device = "cpu",
    overrides: Overrides = None,
    resume: Resume = False,
    overwrite: Overwrite = False,
    all_bulk: AllBulk = False,
) -> None:
    """Simulate a case; write surface motion, fields, energies, figures and a report."""
    begin = time.perf_counter()
    from wrinklewave.config import load_case

    loaded = load_case(case, overrides or ())
    folder = out or Path("runs") / case.stem
    where = {"threads": threads, "device": device}
    run_and_present(loaded, folder, where, begin, resume=resume, overwrite=overwrite, all_bulk=all_bulk)


def run_and_present(
    case: Case,
    folder: Path,
    where: dict[str, Any],
    begin: float,
    *,
    resume: bool,
    overwrite: bool,
    all_bulk: bool,
) -> None:
    """Run a case in ``folder`` and show what came out; exit code 130 if it was interrupted.

    ``where`` are the threads and the device, as :func:`wrinklewave.simulate` takes them; ``begin`` is when the command
    was given, on the clock of ``time.perf_counter``.
    """
    from wrinklewave.cli.console import console
    from wrinklewave.experiments.run_folder import RunFolder
    from wrinklewave.figures.beside import helper_beside

    place = RunFolder(folder)
    if resume and not all_bulk and place.is_finished():
        place.demand(case)
        print(f"finished already; look at {folder / 'report.html'}")
        return
    with helper_beside() as helper:
        from wrinklewave.experiments.paper_statements import BULK_CHOICES
        from wrinklewave.report import comparison_table
        from wrinklewave.report.run import compare_with_paper, present

        run = _run(case, place, where, resume=resume, overwrite=overwrite)
        summaries: dict[str, dict[str, Any]] = {case.substrate.bulk_response: run.summary}
        if all_bulk:
            summaries = _other_bulk_choices(run, where, resume=resume)
        rows = compare_with_paper(run, summaries)
        simulated = time.perf_counter()
        try:
            with console().status("figures and report"):
                present(run, rows, helper)
        except KeyboardInterrupt as interrupt:
            raise _interrupted("while the report was written", folder) from interrupt
    place.close(run)
    if all_bulk:
        console().print(comparison_table(rows))
    _describe(run)
    end = time.perf_counter()
    print(
        f"finished in {end - begin:.1f} s, {end - simulated:.1f} s of them for figures and report; "
        f"look at {folder / 'report.html'}"
    )
    missing = [choice for choice in BULK_CHOICES if all_bulk and choice not in summaries]
    if missing:
        raise _interrupted(f"before {' and '.join(missing)}", folder, "--all-bulk")


def _run(case: Case, place: RunFolder, where: dict[str, Any], *, resume: bool, overwrite: bool) -> Run:
    from wrinklewave.cli.progress import STEPPING, shown_progress
    from wrinklewave.experiments.interruption import Outcome
    from wrinklewave.experiments.simulate import simulate as run_case

    options = where | {"resume": resume, "overwrite": overwrite, "keep_checkpoint": True}
    try:
        with shown_progress(case.name, STEPPING) as progress:
            run = run_case(case, out=place.path, **options, progress=progress)
    except KeyboardInterrupt as interrupt:
        if not place.checkpoint.exists():
            raise
        raise _interrupted("before all was written", place.path) from interrupt
    if run.outcome is not Outcome.FINISHED:
        raise _interrupted(f"at {1e3 * run.summary['simulated_time_s']:g} ms", place.path)
    return run


def _other_bulk_choices(run: Run, where: dict[str, Any], *, resume: bool) -> dict[str, dict[str, Any]]:
    from wrinklewave.cli.progress import STEPPING, shown_progress
    from wrinklewave.experiments.bulk_choices import other_bulk_choices

    with shown_progress(f"{run.case.name}, other bulk responses", STEPPING) as progress:
        return other_bulk_choices(run, **where, resume=resume, progress=lambda choice, state: progress(state))


def _interrupted(where: str, folder: Path, *options: str) -> typer.Exit:
    print(
        f"interrupted {where}; go on with:  {shlex.join(('wrinklewave', 'restart', str(folder), *options))}"
    )
    return typer.Exit(130)


def _describe(run: Run) -> None:
    from wrinklewave.cli.console import console
    from wrinklewave.report import summary_table
    from wrinklewave.report.run import warnings

    out = console()
    slow = run.case.drive.kind == "compression"  # without fronts
    out.print(summary_table(run.summary, [name for name in HEADLINE if not (slow and "_speed_" in name)]))
    for warning in warnings(run.summary):
        out.print(f"[yellow]{warning}[/yellow]")
