"""The same impact under each choice of bulk response, which the paper leaves open."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from wrinklewave.experiments.interruption import Outcome
from wrinklewave.experiments.paper_statements import BULK_CHOICES
from wrinklewave.experiments.run_progress import Progress
from wrinklewave.experiments.simulate import Run, simulate

if TYPE_CHECKING:
    from pathlib import Path

    from wrinklewave.config import Case


def with_bulk_response(case: Case, choice: str) -> Case:
    """The same case with another bulk response, and fields at its end only: it is there for its numbers."""
    end = f"output.field_interval={case.solver.end_time} s"
    return case.overridden(f"substrate.bulk_response={choice}", end)


def other_bulk_choices(
    run: Run,
    *,
    threads: int | None = None,
    device: str = "cpu",
    resume: bool = False,
    progress: Callable[[str, Progress], None] = lambda choice, state: None,
) -> dict[str, dict[str, Any]]:
    """Summaries of a finished run's case by bulk response: its own, and those of the choices it did not make.

    The other runs go to ``bulk/CHOICE`` in the run's folder, if it has one. Stops at an interrupt.

    Raises:
        RunError: as :func:`simulate`.
    """
    found: dict[str, dict[str, Any]] = {run.case.substrate.bulk_response: run.summary}
    for choice in BULK_CHOICES:
        if choice in found:
            continue
        other = simulate(
            with_bulk_response(run.case, choice),
            out=_folder(run.folder, choice),
            threads=threads,
            device=device,
            resume=resume,
            overwrite=not resume,
            progress=lambda state, choice=choice: progress(choice, state),  # type: ignore[misc]
        )
        if other.outcome is not Outcome.FINISHED:
            break
        found[choice] = other.summary
    return {choice: found[choice] for choice in (*BULK_CHOICES, *found) if choice in found}


def _folder(folder: Path | None, choice: str) -> Path | None:
    return folder / "bulk" / choice if folder else None
