"""What a comparison of surface motions shows: figures, one table, one page."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from wrinklewave.config.writing import toml_text
from wrinklewave.environment import versions
from wrinklewave.experiments.compare import Comparison, Quantity
from wrinklewave.experiments.run_folder import write_json, write_text
from wrinklewave.figures.side_by_side import COMPARISON_FIGURES, compared_inputs
from wrinklewave.report.formats import Scale, scale
from wrinklewave.report.page import ReportContext, environment, picture

if TYPE_CHECKING:
    from rich.table import Table

    from wrinklewave.figures.beside import Helper

HEADLINE = (
    "recorded_contact_time_s",
    "boundary_displacement_max_m",
    "displacement_max_m",
    "wavefront_speed_m_per_s",
    "wavefront_speed_origin_line_m_per_s",
    "wrinkle_speed_m_per_s",
    "wrinkle_amplitude_max_m",
    "wrinkle_amplitude_ratio",
    "wavelength_m",
    "wavelength_ratio",
    "low_frequency_misfit_m",
    "low_frequency_misfit_share",
)


@dataclass(frozen=True)
class Cell:
    """A number as it is shown: with its uncertainty, and its ratio to the first one's if there is one."""

    value: str
    ratio: str


@dataclass(frozen=True)
class TableRow:
    """A quantity as it is shown: words, one cell for each surface motion, the unit of all."""

    label: str
    cells: tuple[Cell, ...]
    unit: str


def present_comparison(comparison: Comparison, folder: Path, helper: Helper | None = None) -> Path:
    """Write ``figures/``, ``comparison.json`` and ``report.html`` into a folder; return the report.

    ``helper`` draws part of the figures beside this process.
    """
    inputs, kinds = compared_inputs(comparison), _kinds(comparison)
    figures = COMPARISON_FIGURES.write(folder / "figures", inputs, kinds=kinds, helper=helper)
    write_json(folder / "comparison.json", comparison.as_json())
    report = folder / "report.html"
    write_text(report, comparison_page(comparison, figures))
    return report


def comparison_page(comparison: Comparison, figures: dict[str, Path]) -> str:
    """The comparison as one HTML page; ``figures`` are PNG files by name."""
    names, kinds = list(comparison.motions), _kinds(comparison)
    context = ReportContext(
        title=" · ".join(names),
        description=f"{names[0]} is the one that the others are held against.",
        outcome=_what_was_done(comparison),
        case=toml_text({"analysis": comparison.settings.model_dump(mode="json", exclude_none=True)}),
        versions=versions(),
    )
    return (
        environment()
        .get_template("side_by_side.html")
        .render(
            context=context,
            headline=(),
            figures=[
                picture(name, COMPARISON_FIGURES[name].of(kinds), file) for name, file in figures.items()
            ],
            names=names,
            rows=table_rows(comparison.quantities),
        )
    )


def _kinds(comparison: Comparison) -> set[str]:
    return {motion.subject.kind for motion in comparison.motions.values()}


def headline_table(comparison: Comparison) -> Table:
    """The numbers to look at first, for the terminal."""
    from rich.markup import escape
    from rich.table import Table

    table = Table(title="Comparison", show_edge=False)
    table.add_column("")
    for name in comparison.motions:
        table.add_column(escape(name), justify="right")
    table.add_column("unit")
    chosen = [q for name in HEADLINE for q in comparison.quantities if q.name == name]
    for row in table_rows(chosen):
        cells = (f"{cell.value}\n[dim]{cell.ratio}[/dim]" if cell.ratio else cell.value for cell in row.cells)
        table.add_row(row.label, *cells, row.unit)
    return table


def table_rows(quantities: Sequence[Quantity]) -> list[TableRow]:
    """Quantities in handy units."""
    return [_row(quantity) for quantity in quantities]


def _row(quantity: Quantity) -> TableRow:
    known = [abs(value) for value in quantity.values if value is not None]
    how = scale(quantity.name, max(known, default=None))
    cells = (_cell(quantity, index, how) for index in range(len(quantity.values)))
    return TableRow(how.label, tuple(cells), how.unit)


def _cell(quantity: Quantity, index: int, how: Scale) -> Cell:
    value, sigma = quantity.values[index], quantity.sigmas[index]
    if value is None:
        return Cell("–", "")
    text = how.with_sigma(value, sigma)
    ratio = quantity.ratios[index]
    return Cell(text, "" if ratio is None or index == 0 else f"ratio {ratio:.4f}")


def _what_was_done(comparison: Comparison) -> str:
    grid = comparison.grid
    clocks = (
        "Clocks set so that all make contact together: "
        + ", ".join(
            f"{name} {1e6 * motion.clock_shift:+.1f} µs" for name, motion in comparison.motions.items()
        )
        if comparison.aligned
        else "Clocks as recorded: not all show the moment of contact"
    )
    time = f"{1e3 * grid.time[0]:.4g} to {1e3 * grid.time[-1]:.4g} ms"
    x = f"{1e3 * grid.x[0]:.4g} to {1e3 * grid.x[-1]:.4g} mm"
    steps = f"{1e6 * (grid.time[1] - grid.time[0]):.3g} µs and {1e6 * (grid.x[1] - grid.x[0]):.3g} µm"
    return (
        f"{clocks}. Analysed with the same parameters over the {time} and {x} that all share; fields subtracted "
        f"after linear interpolation to {steps}."
    )
