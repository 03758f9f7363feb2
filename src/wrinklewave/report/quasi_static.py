"""What a quasi-static test shows: figures, numbers, one page."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from wrinklewave.environment import versions
from wrinklewave.experiments.run_folder import write_text
from wrinklewave.figures.compression import COMPRESSION_FIGURES, CompressionInputs, write_compression_figures
from wrinklewave.report.formats import shown
from wrinklewave.report.page import ReportContext, environment, picture

if TYPE_CHECKING:
    from wrinklewave.experiments.quasi_static_test import QuasiStaticTest

HEADLINE = (
    "critical_strain",
    "critical_strain_sigma",
    "critical_wavelength_m",
    "critical_wavelength_sigma_m",
    "critical_wavelength_compressed_m",
    "initial_amplitude_m",
    "strain_max",
    "period_doubling_strain",
    "second_to_first_amplitude_median",
)


def present_quasi_static(
    inputs: CompressionInputs, folder: Path, *, title: str, description: str = "", experiment: str = ""
) -> Path:
    """Write ``figures/`` and ``report.html`` into a folder; return the report."""
    figures = write_compression_figures(folder / "figures", inputs)
    context = ReportContext(
        title=title,
        description=description,
        outcome=_what_was_done(inputs.test),
        summary=inputs.test.summary,
        figures=figures,
        warnings=inputs.test.warnings,
        case=experiment,
        versions=versions(),
    )
    report = folder / "report.html"
    write_text(report, quasi_static_page(context))
    return report


def quasi_static_page(context: ReportContext) -> str:
    """The test as one HTML page."""
    numbers: Mapping[str, float | None] = context.summary
    return (
        environment()
        .get_template("report.html")
        .render(
            context=context,
            headline=[shown(name, numbers[name]) for name in HEADLINE if numbers.get(name) is not None],
            results=[shown(name, value) for name, value in numbers.items()],
            figures=[
                picture(name, COMPRESSION_FIGURES[name], file) for name, file in context.figures.items()
            ],
            choices=(),
            comparison=(),
            balance=None,
        )
    )


def _what_was_done(test: QuasiStaticTest) -> str:
    first = test.first
    low, high = (1e3 * bound for bound in first.series.window)
    said = (
        f"{first.series.strain.size} images; amplitude and wavelength over {low:.3g} to {high:.3g} mm of undeformed "
        "material; strain 1 - s/s_0 along the smoothed arc, s_0 that of the undeformed images."
    )
    if first.fit is None:
        return said
    return (
        f"{said} Eq. 1 fitted to {first.fit.n_amplitudes} amplitudes and {first.fit.n_wavelengths} wavelengths at "
        f"strains of {first.fit.strains[0]:.3f} to {first.fit.strains[1]:.3f}; its λ_c is of undeformed material, and "
        "λ_c (1 - ε_c) what is seen on the sample at the critical strain."
    )
