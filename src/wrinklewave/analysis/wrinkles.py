"""Amplitude and wavelength of wrinkles that have been separated from the pulse."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wrinklewave.laboratory_frame import Array

ZERO_PADDING = 8
FAINTEST_PEAK = 0.01


@dataclass(frozen=True)
class WavelengthSpectra:
    """Fourier spectra of the wrinkles in a window, one per time.

    Attributes:
        wavelength: [m], shape [n_wavelengths], increasing.
        magnitude: amplitude of a sinusoid of that wavelength [m], shape [n_times, n_wavelengths].
        peak: wavelength of the strongest component [m], shape [n_times]; NaN where there are no wrinkles.
    """

    wavelength: Array
    magnitude: Array
    peak: Array


def amplitude_envelope(wrinkles: ArrayLike) -> Array:
    """Amplitude of the wrinkles at each position: magnitude of the analytic signal (Hilbert transform along
    x).

    Args:
        wrinkles: height of the wrinkles [m], shape [n_times, n_x]. Unknown values (NaN) enter as zeros, as in
            the paper, and come out as NaN. Within about a wavelength of gaps and ends the envelope is too
            small.

    Returns:
        Amplitude [m], same shape.
    """
    wrinkles = np.asarray(wrinkles, dtype=float)
    known = np.isfinite(wrinkles)
    return np.where(known, np.abs(analytic_signal(np.where(known, wrinkles, 0.0))), np.nan)


def analytic_signal(signal: Array) -> NDArray[np.complexfloating[Any]]:
    """Signal with its Hilbert transform as imaginary part, along the last axis, padded with zeros to twice
    the length so that its ends do not meet. (``scipy.signal`` has it too, but takes longer to import than
    this to run.)
    """
    from scipy.fft import fft, ifft, next_fast_len

    length = signal.shape[-1]
    n = next_fast_len(2 * length)
    spectrum = fft(signal, n, axis=-1)
    spectrum[..., 1 : (n + 1) // 2] *= 2.0
    spectrum[..., n // 2 + 1 :] = 0.0
    return ifft(spectrum, axis=-1)[..., :length]


def mean_amplitude(envelope: ArrayLike, x: ArrayLike, *, window: tuple[float, float]) -> Array:
    """Mean of the envelope over the known positions in a window [m], shape [n_times]; NaN if none is."""
    inside = _window(x, window)
    envelope = np.asarray(envelope, dtype=float)[:, inside]
    known = np.isfinite(envelope)
    count = known.sum(axis=1)
    total = np.where(known, envelope, 0.0).sum(axis=1)
    return np.divide(total, count, out=np.full(count.shape, np.nan), where=count > 0)


def wavelength_spectra(
    wrinkles: ArrayLike, x: ArrayLike, *, window: tuple[float, float], longest: float
) -> WavelengthSpectra:
    """Spectra of the wrinkles in a window: Hann taper, zero padding, peak by a parabola through the
    logarithms.

    Args:
        wrinkles: height [m], shape [n_times, n_x]; unknown values (NaN) enter as zeros.
        x: laboratory grid [m], shape [n_x], evenly spaced.
        window: positions that take part [m].
        longest: longest wavelength of interest [m], such as the cut-off of the filter that separated the
            wrinkles.

    Returns:
        Spectra between ``longest`` and four samples of the grid. The peak is NaN where the spectrum stays
        below a hundredth of the strongest one of all times.
    """
    from scipy.fft import next_fast_len, rfft, rfftfreq

    x = np.asarray(x, dtype=float)
    signal = np.nan_to_num(np.asarray(wrinkles, dtype=float)[:, _window(x, window)])
    n, spacing = signal.shape[1], float(x[1] - x[0])
    taper = np.hanning(n)
    padded = next_fast_len(ZERO_PADDING * n, real=True)
    magnitude = np.abs(rfft(signal * taper, n=padded, axis=1)) * 2.0 / taper.sum()
    wavenumber = rfftfreq(padded, spacing)
    kept = (wavenumber >= 1.0 / longest) & (wavenumber <= 1.0 / (4.0 * spacing))
    wavenumber, magnitude = wavenumber[kept][::-1], magnitude[:, kept][:, ::-1]
    return WavelengthSpectra(1.0 / wavenumber, magnitude, _peak_wavelength(wavenumber, magnitude))


def _peak_wavelength(wavenumber: Array, magnitude: Array) -> Array:
    strongest = magnitude.max(axis=1)
    faint = strongest <= FAINTEST_PEAK * strongest.max()
    middle = np.clip(magnitude.argmax(axis=1), 1, wavenumber.size - 2)
    rows = np.arange(middle.size)
    floor = np.finfo(float).tiny
    left, centre, right = (np.log(np.maximum(magnitude[rows, middle + s], floor)) for s in (-1, 0, 1))
    curvature = left - 2.0 * centre + right
    shift = np.divide(0.5 * (left - right), curvature, out=np.zeros_like(curvature), where=curvature < 0.0)
    peak = 1.0 / (wavenumber[middle] + np.clip(shift, -0.5, 0.5) * (wavenumber[1] - wavenumber[0]))
    return np.where(faint, np.nan, peak)


def _window(x: ArrayLike, window: tuple[float, float]) -> NDArray[np.bool_]:
    x = np.asarray(x, dtype=float)
    return (x >= window[0]) & (x <= window[1])
