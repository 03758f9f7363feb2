"""The measured motion of the struck end, from a CSV file."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray

EXPECTED = "a CSV file with a header and the columns time_s, u_x_m and, if known, u_y_m"


@dataclass(frozen=True)
class BoundaryHistory:
    """Motion of the struck end.

    Args:
        time: [s], shape [n], increasing.
        u_x: displacement along x, towards the held end [m], shape [n].
        u_y: transverse displacement of the top corner [m], shape [n]; None where it was not measured.
    """

    time: NDArray[np.float64]
    u_x: NDArray[np.float64]
    u_y: NDArray[np.float64] | None


def read_history(path: str | Path) -> BoundaryHistory:
    """Read a boundary history.

    Raises:
        InputError: if the file is missing, a column is missing, a value is no number, or time does not increase.
    """
    columns = _read_columns(Path(path))
    for name in ("time_s", "u_x_m"):
        if name not in columns:
            raise InputError(f"no column {name!r}, but {', '.join(columns)}", file=path, expected=EXPECTED)
    unknown = sorted(set(columns) - {"time_s", "u_x_m", "u_y_m"})
    if unknown:
        raise InputError(
            f"unknown column {unknown[0]!r}", file=path, expected=EXPECTED, cure="remove or rename it"
        )
    time = columns["time_s"]
    if time.size < 2:
        raise InputError(f"{time.size} rows of data", file=path, expected="at least two")
    standing = np.flatnonzero(np.diff(time) <= 0)
    if standing.size:
        row = int(standing[0])
        raise InputError(
            f"time goes from {time[row]:g} to {time[row + 1]:g} s in line {row + 3}",
            file=path,
            key="time_s",
            expected="increasing times",
            cure="sort the rows and remove duplicates",
        )
    return BoundaryHistory(time, columns["u_x_m"], columns.get("u_y_m"))


def _read_columns(file: Path) -> dict[str, NDArray[np.float64]]:
    try:
        with file.open(newline="", encoding="utf-8-sig") as lines:
            rows = list(csv.reader(lines))
    except FileNotFoundError as error:
        raise InputError("no such file", file=file, expected=EXPECTED, cure="check the path") from error
    except (OSError, UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"cannot be read ({error})", file=file, expected=EXPECTED) from error
    if not rows:
        raise InputError("is empty", file=file, expected=EXPECTED)
    names = [name.strip() for name in rows[0]]
    values = [_numbers(row, names, file, line) for line, row in enumerate(rows[1:], start=2) if row]
    table = np.array(values, dtype=np.float64).reshape(-1, len(names))
    return {name: np.ascontiguousarray(table[:, column]) for column, name in enumerate(names)}


def _numbers(row: list[str], names: list[str], file: Path, line: int) -> list[float]:
    if len(row) != len(names):
        raise InputError(
            f"line {line} has {len(row)} values", file=file, expected=f"{len(names)}, as in the header"
        )
    for name, text in zip(names, row, strict=True):
        try:
            finite = math.isfinite(float(text))
        except ValueError:
            finite = False
        if not finite:
            raise InputError(
                f"{text!r} in line {line} is no number", file=file, key=name, expected="finite numbers"
            )
    return [float(text) for text in row]
