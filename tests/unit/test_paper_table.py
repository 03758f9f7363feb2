"""The comparison with the paper decides by its stated rules."""

from __future__ import annotations

import io
import json
from pathlib import Path

import pytest

from wrinklewave.config import load_case
from wrinklewave.experiments.paper_statements import BULK_CHOICES, STATEMENTS, Rule
from wrinklewave.experiments.paper_table import (
    NO_NUMBER,
    NOT_REPRODUCED,
    REPRODUCED,
    Comparison,
    Row,
    as_json,
    paper_table,
)
from wrinklewave.report import comparison_html, comparison_table
from wrinklewave.report.tables import tally
from wrinklewave.theory.report import Quantity, report

CASE = Path(__file__).parents[2] / "examples" / "paper_impact.toml"


def _row(rows: list[Row], quantity: str, paper: str = "") -> Row:
    (found,) = (row for row in rows if row.quantity == quantity and paper in row.paper)
    return found


@pytest.mark.parametrize(
    ("rule", "value", "holds"),
    [
        (Rule(57.0, 0.15), 48.5, True),
        (Rule(57.0, 0.15), 48.4, False),
        (Rule(57.0, 0.15), 65.6, False),
        (Rule(500.0, side="at least"), 499.9, False),
        (Rule(500.0, side="at least"), 500.0, True),
        (Rule(400.0, side="at most"), 400.1, False),
        (Rule(400.0, 0.1, side="at most"), 440.0, True),
    ],
)
def test_rules(rule: Rule, value: float, holds: bool) -> None:
    assert rule.holds(value) is holds


def test_a_number_within_the_tolerance_reproduces_the_paper() -> None:
    rows = paper_table({"elastic-long-term": {"wavefront_speed_m_per_s": 60.0}})
    found = _row(rows, "wavefront speed c_S, free line").results["elastic-long-term"]
    assert (found.verdict, found.remark) == (REPRODUCED, "")
    assert found.ratio == pytest.approx(60 / 57)


def test_a_number_beyond_it_does_not_and_says_why() -> None:
    summaries = {bulk: {"wavefront_speed_m_per_s": 110.0} for bulk in BULK_CHOICES}
    results = _row(paper_table(summaries), "wavefront speed c_S, free line").results
    assert {found.verdict for found in results.values()} == {NOT_REPRODUCED}
    assert "K_i" in results["relaxing"].remark
    assert "K_i" not in results["elastic-long-term"].remark


def test_missing_numbers_are_said_to_be_missing() -> None:
    for row in paper_table({"relaxing": {"wavefront_speed_m_per_s": None}}):
        assert row.results["relaxing"].verdict == NO_NUMBER
        assert row.results["relaxing"].ours is None


def test_numbers_are_shown_in_the_unit_of_the_row() -> None:
    row = _row(
        paper_table({"": {"wrinkle_onset_distance_m": 8e-3}}), "first wrinkles, distance from the struck end"
    )
    assert (row.results[""].ours, row.unit) == (pytest.approx(8.0), "mm")


def test_every_statement_that_can_fail_says_why() -> None:
    for statement in STATEMENTS:
        for bulk in BULK_CHOICES:
            assert statement.reason(bulk), statement.quantity


def test_theory_of_the_paper_agrees_to_the_printed_digits() -> None:
    rows = [
        row
        for row in paper_table({}, {"elastic-long-term": report(load_case(CASE))})
        if row.about == "theory"
    ]
    assert len(rows) >= 8
    verdicts = {row.quantity: row.results["elastic-long-term"].verdict for row in rows}
    assert verdicts["bar speed, long-term c_0"] == REPRODUCED
    assert verdicts["plane-wave speed, instantaneous c_L"] == REPRODUCED
    # 6.3 mm over 50.4 mm is 0.125, which the paper prints as 0.12
    assert verdicts["static strain at the stoppers eps_S"] == REPRODUCED


@pytest.mark.parametrize(
    ("value", "printed", "verdict"),
    [
        (11.66, "11.7", REPRODUCED),
        (11.64, "11.7", NOT_REPRODUCED),
        (250.65, "2.5e2", REPRODUCED),
        (256.0, "2.5e2", NOT_REPRODUCED),
    ],
)
def test_theory_is_compared_digit_by_digit(value: float, printed: str, verdict: str) -> None:
    quantity = Quantity("speeds", "speed", "c", value, "m/s", "", printed, "a remark")
    found = _row(paper_table({}, {"": [quantity]}), "speed c").results[""]
    assert found.verdict == verdict
    assert found.remark == ("" if verdict == REPRODUCED else "a remark")


def test_the_table_is_printed_and_written() -> None:
    from rich.console import Console

    summaries = {bulk: {"wavefront_speed_m_per_s": 60.0 + i} for i, bulk in enumerate(BULK_CHOICES)}
    rows = paper_table(summaries, {"relaxing": report(load_case(CASE))})
    console = Console(width=160, record=True, file=io.StringIO())
    console.print(comparison_table(rows))
    text, html = console.export_text(), comparison_html(rows)
    for row in rows:
        assert row.quantity.split(",")[0].split()[0] in text
    assert html.count("<tr>") == len(rows) + 1
    assert html.count("reproduced") >= 3
    assert json.loads(json.dumps(as_json(rows)))[0]["results"]["relaxing"]["ours"] == 62.0


def test_the_tally_counts_what_is_reproduced() -> None:
    results = {"relaxing": Comparison(60.0, 1.0, REPRODUCED, "")}
    worse = {"relaxing": Comparison(90.0, 1.6, NOT_REPRODUCED, "too fast")}
    rows = [
        Row("a", "60", "", "theory", results),
        Row("b", "57", "", "simulation", worse),
        Row("c", "57", "", "simulation", results),
    ]
    assert tally(rows) == "Reproduced:  relaxing 1 of 1 (theory), 1 of 2 (simulation)"
