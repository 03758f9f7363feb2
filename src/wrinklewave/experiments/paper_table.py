"""The comparison with the paper: what it says, what we find under each bulk response, and do they agree."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import asdict, dataclass
from decimal import Decimal
from typing import TYPE_CHECKING, Any

from wrinklewave.experiments.paper_statements import STATEMENTS, Statement, Summary

if TYPE_CHECKING:
    from wrinklewave.theory.report import Quantity

REPRODUCED, NOT_REPRODUCED, NO_NUMBER = "reproduced", "not reproduced", "no number"


@dataclass(frozen=True)
class Comparison:
    """Our number beside the paper's.

    Attributes:
        ours: in the row's unit; None if there is none.
        ratio: ours over the paper's.
        verdict: "reproduced", "not reproduced" or "no number".
        remark: why not.
    """

    ours: float | None
    ratio: float | None
    verdict: str
    remark: str


@dataclass(frozen=True)
class Row:
    """One number or statement of the paper.

    Attributes:
        quantity: what it is about.
        paper: what the paper says, with its unit.
        unit: of our numbers.
        about: "simulation", "experiment" or "theory".
        results: comparisons by the bulk response that they were computed with.
    """

    quantity: str
    paper: str
    unit: str
    about: str
    results: Mapping[str, Comparison]


def paper_table(
    summaries: Mapping[str, Summary], theory: Mapping[str, Iterable[Quantity]] | None = None
) -> list[Row]:
    """Hold summaries of the paper's case against everything that the paper says about it.

    Args:
        summaries: contents of ``summary.json`` by bulk response.
        theory: closed forms of the same cases by bulk response; rows without a number in the paper are left
            out.
    """
    rows = [_statement_row(statement, summaries) for statement in STATEMENTS]
    return rows + _theory_rows(theory or {})


def as_json(rows: Iterable[Row]) -> list[dict[str, Any]]:
    """Rows as plain dictionaries."""
    return [asdict(row) for row in rows]


def _statement_row(statement: Statement, summaries: Mapping[str, Summary]) -> Row:
    results = {bulk: _compare(statement, bulk, summary) for bulk, summary in summaries.items()}
    return Row(statement.quantity, statement.paper, statement.unit, statement.about, results)


def _compare(statement: Statement, bulk: str, summary: Summary) -> Comparison:
    value = statement.value(summary)
    if value is None:
        return Comparison(None, None, NO_NUMBER, "the run gives no such number")
    ratio = value / statement.rule.target
    ours = statement.scale * value
    if statement.rule.holds(value):
        return Comparison(ours, ratio, REPRODUCED, "")
    return Comparison(ours, ratio, NOT_REPRODUCED, statement.reason(bulk))


def _theory_rows(theory: Mapping[str, Iterable[Quantity]]) -> list[Row]:
    by_name: dict[str, dict[str, Quantity]] = {}
    for bulk, quantities in theory.items():
        for quantity in quantities:
            if quantity.paper is not None:
                by_name.setdefault(quantity.name, {})[bulk] = quantity
    return [_theory_row(found) for found in by_name.values()]


def _theory_row(found: Mapping[str, Quantity]) -> Row:
    first = next(iter(found.values()))
    assert first.paper is not None  # only such rows are collected
    label = f"{first.name} {first.symbol}".strip()
    unit = "" if first.unit == "1" else first.unit
    results = {bulk: _compare_digits(quantity) for bulk, quantity in found.items()}
    return Row(label, f"{float(first.paper):g} {unit}".strip(), unit, "theory", results)


def _compare_digits(quantity: Quantity) -> Comparison:
    """A closed form agrees if it rounds to the digits that the paper prints."""
    printed = Decimal(str(quantity.paper))
    last_digit = 10.0 ** int(printed.as_tuple().exponent)
    paper = float(printed)
    agrees = abs(quantity.value - paper) <= 0.5 * last_digit * (1 + 1e-9)
    ratio = quantity.value / paper if paper else None
    if agrees:
        return Comparison(quantity.value, ratio, REPRODUCED, "")
    return Comparison(quantity.value, ratio, NOT_REPRODUCED, quantity.remark)
