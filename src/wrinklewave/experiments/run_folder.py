"""The folder of a run: what lies where, and how it is written."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from wrinklewave import surface
from wrinklewave.config import case_from_text
from wrinklewave.errors import InputError
from wrinklewave.experiments.boundary_history import boundary_columns
from wrinklewave.experiments.probes import probe_columns

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from wrinklewave.config import Case
    from wrinklewave.experiments.simulate import Run

RESULTS = (
    "surface.nc",
    "boundary.csv",
    "probes.csv",
    "fields.vtkhdf",
    "history.csv",
    "summary.json",
    "comparison.json",
    "report.html",
)


@dataclass(frozen=True)
class RunFolder:
    """Files of a run in ``path``."""

    path: Path

    @property
    def checkpoint(self) -> Path:
        """State of a run that has not ended."""
        return self.path / "checkpoint.h5"

    @property
    def fields(self) -> Path:
        """Fields of a run that has not ended."""
        return self.path / "fields.vtkhdf.part"

    @classmethod
    def prepare(cls, path: Path, case: Case, *, resume: bool, overwrite: bool) -> RunFolder:
        """Make the folder ready for a run, and put the resolved case there.

        Raises:
            InputError: if it holds a run already and neither ``resume`` nor ``overwrite`` says what to do, or a run of
                another case is to be resumed.
        """
        folder = cls(path)
        claim_folder(path, "case.toml", "a run", resume=resume, overwrite=overwrite)
        if resume:
            folder.demand(case)
        else:
            folder._clear()
        write_text(path / "case.toml", case.to_toml())
        return folder

    def demand(self, case: Case) -> None:
        """See that the run that is here, if any, is one of this case: going on with it would replace its results.

        Raises:
            InputError: if it is one of another case.
        """
        file = self.path / "case.toml"
        if not file.exists():
            return
        earlier = case_from_text(file.read_text(encoding="utf-8"), source=file)
        if earlier != case:
            raise InputError(
                f"is of another case, with another {', '.join(_differences(earlier, case))}",
                file=file,
                expected="the case that the run was started with",
                cure="give the same case and --set values, or another folder; --overwrite replaces the run",
            )

    def is_finished(self) -> bool:
        """Whether the run has ended and everything is written; its report comes last."""
        return (self.path / "report.html").exists() and not self.checkpoint.exists()

    def describe_checkpoint(self) -> str:
        """Where a run could go on from."""
        if self.checkpoint.exists():
            return f"last checkpoint: {self.checkpoint}"
        return "no checkpoint had been written yet (solver.checkpoint_interval)"

    def require_fields(self) -> None:
        """See that the fields before the checkpoint are there; those of a run that was all but closed get theirs back.

        Raises:
            InputError: if they are not.
        """
        finished = self.path / "fields.vtkhdf"
        if not self.fields.exists() and finished.exists():
            finished.replace(self.fields)
        if not self.fields.exists():
            raise InputError(
                "is missing beside its checkpoint", file=self.fields, cure="start again without --resume"
            )

    def write_unfinished(self, run: Run) -> None:
        """History and summary of a run that was interrupted or failed."""
        write_history(self.path / "history.csv", {**run.history, "step": run.history["step"].astype(int)})
        write_json(self.path / "summary.json", run.summary)

    def write_finished(self, run: Run) -> None:
        """Everything but figures, report and the name of the fields."""
        assert run.surface is not None  # a finished run has one
        surface.write(run.surface, self.path / "surface.nc")
        write_history(self.path / "boundary.csv", boundary_columns(run.surface))
        if run.case.output.probes:
            write_history(self.path / "probes.csv", probe_columns(run.surface, run.case.output.probes))
        self.write_unfinished(run)

    def close(self, run: Run) -> None:
        """All is written: the fields get their name, and what only a restart needs goes."""
        assert run.fields.file is not None  # a run with a folder writes to it
        run.fields.file.rename(self.path / "fields.vtkhdf")
        self.checkpoint.unlink(missing_ok=True)

    def _clear(self) -> None:
        """Remove what an earlier run has left, so that nothing of it stands beside the new case."""
        for name in (self.checkpoint.name, self.fields.name, *RESULTS):
            (self.path / name).unlink(missing_ok=True)
        for file in (self.path / "figures").glob("*.png"):
            file.unlink()


def _differences(one: Case, other: Case) -> list[str]:
    """Dotted keys in which two cases differ."""
    return [".".join(map(str, keys)) for keys in _unlike(one.model_dump(), other.model_dump())]


def _unlike(one: Any, other: Any) -> Iterator[tuple[str, ...]]:
    if not (isinstance(one, dict) and isinstance(other, dict)):
        if one != other:
            yield ()
        return
    for key in dict.fromkeys((*one, *other)):
        yield from ((key, *rest) for rest in _unlike(one.get(key), other.get(key)))


def claim_folder(path: Path, marker: str, what: str, *, resume: bool, overwrite: bool) -> None:
    """Make a folder for results unless it holds other ones.

    Args:
        path: of the folder.
        marker: file that says that ``what`` lies there already.
        what: is to be put there, in words.
        resume: whether it may be there already, to be gone on with.
        overwrite: whether it may be there already, to be replaced.

    Raises:
        InputError: if it is there and must not be, if ``path`` is a file, or if both is wanted.
    """
    demand_one_wish(path, resume=resume, overwrite=overwrite)
    if path.exists() and not path.is_dir():
        raise InputError("is a file", file=path, expected="a folder for the results")
    if (path / marker).exists() and not (resume or overwrite):
        raise InputError(
            f"holds {what} already",
            file=path,
            cure="--resume goes on with it, --overwrite replaces it, --out takes another folder",
        )
    path.mkdir(parents=True, exist_ok=True)


def demand_one_wish(path: Path, *, resume: bool, overwrite: bool) -> None:
    """See that results are not both to be gone on with and to be replaced.

    Raises:
        InputError: if they are.
    """
    if resume and overwrite:
        raise InputError(
            "is to be gone on with and to be replaced",
            file=path,
            expected="--resume or --overwrite, not both",
            cure="--resume keeps what is there, --overwrite begins anew",
        )


def write_text(path: Path, text: str) -> None:
    """Write a file that appears whole or not at all."""
    partial = path.with_name(path.name + ".part")
    partial.write_text(text, encoding="utf-8")
    partial.replace(path)


def write_json(path: Path, content: Any) -> None:
    """Write JSON for people: indented, in the order given."""
    write_text(path, json.dumps(content, indent=2, ensure_ascii=False) + "\n")


def write_history(path: Path, history: Mapping[str, NDArray[np.number[Any]]]) -> None:
    """Write a table of columns as CSV, with all digits."""
    partial = path.with_name(path.name + ".part")
    with partial.open("w", newline="") as stream:
        writer = csv.writer(stream)
        writer.writerow(history)
        writer.writerows(zip(*(column.tolist() for column in history.values()), strict=True))
    partial.replace(path)
