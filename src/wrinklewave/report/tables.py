"""Tables for the terminal."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from wrinklewave.analysis.summary import sigma_name
from wrinklewave.experiments.paper_table import NO_NUMBER, NOT_REPRODUCED, REPRODUCED, Row
from wrinklewave.report.formats import number, scale

if TYPE_CHECKING:
    from rich.table import Table

MARKS = {REPRODUCED: "[green]✓[/green]", NOT_REPRODUCED: "[red]✗[/red]", NO_NUMBER: "[dim]·[/dim]"}


def comparison_table(rows: Sequence[Row]) -> Table:
    """The comparison with the paper: one column per bulk response, with number, ratio and verdict."""
    from rich.table import Table

    choices = bulk_choices(rows)
    table = Table(title="Comparison with the paper", caption=tally(rows), show_lines=True)
    table.add_column("quantity", ratio=3, overflow="fold")
    table.add_column("paper", ratio=2)
    for bulk in choices:
        table.add_column(bulk, ratio=2)
    table.add_column("remark", ratio=4)
    for row in rows:
        table.add_row(
            row.quantity, f"{row.paper}\n[dim]{row.about}[/dim]", *_cells(row, choices), remarks(row)
        )
    return table


def tally(rows: Sequence[Row]) -> str:
    """How many of the paper's numbers and statements each bulk response reproduces, by what they are about."""
    return "Reproduced:  " + ";  ".join(f"{bulk} {_counts(rows, bulk)}" for bulk in bulk_choices(rows))


def _counts(rows: Sequence[Row], bulk: str) -> str:
    found: dict[str, list[bool]] = {}
    for row in rows:
        if bulk in row.results:
            found.setdefault(row.about, []).append(row.results[bulk].verdict == REPRODUCED)
    return ", ".join(f"{sum(held)} of {len(held)} ({about})" for about, held in found.items())


def bulk_choices(rows: Sequence[Row]) -> list[str]:
    """Bulk responses that the rows have results for, in their order."""
    return list(dict.fromkeys(bulk for row in rows for bulk in row.results))


def remarks(row: Row) -> str:
    """Reasons of all choices that do not reproduce the row; each is named if they differ."""
    choices: dict[str, list[str]] = {}
    for bulk, found in row.results.items():
        if found.remark:
            choices.setdefault(found.remark, []).append(bulk)
    if len(choices) == 1:
        return next(iter(choices))
    return "; ".join(f"{', '.join(bulks)}: {reason}" for reason, bulks in choices.items())


def summary_table(summary: Mapping[str, float | None], names: Sequence[str]) -> Table:
    """Chosen scalar results with handy units; what a run cannot tell is left out."""
    from rich.table import Table

    table = Table(show_header=False, box=None)
    for name in (name for name in names if summary.get(name) is not None):
        how = scale(name, summary[name])
        value = how.with_sigma(summary[name], summary.get(sigma_name(name)))
        table.add_row(how.label, f"{value} {how.unit}".strip())
    return table


def _cells(row: Row, choices: Sequence[str]) -> list[str]:
    cells = []
    for bulk in choices:
        found = row.results.get(bulk)
        if found is None:
            cells.append("")
            continue
        ours = f"{number(found.ours)} {row.unit}".strip()
        ratio = "" if found.ratio is None else f"\n[dim]ratio {found.ratio:.2f}[/dim]"
        cells.append(f"{MARKS[found.verdict]} {ours}{ratio}")
    return cells
