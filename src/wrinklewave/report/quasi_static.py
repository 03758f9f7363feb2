"""What a quasi-static test shows: figures, numbers, one page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.environment import versions
from wrinklewave.experiments.run_folder import write_text
from wrinklewave.figures.compression import COMPRESSION_FIGURES, CompressionInputs
from wrinklewave.figures.detections import Detection
from wrinklewave.imaging.frames import Image
from wrinklewave.imaging.prepared import open_experiment
from wrinklewave.report.formats import shown
from wrinklewave.report.page import ReportContext, environment, headline, picture

if TYPE_CHECKING:
    from wrinklewave.experiments.measure_quasi_static import MeasuredSeries, QuasiStaticMeasurement
    from wrinklewave.experiments.quasi_static_test import QuasiStaticTest
    from wrinklewave.figures.beside import Helper

HEADLINE = (
    "critical_strain",
    "critical_wavelength_m",
    "critical_wavelength_compressed_m",
    "initial_amplitude_m",
    "strain_max",
    "period_doubling_strain",
    "second_to_first_amplitude_median",
)


def present_measured_test(measurement: QuasiStaticMeasurement, helper: Helper | None = None) -> Path:
    """Write ``figures/`` and ``report.html`` into the folder of a finished measurement; return the report.

    ``helper`` draws part of the figures beside this process.
    """
    assert measurement.folder is not None  # only measurements with a folder are presented
    assert measurement.test is not None  # a finished measurement has one
    return present_quasi_static(
        CompressionInputs(measurement.test, shown_images(measurement)),
        measurement.folder,
        title=measurement.experiment.name,
        description=measurement.experiment.experiment.description,
        experiment=measurement.experiment.to_toml(),
        warnings=measurement.warnings,
        helper=helper,
    )


def present_quasi_static(
    inputs: CompressionInputs,
    folder: Path,
    *,
    title: str,
    description: str = "",
    experiment: str = "",
    warnings: Sequence[str] = (),
    helper: Helper | None = None,
) -> Path:
    """Write ``figures/`` and ``report.html`` of a test into a folder; return the report."""
    context = ReportContext(
        title=title,
        description=description,
        outcome=_what_was_done(inputs.test),
        summary=inputs.test.summary,
        figures=COMPRESSION_FIGURES.write(folder / "figures", inputs, kinds=(), helper=helper),
        warnings=warnings or inputs.test.warnings,
        case=experiment,
        versions=versions(),
        kind="measurement",
    )
    report = folder / "report.html"
    write_text(report, quasi_static_page(context))
    return report


def shown_images(measurement: QuasiStaticMeasurement) -> tuple[Detection, ...]:
    """Images of the first test below and above the critical strain, and at the largest strain."""
    assert measurement.test is not None  # a finished measurement has one
    series, first = measurement.series[0], measurement.test.first
    strain = first.series.strain
    critical = first.fit.critical_strain if first.fit else 0.5 * float(np.nanmax(strain))
    wanted = (0.5 * critical, 2.0 * critical, float(np.nanmax(strain)))
    chosen = sorted({int(np.nanargmin(np.abs(strain - goal))) for goal in wanted}, key=lambda i: strain[i])
    with open_experiment(series.experiment) as source:
        return tuple(
            _detection(series, source.frame(int(series.images[i])), i, f"{letter}   strain {strain[i]:.3f}")
            for letter, i in zip("ABC", chosen, strict=False)
        )


def _detection(series: MeasuredSeries, image: Image, time: int, caption: str) -> Detection:
    here, pixels = series.surface.isel(time=time), series.pixels
    return Detection(
        image=image,
        caption=f"{caption}, image {series.images[time]}",
        surface=np.array(pixels.to_pixels(here["x"].values, here["y"].values)),
        struck_end=float(pixels.to_pixels(here["x_boundary"].values, pixels.height)[0]),
        wires=np.empty((2, 0)),
    )


def quasi_static_page(context: ReportContext) -> str:
    """The test as one HTML page."""
    numbers: Mapping[str, float | None] = context.summary
    return (
        environment()
        .get_template("report.html")
        .render(
            context=context,
            headline=headline(numbers, HEADLINE),
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
