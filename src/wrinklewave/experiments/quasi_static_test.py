"""The quasi-static test: wrinkles against strain, Eq. 1 fitted, a second test on the same sample beside the first."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.compression import CompressionSeries, compression_series
from wrinklewave.analysis.compression_fit import CompressionFit, fit_compression
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.analysis.subject import Settings

Scalars = Iterator[tuple[str, float]]

ALL_STRAINS = (-1.0, 1.0)
DRIFT_SIGMAS, NOTICEABLE_DRIFT = 3.0, 0.01
"""A change of the material wavelength over the test that is significant, and worth a warning."""


@dataclass(frozen=True)
class TestSeries:
    """One test: what its images show, and Eq. 1 fitted to it; None if there were too few wrinkles to fit."""

    __test__ = False  # no test of pytest's

    series: CompressionSeries
    fit: CompressionFit | None


@dataclass(frozen=True)
class Repetition:
    """A second test on the same sample against the first (Fig. S6).

    Attributes:
        strain: strains of the second test's images at which both have wrinkles, shape [n].
        ratio: amplitude of the second over the first's, interpolated linearly between its images, shape [n].
    """

    strain: Array
    ratio: Array


@dataclass(frozen=True)
class QuasiStaticTest:
    """Results of a quasi-static test.

    Attributes:
        first: the test.
        second: a later one on the same sample, if there was one. repetition: the two compared.
        summary: scalar results, units in their names; None where there is no number.
        warnings: sentences.
    """

    first: TestSeries
    second: TestSeries | None
    repetition: Repetition | None
    summary: dict[str, float | None]
    warnings: tuple[str, ...]

    @property
    def tests(self) -> tuple[TestSeries, ...]:
        """The first, and the second if there is one."""
        return (self.first,) if self.second is None else (self.first, self.second)


def quasi_static_test(
    surface: xr.Dataset,
    settings: Settings,
    *,
    second: xr.Dataset | None = None,
    undeformed_images: int = 1,
    strains: tuple[float, float] = ALL_STRAINS,
) -> QuasiStaticTest:
    """Analyse the surfaces of a slow compression, measured or simulated, each time being one image.

    Args:
        surface: a surface motion that begins undeformed.
        settings: the section ``analysis`` of a case or an experiment.
        second: of a later test on the same sample.
        undeformed_images: how many images, from the first on, show the undeformed sample.
        strains: smallest and largest strain that Eq. 1 is fitted to.

    Raises:
        InputError: if there are fewer than four images, or the grid is uneven or does not suit the filter.
    """
    first, *others = (
        _analysed(one, settings, undeformed_images, strains) for one in (surface, second) if one is not None
    )
    later = others[0] if others else None
    repetition = None if later is None else _repetition(first.series, later.series)
    summary = dict(_scalars(first))
    if later is not None and repetition is not None:
        summary |= {f"second_{name}": value for name, value in _scalars(later)}
        summary |= dict(_repetition_scalars(first, later, repetition))
    known = {name: value if math.isfinite(value) else None for name, value in summary.items()}
    warnings = tuple(warning for test in (first, *others) for warning in _warnings(test))
    return QuasiStaticTest(first, later, repetition, known, warnings)


def series_columns(test: TestSeries) -> dict[str, Array]:
    """Table of a test, one row for each image, with units in the names; Eq. 1 beside the measurement."""
    series, fit = test.series, test.fit
    unknown = np.full(series.strain.size, np.nan)
    return {
        "image": np.arange(series.strain.size, dtype=float),
        "strain": series.strain,
        "amplitude_m": series.amplitude,
        "amplitude_noise_m": series.amplitude_noise,
        "wavelength_m": series.wavelength,
        "material_wavelength_m": series.material_wavelength,
        "doubled_share": series.doubled,
        "struck_margin_m": series.struck_margin,
        "held_margin_m": series.held_margin,
        "fitted_amplitude_m": unknown if fit is None else fit.amplitude(series.strain),
        "fitted_wavelength_m": unknown if fit is None else fit.wavelength(series.strain),
    }


def _analysed(
    surface: xr.Dataset, settings: Settings, undeformed_images: int, strains: tuple[float, float]
) -> TestSeries:
    series = compression_series(surface, settings, undeformed_images=undeformed_images)
    return TestSeries(series, fit_compression(series, strains=strains))


def _repetition(first: CompressionSeries, second: CompressionSeries) -> Repetition:
    order = np.argsort(first.strain)
    expected = np.interp(
        second.strain, first.strain[order], first.amplitude[order], left=np.nan, right=np.nan
    )
    both = (expected >= first.threshold) & (second.amplitude >= first.threshold)
    order = np.argsort(second.strain[both])
    return Repetition(second.strain[both][order], (second.amplitude[both] / expected[both])[order])


def _scalars(test: TestSeries) -> Scalars:
    series, fit = test.series, test.fit
    last = int(np.nanargmax(series.strain))
    yield "images", series.strain.size
    yield "strain_max", float(series.strain[last])
    yield from _fitted(fit)
    yield "amplitude_max_m", np.fmax.reduce(series.amplitude)
    yield "wavelength_at_strain_max_m", series.wavelength[last]
    yield "struck_margin_at_strain_max_m", series.struck_margin[last]
    yield "held_margin_at_strain_max_m", series.held_margin[last]
    yield "period_doubling_strain", series.doubling_strain
    yield "doubled_share_at_strain_max", series.doubled[last]
    yield "undeformed_arc_m", series.undeformed_arc


def _fitted(fit: CompressionFit | None) -> Scalars:
    unknown = float("nan")
    sigmas = {} if fit is None else fit.sigmas
    for name, ending in (
        ("critical_strain", ""),
        ("critical_wavelength", "_m"),
        ("initial_amplitude", "_m"),
        ("drift", "_per_strain"),
    ):
        yield f"{name}{ending}", unknown if fit is None else getattr(fit, name)
        yield f"{name}_sigma{ending}", sigmas.get(name, unknown)
    yield "critical_wavelength_compressed_m", unknown if fit is None else fit.compressed_wavelength
    yield "amplitude_scatter_m", unknown if fit is None else fit.amplitude_scatter
    yield "wavelength_scatter_m", unknown if fit is None else fit.wavelength_scatter


def _repetition_scalars(first: TestSeries, second: TestSeries, found: Repetition) -> Scalars:
    nothing = float("nan")
    some = found.ratio.size > 0
    yield "second_to_first_amplitude_median", float(np.median(found.ratio)) if some else nothing
    yield "second_to_first_amplitude_min", found.ratio.min() if some else nothing
    yield "second_to_first_amplitude_min_strain", found.strain[found.ratio.argmin()] if some else nothing
    yield "second_to_first_amplitude_max", found.ratio.max() if some else nothing
    if first.fit is not None and second.fit is not None:
        for name, ending in (("critical_strain", ""), ("critical_wavelength", "_m")):
            change = getattr(second.fit, name) - getattr(first.fit, name)
            yield f"{name}_change{ending}", change
            yield (
                f"{name}_change_sigma{ending}",
                math.hypot(first.fit.sigmas[name], second.fit.sigmas[name]),
            )


def _warnings(test: TestSeries) -> Iterator[str]:
    series, fit = test.series, test.fit
    if fit is None:
        yield (
            f"{series.name}: no more than three images show wrinkles of {1e6 * series.threshold:.0f} um that grow: "
            "nothing to fit. If there are any, lower analysis.wrinkle_threshold."
        )
    elif fit.initial_amplitude > series.threshold:
        yield (
            f"{series.name}: the sample was wrinkled before ({1e6 * fit.initial_amplitude:.0f} um), above "
            "analysis.wrinkle_threshold: its critical strain is not where wrinkles appear, but where they would."
        )
    if fit is not None:
        yield from _drift_warnings(series.name, fit)
    yield from _margin_warnings(series)


def _drift_warnings(name: str, fit: CompressionFit) -> Iterator[str]:
    """Whether the wavelength of the material changes."""
    change = fit.drift * (fit.strains[1] - fit.critical_strain)
    if abs(fit.drift) > DRIFT_SIGMAS * fit.sigmas["drift"] and abs(change) > NOTICEABLE_DRIFT:
        yield (
            f"{name}: the wavelength in the undeformed material changes by {change:+.1%} over the test. Either the "
            "sample is not strained evenly along its surface, or the wrinkles do not keep their material. "
            "critical_wavelength_m is that at the critical strain."
        )


def _margin_warnings(series: CompressionSeries) -> Iterator[str]:
    """Whether the window takes in what the ends keep free of wrinkles."""
    last = int(np.nanargmax(series.strain))
    low, high = series.struck_margin[last], series.length - series.held_margin[last]
    if low > series.window[0] or high < series.window[1]:
        yield (
            f"{series.name}: there are no wrinkles within {1e3 * low:.3g} mm of the struck and "
            f"{1e3 * (series.length - high):.3g} mm of the held end, and analysis.amplitude_window, "
            f"{1e3 * series.window[0]:.3g} to {1e3 * series.window[1]:.3g} mm, takes some of that in: "
            "amplitudes are too small."
        )
