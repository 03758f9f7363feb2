"""The motion of the struck end: contact, separation, and the frequencies that it sends into the sample."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.analysis.fronts import arrival_times
from wrinklewave.laboratory_frame import Array

ZERO_PADDING = 8
NOTICEABLE_MOTION = 50e-6
NEGLIGIBLE_MAGNITUDE = 0.1


@dataclass(frozen=True)
class Spectrum:
    """Magnitude of a Fourier transform, its largest value 1.

    Attributes:
        frequency: [Hz], shape [n], increasing from 0.
        magnitude: shape [n].
        bandwidth: frequency [Hz] above which the magnitude stays below a tenth.
    """

    frequency: Array
    magnitude: Array
    bandwidth: float


def boundary_spectrum(time: ArrayLike, displacement: ArrayLike) -> Spectrum:
    """Spectrum of the struck end's displacement from rest over the record, zero-padded eightfold (no taper).

    Args:
        time: shape [n_times] [s].
        displacement: shape [n_times] [m]; gaps (NaN) and uneven times are bridged linearly.

    Returns:
        The spectrum; zero, without bandwidth, if the end was never seen.
    """
    time, displacement = np.asarray(time, dtype=float), np.asarray(displacement, dtype=float)
    known = np.isfinite(displacement)
    even = np.linspace(time[0], time[-1], time.size)
    motion = np.interp(even, time[known], displacement[known]) if known.any() else np.zeros(time.size)
    n = ZERO_PADDING * time.size
    frequency = np.fft.rfftfreq(n, float(even[1] - even[0]))
    magnitude = np.abs(np.fft.rfft(motion, n=n))
    magnitude = magnitude / max(magnitude.max(), np.finfo(float).tiny)
    loud = np.flatnonzero(magnitude >= NEGLIGIBLE_MAGNITUDE)
    return Spectrum(frequency, magnitude, float(frequency[loud[-1]]) if loud.size else float("nan"))


def moved(x_boundary: ArrayLike) -> Array:
    """Displacement of the struck end from where it was first seen [m], shape [n_times]."""
    x_boundary = np.asarray(x_boundary, dtype=float)
    seen = np.isfinite(x_boundary)
    return x_boundary - x_boundary[seen.argmax()]


def contact_time(time: ArrayLike, x_boundary: ArrayLike) -> float:
    """When the struck end has moved by 50 um [s]: time zero of the origin line. NaN if it never does."""
    return _passes(time, x_boundary, NOTICEABLE_MOTION)


def separation_time(time: ArrayLike, x_boundary: ArrayLike, *, stop_distance: float) -> float:
    """When the struck end outruns a striker that has been stopped, by 50 um [s]. NaN if it never does.

    Args:
        time: shape [n_times] [s].
        x_boundary: position of the struck end, shape [n_times] [m].
        stop_distance: travel of the striker from contact to its stoppers [m].
    """
    return _passes(time, x_boundary, stop_distance + NOTICEABLE_MOTION)


def stop_time(time: ArrayLike, x_boundary: ArrayLike, *, stop_distance: float) -> float:
    """When the struck end reaches the place where the striker stops [s]. NaN if it never does."""
    return _passes(time, x_boundary, stop_distance)


def _passes(time: ArrayLike, x_boundary: ArrayLike, distance: float) -> float:
    return float(arrival_times(time, moved(x_boundary)[:, None], distance)[0])
