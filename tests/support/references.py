"""Numbers that were computed elsewhere: the tables of tests/reference."""

from __future__ import annotations

import csv
from pathlib import Path

FOLDER = Path(__file__).parents[1] / "reference"


def reference(name: str) -> list[dict[str, str]]:
    """Rows of ``tests/reference/name.csv``, by column."""
    with (FOLDER / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(line for line in file if not line.startswith("#")))
