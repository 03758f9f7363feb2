"""Columns of numbers from the CSV files that a case names."""

from __future__ import annotations

import csv
import math
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from numpy.typing import NDArray


def read_columns(
    path: str | Path, required: Sequence[str], optional: Sequence[str] = ()
) -> dict[str, NDArray[np.float64]]:
    """Read a CSV file with a header; the first required column must increase from row to row.

    Args:
        path: the file.
        required: names of the columns that must be there.
        optional: names of those that may be.

    Returns:
        Columns by name, each of shape [n], n >= 2.

    Raises:
        InputError: if the file or a column is missing, a value is no finite number, there are fewer than two
            rows, or the first required column does not increase.
    """
    file = Path(path)
    lines, rows = _read_rows(file)
    names = [name.strip() for name in rows[0]] if rows else []
    expected = f"a header with {', '.join(required)}" + (
        f" and perhaps {', '.join(optional)}" if optional else ""
    )
    for name in required:
        if name not in names:
            raise InputError(
                f"has no column {name}", file=file, expected=expected, cure="name the columns so"
            )
    for name in names:
        if name not in (*required, *optional) or names.count(name) > 1:
            problem = f'column "{name}" is unknown, or there twice'
            raise InputError(problem, file=file, expected=expected, cure="remove or rename it")
    if len(rows) < 3:
        raise InputError(f"has {len(rows) - 1} rows of numbers", file=file, expected="at least two")
    values = [_numbers(row, names, file, line) for line, row in zip(lines[1:], rows[1:], strict=True)]
    columns = dict(zip(names, np.array(values, dtype=np.float64).T.copy(), strict=True))
    _check_increasing(columns[required[0]], required[0], file, lines[1:])
    return columns


def _read_rows(file: Path) -> tuple[list[int], list[list[str]]]:
    """The rows that are not blank, and the lines of the file that they stand in."""
    try:
        with file.open(newline="", encoding="utf-8-sig") as stream:
            numbered = [(line, row) for line, row in enumerate(csv.reader(stream), start=1) if row]
    except FileNotFoundError as error:
        raise InputError("no such file", file=file, expected="a CSV file", cure="check the path") from error
    except OSError as error:
        raise InputError(f"cannot be read ({error.strerror})", file=file, expected="a CSV file") from error
    except (UnicodeDecodeError, csv.Error) as error:
        raise InputError(f"is no table of text ({error})", file=file, expected="a CSV file") from error
    return [line for line, _ in numbered], [row for _, row in numbered]


def _numbers(row: Sequence[str], names: Sequence[str], file: Path, line: int) -> list[float]:
    if len(row) != len(names):
        problem = f"line {line} has {len(row)} values"
        raise InputError(problem, file=file, expected=f"{len(names)}, as the header has names")
    for name, text in zip(names, row, strict=True):
        try:
            finite = math.isfinite(float(text))
        except ValueError:
            finite = False
        if not finite:
            raise InputError(f'"{text}" in line {line}', file=file, key=name, expected="a finite number")
    return [float(text) for text in row]


def _check_increasing(values: NDArray[np.float64], name: str, file: Path, lines: Sequence[int]) -> None:
    falls = np.flatnonzero(np.diff(values) <= 0)
    if falls.size:
        row = int(falls[0])
        raise InputError(
            f"goes from {values[row]:g} to {values[row + 1]:g} in line {lines[row + 1]}",
            file=file,
            key=name,
            expected="values that increase from row to row",
            cure="sort the rows and remove duplicates",
        )
