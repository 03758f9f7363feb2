"""The report: one HTML page that needs nothing else, with the figures inside."""

from __future__ import annotations

import base64
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave.analysis.summary import sigma_name
from wrinklewave.experiments.paper_table import Row
from wrinklewave.figures import FIGURES
from wrinklewave.figures.registry import FigureSpec
from wrinklewave.laboratory_frame import Array
from wrinklewave.report.formats import Shown, number, scale, shown
from wrinklewave.report.tables import bulk_choices, remarks, tally

if TYPE_CHECKING:
    from jinja2 import Environment

HEADLINE = (
    "striker_velocity_m_per_s",
    "wavefront_speed_m_per_s",
    "wavefront_speed_origin_line_m_per_s",
    "wrinkle_speed_m_per_s",
    "strain_rate_max_per_s",
    "wrinkle_amplitude_max_m",
    "wavelength_m",
    "energy_imbalance_max",
    "hourglass_energy_share_max",
    "contrast_to_noise",
    "surface_sigma_px",
)
BALANCE_LINES = 11


@dataclass(frozen=True)
class ReportContext:
    """What a report shows.

    Attributes:
        title, description: of the case or experiment.
        outcome: how the run ended, in a sentence.
        summary: results by name, as in ``summary.json``; only numbers (and None) are shown.
        figures: PNG files by the name of their figure.
        comparison: rows of the comparison with the paper.
        history: columns of the energy balance by name, each of shape [n].
        warnings: sentences.
        case: the resolved case or experiment file.
        kind: "simulation" or "measurement".
        versions: of the software, by name.
    """

    title: str
    description: str = ""
    outcome: str = ""
    summary: Mapping[str, Any] = field(default_factory=dict)
    figures: Mapping[str, Path] = field(default_factory=dict)
    comparison: Sequence[Row] = ()
    history: Mapping[str, Array] | None = None
    warnings: Sequence[str] = ()
    case: str = ""
    versions: Mapping[str, str] = field(default_factory=dict)
    kind: str = "simulation"


def write(path: str | Path, context: ReportContext) -> Path:
    """Write the report, atomically: the file appears whole or not at all."""
    path = Path(path)
    partial = path.with_name(path.name + ".part")
    partial.write_text(render(context), encoding="utf-8")
    partial.replace(path)
    return path


def render(context: ReportContext, template: str = "report.html", **others: Any) -> str:
    """Return the report as HTML; ``others`` are what another template than the run's needs besides."""
    numbers = {name: value for name, value in context.summary.items() if _is_number(value)}
    return (
        environment()
        .get_template(template)
        .render(
            context=context,
            headline=headline(numbers, HEADLINE),
            results=[shown(name, value) for name, value in numbers.items()],
            figures=[
                picture(name, FIGURES[name].of({context.kind}), file)
                for name, file in context.figures.items()
            ],
            **_comparison(context.comparison),
            balance=_balance(context.history),
            **others,
        )
    )


def comparison_html(rows: Sequence[Row]) -> str:
    """Return the comparison with the paper alone, as an HTML table."""
    return environment().get_template("comparison.html").render(**_comparison(rows))


def environment() -> Environment:
    """The templates, with the filter ``number``."""
    from jinja2 import Environment, PackageLoader, StrictUndefined

    found = Environment(
        loader=PackageLoader("wrinklewave.report", "templates"),
        autoescape=True,
        trim_blocks=True,
        lstrip_blocks=True,
        undefined=StrictUndefined,
    )
    found.filters |= {"number": number}
    return found


def _comparison(rows: Sequence[Row]) -> dict[str, Any]:
    table = [(row, remarks(row)) for row in rows]
    return {"choices": bulk_choices(rows), "comparison": table, "tally": tally(rows)}


def _is_number(value: object) -> bool:
    return value is None or (isinstance(value, int | float) and not isinstance(value, bool))


def headline(numbers: Mapping[str, float | None], names: Sequence[str]) -> list[Shown]:
    """Chosen results with their standard uncertainties, where they are known."""
    return [
        shown(name, numbers[name], numbers.get(sigma_name(name)))
        for name in names
        if numbers.get(name) is not None
    ]


def picture(name: str, spec: FigureSpec[Any], file: Path) -> dict[str, str]:
    """A figure as the templates take it."""
    number = f"Fig. {spec.number}" if spec.number else ""
    return {
        "name": name,
        "number": number,
        "caption": spec.caption,
        "data": base64.b64encode(Path(file).read_bytes()).decode("ascii"),
    }


def _balance(history: Mapping[str, Array] | None) -> dict[str, Any] | None:
    """A few lines of the energy balance, evenly spread in time, without energies that are zero throughout."""
    if history is None:
        return None
    rows = np.unique(np.linspace(0, len(history["time_s"]) - 1, BALANCE_LINES).astype(int))
    columns = {name: np.asarray(values) for name, values in history.items()}
    kept = {
        name: values
        for name, values in columns.items()
        if name == "time_s" or (name.endswith("_J_per_m") and np.any(values[rows] != 0.0))
    }
    scales = [scale(name, float(np.abs(values[rows]).max())) for name, values in kept.items()]
    lines = [
        [how.digits(float(values[row])) for how, values in zip(scales, kept.values(), strict=True)]
        for row in rows
    ]
    return {"names": [f"{how.label} {how.unit}".strip() for how in scales], "lines": lines}
