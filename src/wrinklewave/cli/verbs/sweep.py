"""``wrinklewave sweep``: every combination of chosen values of a case."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from wrinklewave.cli.options import CaseFile, Overrides
from wrinklewave.cli.verbs.simulate import Device, Overwrite

if TYPE_CHECKING:
    from collections.abc import Callable

    from wrinklewave.experiments.sweep import SweepProgress

Over = Annotated[
    list[str],
    typer.Option(
        "--over",
        metavar="KEY=VALUES",
        help='Go over values of the file: --over "drive.velocity=5 m/s, 10 m/s".',
    ),
]
Out = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="DIR", help="Folder for the runs; default runs/NAME-OF-THE-CASE-FILE-sweep."
    ),
]
Jobs = Annotated[
    int | None,
    typer.Option(
        "--jobs",
        metavar="N",
        min=1,
        help="Processes, each with one run at a time, or with a batch of runs on a GPU; default one per core.",
    ),
]
Resume = Annotated[bool, typer.Option("--resume", help="Go on with the sweep in DIR.")]


def sweep(
    case: CaseFile,
    over: Over,
    out: Out = None,
    overrides: Overrides = None,
    jobs: Jobs = None,
    device: Device = "cpu",
    resume: Resume = False,
    overwrite: Overwrite = False,
) -> None:
    """Simulate every combination of values; write their results as one dataset and one table."""
    from wrinklewave.cli.progress import told_if_slow
    from wrinklewave.experiments.interruption import Outcome
    from wrinklewave.experiments.sweep import sweep as run_sweep

    folder = out or Path("runs") / f"{case.stem}-sweep"
    with told_if_slow(
        f"{case.stem}: the first runs are under way; on a new machine they wait for kernels"
    ) as begun:
        outcome, table = run_sweep(
            case,
            over,
            out=folder,
            overrides=overrides or (),
            jobs=jobs,
            device=device,
            resume=resume,
            overwrite=overwrite,
            progress=lambda state: _say(state, begun),
        )
    if outcome is not Outcome.FINISHED:
        print(outcome.value)
        raise typer.Exit(130)
    failed = int((table["outcome"] != "finished").sum())
    print(f"{table['outcome'].size} runs, {failed} of them failed; look at {folder / 'sweep.csv'}")


def _say(state: SweepProgress, begun: Callable[[], None]) -> None:
    begun()
    where = f"{state.done} of {state.total}, {state.runs_per_minute:.3g} runs per minute"
    print(f"{where}: {state.name}: {state.summary['outcome']}", flush=True)
