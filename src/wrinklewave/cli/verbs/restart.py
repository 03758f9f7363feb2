"""``wrinklewave restart``: go on with a run that was stopped."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Annotated

import typer

from wrinklewave.cli.verbs.simulate import AllBulk, Device, Threads

RunDir = Annotated[Path, typer.Argument(metavar="DIR", help="Folder of the run.")]


def restart(
    folder: RunDir, threads: Threads = None, device: Device = "cpu", all_bulk: AllBulk = False
) -> None:
    """Go on with a run from its last checkpoint; the result is that of a run that was never stopped.

    A run that was killed before its first checkpoint starts again; one that is finished is left alone.
    """
    begin = time.perf_counter()
    from wrinklewave.cli.verbs.simulate import run_and_present
    from wrinklewave.config import load_case
    from wrinklewave.errors import InputError

    case_file = folder / "case.toml"
    if not case_file.exists():
        raise InputError(
            "holds no run", file=folder, expected="the folder of an earlier run, with its case.toml"
        )
    where = {"threads": threads, "device": device}
    case = load_case(case_file)
    run_and_present(case, folder, where, begin, resume=True, overwrite=False, all_bulk=all_bulk)
