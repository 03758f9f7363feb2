"""Everything that a surface motion tells, in one call."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wrinklewave.analysis.boundary import boundary_spectrum, contact_time, moved, separation_time, stop_time
from wrinklewave.analysis.filters import low_pass
from wrinklewave.analysis.fronts import SpeedFit, arrival_times, fit_speed
from wrinklewave.analysis.results import Analysis, Boundary, Onset, Pulse, QuasiStatic, Strains, Wrinkles
from wrinklewave.analysis.strain import arc_length_strain, strain_rate
from wrinklewave.analysis.subject import Settings, Subject, subject_of
from wrinklewave.analysis.summary import summarise
from wrinklewave.analysis.wrinkles import amplitude_envelope, mean_amplitude, wavelength_spectra
from wrinklewave.laboratory_frame import (
    Array,
    laboratory_to_material,
    material_to_laboratory,
    visible_material_points,
)
from wrinklewave.wrinkling.film import instantaneous_critical_strain, instantaneous_modulus
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude, wrinkle_wavelength

if TYPE_CHECKING:
    import xarray as xr

NOTICEABLE_RATE = 3.0
"""Strain rate [1/s] by which fronts of little strain are seen: a hundredth of what the paper's map shows."""
CERTAIN_SHARE = 0.25
"""Standard uncertainty of the surface, over the wrinkle threshold, up to which wrinkles are said to have arrived."""
SPOILT_WAVELENGTHS = 0.2
"""Distance over the filter's cut-off to which an uncertain place spoils the envelope: half a wrinkle."""
SMALLEST_STRAIN = 0.002
"""Strains below it give no momentary modulus: noise would be divided by noise."""


def analyse(surface: xr.Dataset, settings: Settings) -> Analysis:
    """Analyse a surface motion, measured or simulated.

    Besides what the schema asks for, these attributes of the surface motion are used where they are there:
    ``critical_strain`` and ``critical_wavelength`` [m] of the film, ``plane_strain_modulus`` [Pa] of the
    substrate in the long term, E_0 / (1 - nu^2), and ``stop_distance`` [m] of the striker.

    Args:
        surface: a surface motion.
        settings: the section ``analysis`` of a case or an experiment.

    Raises:
        InputError: if there are too few times or positions, or the grid is uneven or does not suit a setting.
    """
    subject = subject_of(surface)
    boundary = analyse_boundary(subject)
    start = boundary.contact_time if np.isfinite(boundary.contact_time) else 0.0
    pulse = analyse_pulse(subject, settings, start)
    wrinkles = analyse_wrinkles(subject, settings, pulse, start)
    strains = analyse_strains(subject, settings, start)
    quasi_static = expect_quasi_static(subject, boundary, pulse)
    summary = summarise(subject, settings, boundary, pulse, wrinkles, strains, quasi_static)
    return Analysis(boundary, pulse, wrinkles, strains, quasi_static, summary)


def analyse_boundary(subject: Subject) -> Boundary:
    """Motion of the struck end, its spectrum and its moments."""
    time, stop = subject.time, subject.stop_distance
    displacement = moved(subject.x_boundary)
    return Boundary(
        displacement=displacement,
        spectrum=boundary_spectrum(time, displacement),
        contact_time=contact_time(time, displacement),
        stop_time=np.nan if stop is None else stop_time(time, displacement, stop_distance=stop),
        separation_time=np.nan if stop is None else separation_time(time, displacement, stop_distance=stop),
    )


def analyse_pulse(subject: Subject, settings: Settings, start: float) -> Pulse:
    """The motion without wrinkles and its front; ``start`` [s]: when the origin line leaves x = 0."""
    displacement = low_pass(subject.u_y, spacing=subject.pixel, cutoff_wavelength=settings.filter_wavelength)
    height = subject.y - subject.u_y + displacement
    highest = np.fmax.reduce(displacement, axis=0)
    wavefront, local_wavefront = (
        fit_speed(subject.x, arrivals, window=settings.front_window, start=start)
        for arrivals in (
            arrival_times(subject.time, displacement, settings.front_fraction * maximum)
            for maximum in (np.fmax.reduce(highest), highest)
        )
    )
    arc_strain = arc_length_strain(subject.x, height, subject.x_boundary, length=subject.length)
    return Pulse(height, displacement, wavefront, local_wavefront, arc_strain)


def analyse_wrinkles(subject: Subject, settings: Settings, pulse: Pulse, start: float) -> Wrinkles:
    """Wrinkles apart from the pulse: amplitude, wavelength, where and how fast they form."""
    height = subject.u_y - pulse.displacement
    envelope = amplitude_envelope(height)
    certain, arrivals_of = envelope, arrival_times
    if subject.u_y_sigma is not None:
        certain = np.where(_too_uncertain(subject.u_y_sigma, subject.pixel, settings), np.nan, envelope)
        arrivals_of = _seen_arrivals
    arrivals = arrivals_of(subject.time, certain, settings.wrinkle_threshold)
    at_points = laboratory_to_material(certain, subject.x, subject.x_p)
    point_arrivals = arrivals_of(subject.time, at_points, settings.wrinkle_threshold)
    return Wrinkles(
        height=height,
        envelope=envelope,
        amplitude=mean_amplitude(envelope, subject.x, window=settings.amplitude_window),
        spectra=wavelength_spectra(
            height, subject.x, window=settings.amplitude_window, longest=settings.filter_wavelength
        ),
        front=fit_speed(subject.x, arrivals, window=settings.front_window, start=start),
        material_front=fit_speed(subject.X, point_arrivals, window=settings.front_window, start=start),
        onset=_onset(subject, arrivals, margin=settings.filter_wavelength),
    )


def analyse_strains(subject: Subject, settings: Settings, start: float) -> Strains | None:
    """Depth-averaged strain and rate, and where they are seen; None if the surface motion has no strain."""
    time, strain = subject.time, subject.strain_xx
    if strain is None:
        return None
    rate = subject.strain_rate_xx if subject.strain_rate_xx is not None else strain_rate(time, strain)
    seen = visible_material_points(subject.X, subject.x_p, subject.y_p, subject.x, subject.x_boundary)
    strain_seen, rate_seen = (material_to_laboratory(field, subject.X, seen) for field in (strain, rate))
    stress_seen = (
        None if subject.stress_xx is None else material_to_laboratory(subject.stress_xx, subject.X, seen)
    )
    fast_arrivals = arrival_times(time, np.abs(rate), NOTICEABLE_RATE)
    return Strains(
        strain=strain,
        rate=rate,
        strain_seen=strain_seen,
        rate_seen=rate_seen,
        fast_front=fit_speed(subject.X, fast_arrivals, window=settings.front_window, start=start),
        critical_front=_critical_front(subject, settings, strain_seen, start),
        stress_seen=stress_seen,
        momentary_critical_strain_seen=_momentary_critical_strain(subject, strain_seen, stress_seen),
    )


def expect_quasi_static(subject: Subject, boundary: Boundary, pulse: Pulse) -> QuasiStatic | None:
    """Eq. 1 on the strain along the arc; None if the surface motion does not name its film."""
    if subject.critical_strain is None or subject.critical_wavelength is None:
        return None
    film = {"critical_strain": subject.critical_strain, "critical_wavelength": subject.critical_wavelength}
    at_rest = float(
        np.interp(boundary.stop_time, subject.time, pulse.arc_strain)
        if np.isfinite(boundary.stop_time)
        else np.fmax.reduce(pulse.arc_strain)
    )
    return QuasiStatic(
        **film,
        amplitude=wrinkle_amplitude(pulse.arc_strain, **film),
        wavelength=wrinkle_wavelength(pulse.arc_strain, **film),
        strain_at_rest=at_rest,
        amplitude_at_rest=float(wrinkle_amplitude(at_rest, **film)),
        wavelength_at_rest=float(wrinkle_wavelength(at_rest, **film)),
    )


def _too_uncertain(sigma: Array, pixel: float, settings: Settings) -> NDArray[np.bool_]:
    """Where noise could pass for wrinkles, shape [n_times, n_x]: in and beside gaps that were bridged.

    Args:
        sigma: standard uncertainty of the surface [m], same shape.
        pixel: spacing of the laboratory grid [m].
        settings: of the analysis.
    """
    from scipy.ndimage import maximum_filter1d

    reach = int(np.ceil(SPOILT_WAVELENGTHS * settings.filter_wavelength / pixel))
    uncertain = np.nan_to_num(sigma) > CERTAIN_SHARE * settings.wrinkle_threshold
    return np.asarray(maximum_filter1d(uncertain, 2 * reach + 1, axis=1))


def _seen_arrivals(time: ArrayLike, field: ArrayLike, threshold: ArrayLike) -> Array:
    """Arrivals that happen between two neighbouring times at which the field is known, shape [n_positions]."""
    arrivals, times = arrival_times(time, field, threshold), np.asarray(time, dtype=float)
    before = np.searchsorted(times, np.nan_to_num(arrivals, nan=times[-1])) - 1
    known = np.isfinite(np.asarray(field, dtype=float)[np.maximum(before, 0), np.arange(arrivals.size)])
    return np.where(known, arrivals, np.nan)


def _onset(subject: Subject, arrivals: Array, *, margin: float) -> Onset:
    """Earliest arrival at a distance from the struck end at which the filter is no longer disturbed by it."""
    ends = np.interp(np.nan_to_num(arrivals), subject.time, subject.x_boundary)
    distances = subject.x - ends
    candidates = np.where(distances >= margin, arrivals, np.nan)
    if not np.isfinite(candidates).any():
        return Onset(np.nan, np.nan, np.nan)
    first = int(np.nanargmin(candidates))
    return Onset(float(arrivals[first]), float(subject.x[first]), float(distances[first]))


def _critical_front(
    subject: Subject, settings: Settings, strain_seen: Array, start: float
) -> SpeedFit | None:
    if subject.critical_strain is None:
        return None
    arrivals = arrival_times(subject.time, strain_seen, subject.critical_strain)
    return fit_speed(subject.x, arrivals, window=settings.front_window, start=start)


def _momentary_critical_strain(subject: Subject, strain: Array, stress: Array | None) -> Array | None:
    if stress is None or subject.critical_strain is None or subject.plane_strain_modulus is None:
        return None
    modulus = instantaneous_modulus(stress, strain, smallest_strain=SMALLEST_STRAIN)
    return instantaneous_critical_strain(
        modulus, critical_strain=subject.critical_strain, long_term_modulus=subject.plane_strain_modulus
    )
