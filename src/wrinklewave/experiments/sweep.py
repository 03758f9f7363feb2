"""Many runs of one case: every combination of chosen values, side by side, each on a thread of its own."""

from __future__ import annotations

import itertools
import json
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Future, wait
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wrinklewave.config import Case, load_case
from wrinklewave.config.overrides import alternatives
from wrinklewave.environment import choose_device, processor
from wrinklewave.errors import InputError
from wrinklewave.experiments.batch import batches, processes_at_once
from wrinklewave.experiments.interruption import Outcome, interruptible
from wrinklewave.experiments.run_folder import demand_one_wish
from wrinklewave.experiments.sweep_table import write_tables
from wrinklewave.experiments.sweep_workers import Workers, run_batch, run_member

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.dynamics.backends import Device

PATIENCE = 0.2
"""Seconds between two looks at whether an interrupt has come."""


@dataclass(frozen=True, eq=False)
class Member:
    """One run of a sweep.

    Args:
        place: of its value along each axis.
        overrides: that make its case of the common one.
        case: its case.
        folder: of its results.
    """

    place: tuple[int, ...]
    overrides: tuple[str, ...]
    case: Case
    folder: Path

    @property
    def name(self) -> str:
        """What is particular to it."""
        return ", ".join(self.overrides)


@dataclass(frozen=True)
class SweepProgress:
    """A run of a sweep has ended.

    Args:
        done: runs that have ended.
        total: all runs.
        name: what is particular to the one that has just ended.
        summary: its scalar results.
        runs_per_minute: since the sweep was started or resumed.
    """

    done: int
    total: int
    name: str
    summary: dict[str, Any]
    runs_per_minute: float


def sweep(
    case: str | Path | Case,
    over: Sequence[str],
    *,
    out: str | Path,
    overrides: Sequence[str] = (),
    jobs: int | None = None,
    device: str = "cpu",
    resume: bool = False,
    overwrite: bool = False,
    progress: Callable[[SweepProgress], None] = lambda state: None,
) -> tuple[Outcome, xr.Dataset]:
    """Run every combination of values, and gather the scalar results in one dataset.

    A run that fails is part of the result: ``outcome`` says so, its numbers are NaN, ``message`` in its summary says
    why. The other runs go on.

    Args:
        case: a case, or the path of a case file.
        over: the axes, each ``"key=value, value, ..."``.
        out: folder for the runs, the dataset ``sweep.nc`` and the table ``sweep.csv``.
        overrides: ``"key=value"`` for all runs.
        jobs: processes, default one per core, on a GPU as far as its memory goes. Each has one run at a time, on one
            thread, or a batch of them on a GPU.
        device: as for :func:`simulate`.
        resume: go on with the sweep in ``out``: runs that have ended stay as they are, others go on.
        overwrite: replace an earlier sweep in ``out``.
        progress: called when a run has ended.

    Returns:
        How it ended, and the dataset: one dimension per axis, one variable per scalar result of the runs' summaries.

    Raises:
        InputError: if a combination makes no case, or ``out`` holds another sweep.
    """
    axes = [alternatives(text) for text in over]
    members = list(_members(case, axes, overrides, Path(out)))
    chosen = choose_device(device)
    _prepare(members, Path(out), resume=resume, overwrite=overwrite)
    left = [member for member in members if _ended(member) is None]
    jobs = min(jobs or _processes(chosen), len(members))
    begin, to_run = time.perf_counter(), len(left)
    with Workers(jobs) as workers, interruptible() as wished:
        waiting = _submit(left, workers, jobs, chosen)
        while waiting and not wished():
            done, waiting = wait(waiting, PATIENCE, FIRST_COMPLETED)
            for future in done:
                future.result()  # raises what ends more than a run
            for member, summary in [(m, s) for m in left if (s := _ended(m))]:
                left.remove(member)
                pace = 60 * (to_run - len(left)) / (time.perf_counter() - begin)
                progress(SweepProgress(len(members) - len(left), len(members), member.name, summary, pace))
    table = write_tables(Path(out), axes, [(member, _ended(member) or {}) for member in members])
    return (Outcome.INTERRUPTED if waiting else Outcome.FINISHED), table


def _processes(device: Device) -> int:
    """One per core, as far as a GPU has room for them."""
    cores = processor().usable
    return cores if device == "cpu" else processes_at_once(cores)


def _submit(members: Sequence[Member], workers: Workers, jobs: int, device: Device) -> set[Future[None]]:
    """Have members run, one by one or in batches; their summaries tell that they have ended."""
    runs = [(member.case, member.folder) for member in members]
    if device == "cpu" or not runs:
        return {workers.submit(run_member, *run) for run in runs}
    together = batches([case for case, _ in runs], jobs)
    return {workers.submit(run_batch, [runs[place] for place in places]) for places in together}


def _members(
    case: str | Path | Case, axes: Sequence[tuple[str, tuple[str, ...]]], overrides: Sequence[str], out: Path
) -> Iterator[Member]:
    if len({key for key, _ in axes}) < len(axes):
        raise InputError("goes over one key twice", file="--over", cure="give all its values at once")
    for key, values in axes:
        if len(set(values)) < len(values):
            raise InputError("a value twice", file="--over", key=key, cure="leave one out")
    places = itertools.product(*(range(len(values)) for _, values in axes))
    for n, place in enumerate(places):
        own = tuple(f"{key}={values[k]}" for (key, values), k in zip(axes, place, strict=True))
        yield Member(place, own, _case_of(case, overrides, own), out / "runs" / f"{n:04d}")


def _case_of(case: str | Path | Case, overrides: Sequence[str], own: Sequence[str]) -> Case:
    """The case of one combination; a mistake in its own values is one of ``--over``."""
    choices = (*overrides, *own)
    try:
        return case.overridden(*choices) if isinstance(case, Case) else load_case(case, choices)
    except InputError as error:
        if error.file != "--set" or not any(choice.startswith(f"{error.key}=") for choice in own):
            raise
        raise InputError(
            error.problem, file="--over", key=error.key, expected=error.expected, cure=error.cure
        ) from error


def _prepare(members: Sequence[Member], out: Path, *, resume: bool, overwrite: bool) -> None:
    """See that the folder is free, or holds this very sweep."""
    if any((out / name).exists() for name in ("case.toml", "experiment.toml")):
        raise InputError("holds a run or a measurement", file=out, cure="choose another folder with --out")
    demand_one_wish(out, resume=resume, overwrite=overwrite)
    earlier = sorted((out / "runs").glob("*/case.toml"))
    if earlier and not (resume or overwrite):
        cure = "--resume goes on with it, --overwrite replaces it, --out takes another folder"
        raise InputError("holds a sweep already", file=out, cure=cure)
    cases = {member.folder / "case.toml": member.case.to_toml() for member in members}
    for file in earlier:
        if overwrite:
            for name in ("case.toml", "summary.json", "checkpoint.h5"):
                (file.parent / name).unlink(missing_ok=True)
        elif cases.get(file) != file.read_text(encoding="utf-8"):
            cure = "give the case and values of that sweep, or another folder"
            raise InputError("is of another sweep", file=file, cure=cure)


def _ended(member: Member) -> dict[str, Any] | None:
    """Summary of a run that has ended; of one that failed its message alone."""
    file = member.folder / "summary.json"
    if not file.exists():
        return None
    summary: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    if summary["outcome"] == Outcome.FAILED.name.lower():
        return {name: summary[name] for name in ("outcome", "message")}
    return None if summary["outcome"] == Outcome.INTERRUPTED.name.lower() else summary
