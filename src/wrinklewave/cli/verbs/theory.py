"""``wrinklewave theory``: the closed forms of a case."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.cli.console import console
from wrinklewave.cli.options import CaseFile, JsonFile, Overrides

if TYPE_CHECKING:
    from rich.table import Table

    from wrinklewave.theory.report import Quantity

WIDE = 110  # columns from which the formulas fit beside the values


def theory(case: CaseFile, overrides: Overrides = None, json: JsonFile = None) -> None:
    """Print every closed-form number of a case: moduli, wave speeds, times, film."""
    import dataclasses
    from json import dumps

    from wrinklewave.config import load_case
    from wrinklewave.theory.report import report

    loaded = load_case(case, overrides or ())
    quantities = report(loaded)
    if json is not None:
        numbers = [dataclasses.asdict(quantity) for quantity in quantities]
        text = dumps({"case": loaded.name, "quantities": numbers}, indent=1)
        json.write_text(text + "\n", encoding="utf-8")
    out = console()
    out.print(_table(quantities, loaded.name, formulas=out.width >= WIDE))


def _table(quantities: list[Quantity], name: str, *, formulas: bool) -> Table:
    from decimal import Decimal

    from rich.markup import escape
    from rich.table import Table

    from wrinklewave.units import engineering

    table = Table(title=f"Theory: {escape(name)}", show_edge=False)
    table.add_column("")
    table.add_column("value", justify="right", no_wrap=True)
    table.add_column("paper", justify="right", no_wrap=True)
    if formulas:
        table.add_column("symbol", no_wrap=True)
        table.add_column("from")
    group = ""
    for quantity in quantities:
        if quantity.group != group:
            group = quantity.group
            table.add_section()
            table.add_row(f"[bold]{group}[/bold]")
        printed = engineering(Decimal(quantity.paper), quantity.unit, None) if quantity.paper else ""
        source = quantity.formula + (f"\n[dim]{quantity.remark}[/dim]" if quantity.remark else "")
        cells = [quantity.name, engineering(quantity.value, quantity.unit), printed, quantity.symbol, source]
        table.add_row(*cells[: len(table.columns)])
    return table
