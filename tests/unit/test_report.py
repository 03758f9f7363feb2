"""The report is one page that needs nothing else."""

from __future__ import annotations

import io
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from wrinklewave.experiments.compare import Quantity
from wrinklewave.experiments.paper_table import paper_table
from wrinklewave.report import ReportContext, summary_table, write
from wrinklewave.report.formats import number, shown
from wrinklewave.report.page import headline, render
from wrinklewave.report.side_by_side import table_rows

VOID = {"meta", "img", "br", "link", "input", "hr"}


class _Balance(HTMLParser):
    """Checks that every tag that is opened is closed, in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []

    def handle_starttag(self, tag: str, attrs: object) -> None:
        if tag not in VOID:
            self.open.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag


@pytest.fixture
def context(tmp_path: Path) -> ReportContext:
    picture = tmp_path / "fig_2c_displacement.png"
    picture.write_bytes(b"\x89PNG not really")
    time = np.linspace(0.0, 1e-3, 500)
    return ReportContext(
        title="impact <of a block>",
        description="a & b",
        outcome="ended at 5 ms",
        summary={
            "wavefront_speed_m_per_s": 61.234567,
            "wavefront_speed_sigma_m_per_s": 0.6789,
            "wrinkle_speed_m_per_s": None,
            "outcome": "done",
            "ok": True,
        },
        figures={"fig_2c_displacement": picture},
        comparison=paper_table({"relaxing": {"wavefront_speed_m_per_s": 110.0}}),
        history={
            "time_s": time,
            "external_work_J_per_m": 2 * time,
            "friction_J_per_m": 0 * time,
            "imbalance_J_per_m": 1e-3 * time,
        },
        warnings=["hourglass energy is 2 % of the internal energy"],
        case='[case]\nname = "impact"\n',
        versions={"wrinklewave": "0.1", "numpy": np.__version__},
    )


def test_report_is_self_contained_and_well_formed(context: ReportContext, tmp_path: Path) -> None:
    html = write(tmp_path / "report.html", context).read_text(encoding="utf-8")
    parser = _Balance()
    parser.feed(html)
    assert parser.open == []
    assert not re.search(r"""(src|href)=["'](?!data:|#)""", html)
    assert "@import" not in html
    assert "url(" not in html
    assert not list(tmp_path.glob("*.part"))


def test_report_shows_what_it_was_given(context: ReportContext, tmp_path: Path) -> None:
    html = write(tmp_path / "report.html", context).read_text(encoding="utf-8")
    for text in (
        "impact &lt;of a block&gt;",
        "a &amp; b",
        "61.23 ± 0.68",
        "data:image/png;base64,iVBORyBub3Qg",
        "2 % of the",
    ):
        assert text in html, text
    assert "not reproduced" in html
    assert ">friction J/m<" not in html
    assert ">external work J/m<" in html
    assert "name = &#34;impact&#34;" in html


def test_an_empty_report_has_no_empty_sections(tmp_path: Path) -> None:
    html = write(tmp_path / "report.html", ReportContext(title="nothing")).read_text(encoding="utf-8")
    assert "<h2>" not in html


@pytest.mark.parametrize(
    ("name", "value", "expected"),
    [
        ("wavefront_speed_m_per_s", 60.04, ("wavefront speed", "60.04", "m/s")),
        ("wrinkle_amplitude_max_m", 1.714e-4, ("wrinkle amplitude max", "0.1714", "mm")),
        ("wall_time_s", 62.03, ("wall time", "62.03", "s")),
        ("elements", 14948, ("elements", "14948", "")),
        ("contact_time_s", 31e-6, ("contact time", "0.031", "ms")),
        ("strain_rate_max_per_s", 560.0, ("strain rate max", "560", "1/s")),
        ("element_updates_per_s", 4.2e7, ("element updates", "42", "million/s")),
        ("hourglass_energy_share_max", 0.004, ("hourglass energy share max", "0.4", "%")),
        ("separation_time_s", None, ("separation time", "–", "ms")),
        ("pixel_size_m", 50e-6, ("pixel size", "50", "µm")),
        ("kinetic_J_per_m", 2.5, ("kinetic", "2.5", "J/m")),
        ("contact_force_N_per_m", 120.0, ("contact force", "120", "N/m")),
        ("boundary_bandwidth_hz", 410.0, ("boundary bandwidth", "410", "Hz")),
        ("surface_sigma_px", 0.05, ("surface sigma", "0.05", "px")),
        ("tilt_rad", 0.002, ("tilt", "2", "mrad")),
        ("contact_time_s", -1.0, ("contact time", "-1", "s")),
        ("contact_time_s", 0.9999, ("contact time", "999.9", "ms")),
    ],
)
def test_results_get_words_and_handy_units(
    name: str, value: float | None, expected: tuple[str, str, str]
) -> None:
    assert shown(name, value) == expected


def test_numbers_beside_each_other_have_one_unit() -> None:
    row = table_rows([Quantity("stop_time_s", (0.5, None, 1.5), (0.1, None, 0.05), (1.0, None, 3.0))])[0]
    assert row.unit == "s"
    assert [cell.value for cell in row.cells] == ["0.5 ± 0.1", "–", "1.5 ± 0.05"]
    assert [cell.ratio for cell in row.cells] == ["", "", "ratio 3.0000"]


def test_times_of_a_long_run_are_seconds_throughout(context: ReportContext) -> None:
    assert context.history is not None
    history = {**context.history, "time_s": np.linspace(0.0, 2.0, 500)}
    page = render(replace(context, history=history))
    table = page[page.index('id="balance"') :]
    assert "time s" in table
    assert "time ms" not in table
    cells = re.findall(r'<td class="number">\s*([^<\s]*)', table)
    assert {"0", "2"} <= set(cells)
    assert "500" not in cells


def test_numbers_have_four_digits() -> None:
    assert number(123456.0) == "1.235e+05"
    assert number(0.0) == "0"


@pytest.mark.parametrize(
    ("name", "sigma"),
    [
        ("wavefront_speed_m_per_s", "wavefront_speed_sigma_m_per_s"),
        ("critical_wavelength_m", "critical_wavelength_sigma_m"),
        ("second_critical_strain", "second_critical_strain_sigma"),
    ],
)
def test_results_stand_beside_their_uncertainties(name: str, sigma: str) -> None:
    found = headline({name: 2e-3, sigma: 1e-5, "wavelength_m": None}, (name, "wavelength_m", "elements"))
    assert [item.value for item in found] == [shown(name, 2e-3, 1e-5).value]
    assert "±" in found[0].value


def test_summary_table_prints_chosen_results() -> None:
    from rich.console import Console

    console = Console(width=80, record=True, file=io.StringIO())
    console.print(
        summary_table(
            {
                "wavefront_speed_m_per_s": 60.0,
                "wavefront_speed_sigma_m_per_s": 0.51234,
                "wrinkle_amplitude_max_m": 2e-4,
            },
            ["wavefront_speed_m_per_s", "separation_time_s", "wrinkle_amplitude_max_m"],
        )
    )
    text = console.export_text()
    assert "60 ± 0.51 m/s" in text
    assert "0.2 mm" in text
    assert "separation" not in text  # what a run cannot tell is left out
