"""Scalar results of an analysis, with units in their names."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

from wrinklewave.analysis.fronts import SpeedFit, ahead_of_front, rise_time
from wrinklewave.analysis.results import Boundary, Pulse, QuasiStatic, Strains, Wrinkles
from wrinklewave.analysis.subject import Settings, Subject
from wrinklewave.laboratory_frame import Array

Scalars = Iterator[tuple[str, float]]

STRUCK_MARGIN = 2e-3
"""Largest strains and rates are taken beyond it [m]: the corner of the struck end does not converge."""
AHEAD = 10e-3
HIGH_RATE, MODERATE_RATE = 500.0, 300.0


def summarise(
    subject: Subject,
    settings: Settings,
    boundary: Boundary,
    pulse: Pulse,
    wrinkles: Wrinkles,
    strains: Strains | None,
    quasi_static: QuasiStatic | None,
) -> dict[str, float | None]:
    """Collect the scalars; None stands for what did not happen or cannot be known."""
    scalars = dict(_boundary_scalars(boundary))
    scalars |= dict(_pulse_scalars(subject, settings, pulse))
    scalars |= dict(_wrinkle_scalars(wrinkles, pulse))
    if strains is not None:
        scalars |= dict(_strain_scalars(subject, strains))
    if quasi_static is not None:
        scalars |= dict(_quasi_static_scalars(subject, settings, quasi_static, wrinkles, strains))
    return {name: float(value) if math.isfinite(value) else None for name, value in scalars.items()}


def _speed(name: str, fit: SpeedFit) -> Scalars:
    yield f"{name}_speed_m_per_s", fit.speed
    yield f"{name}_speed_sigma_m_per_s", fit.speed_sigma
    yield f"{name}_speed_origin_line_m_per_s", fit.origin_speed
    yield f"{name}_speed_origin_line_sigma_m_per_s", fit.origin_speed_sigma


def _boundary_scalars(boundary: Boundary) -> Scalars:
    yield "contact_time_s", boundary.contact_time
    yield "stop_time_s", boundary.stop_time
    yield "separation_time_s", boundary.separation_time
    yield "boundary_displacement_max_m", _largest(boundary.displacement)
    yield "boundary_bandwidth_hz", boundary.spectrum.bandwidth


def _pulse_scalars(subject: Subject, settings: Settings, pulse: Pulse) -> Scalars:
    yield from _speed("wavefront", pulse.wavefront)
    yield from _speed("wavefront_local", pulse.local_wavefront)
    yield "displacement_max_m", _largest(pulse.displacement)
    ahead = ahead_of_front(subject.time, subject.x, pulse.displacement, pulse.wavefront, distance=AHEAD)
    yield "displacement_10_mm_ahead_of_wavefront_m", _largest(np.abs(ahead))
    yield "arc_strain_max", _largest(pulse.arc_strain)
    for position in settings.positions:
        column = int(np.abs(subject.x - position).argmin())
        yield f"rise_time_at_{1e3 * position:g}_mm_s", rise_time(subject.time, pulse.displacement[:, column])


def _wrinkle_scalars(wrinkles: Wrinkles, pulse: Pulse) -> Scalars:
    yield from _speed("wrinkle", wrinkles.front)
    yield "wrinkle_speed_material_m_per_s", wrinkles.material_front.speed
    yield "wrinkle_to_wavefront_speed_ratio", wrinkles.front.speed / pulse.wavefront.speed
    yield "wrinkle_onset_time_s", wrinkles.onset.time
    yield "wrinkle_onset_position_m", wrinkles.onset.position
    yield "wrinkle_onset_distance_m", wrinkles.onset.distance
    yield "wrinkle_amplitude_max_m", _largest(wrinkles.amplitude)


def _strain_scalars(subject: Subject, strains: Strains) -> Scalars:
    rate = np.abs(strains.rate)
    away = subject.X > STRUCK_MARGIN
    yield "strain_rate_max_per_s", _largest(rate[:, away])
    yield "strain_rate_max_overall_per_s", _largest(rate)
    moderate = ~(rate >= HIGH_RATE).any(axis=0)
    yield "strain_rate_above_500_per_s_reach_m", subject.X[moderate][0] if moderate.any() else subject.length
    yield "strain_rate_above_300_per_s_share", float((rate[:, away] >= MODERATE_RATE).mean())
    yield "strain_max", _largest(strains.strain[:, away])
    yield "fast_front_speed_m_per_s", strains.fast_front.speed
    yield "fast_front_speed_sigma_m_per_s", strains.fast_front.speed_sigma
    if strains.critical_front is not None:
        yield "critical_strain_front_speed_m_per_s", strains.critical_front.speed
        yield "critical_strain_front_speed_sigma_m_per_s", strains.critical_front.speed_sigma


def _quasi_static_scalars(
    subject: Subject, settings: Settings, expected: QuasiStatic, wrinkles: Wrinkles, strains: Strains | None
) -> Scalars:
    yield "strain_at_rest", expected.strain_at_rest
    yield "amplitude_at_rest_m", expected.amplitude_at_rest
    yield "wavelength_at_rest_m", expected.wavelength_at_rest
    if strains is not None:
        wrinkled = strains.strain[-1] >= expected.critical_strain
        yield "wrinkle_free_margin_at_end_m", subject.X[wrinkled].min() if wrinkled.any() else subject.length
        yield "strain_max_over_critical_strain", _largest(strains.strain) / expected.critical_strain
    formed = (wrinkles.amplitude >= settings.wrinkle_threshold) & (expected.amplitude > 0.0)
    yield "wrinkle_amplitude_over_expected", _median(wrinkles.amplitude[formed] / expected.amplitude[formed])
    yield "wavelength_m", _median(wrinkles.spectra.peak[formed])
    yield "wavelength_over_expected", _median(wrinkles.spectra.peak[formed] / expected.wavelength[formed])


def _largest(values: Array) -> float:
    values = values[np.isfinite(values)]
    return float(values.max()) if values.size else float("nan")


def _median(values: Array) -> float:
    values = values[np.isfinite(values)]
    return float(np.median(values)) if values.size else float("nan")


def sigma_name(name: str) -> str:
    """``wavefront_speed_m_per_s`` has its standard uncertainty in ``wavefront_speed_sigma_m_per_s``,
    ``critical_strain`` in ``critical_strain_sigma``."""
    ending = next((ending for ending in ("_m_per_s", "_m") if name.endswith(ending)), "")
    return f"{name.removesuffix(ending)}_sigma{ending}"
