"""What a film's imperfection gives to wrinkles of each wavelength, and the wrinkle that they make together.

The height of the imperfection is the real part of a sum of waves exp(i k X). Bands of wavenumbers share them: those
between two of the bands' own wavenumbers go to both, in proportion to their nearness.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wrinklewave.laboratory_frame import Array

ComplexArray = NDArray[np.complex128]

FAINTEST = 1e-3
"""Of the largest seed of all: what is fainter is raised to it, so that every band's growth is known everywhere."""


@dataclass(frozen=True)
class Seeds:
    """Seeds of wrinkles of several wavelengths.

    Args:
        wavelengths: undeformed [m], shape [n_wavelengths].
        waves: complex heights of the imperfection's parts [m], shape [n_points, n_wavelengths].
    """

    wavelengths: Array
    waves: ComplexArray

    @property
    def audible(self) -> ComplexArray:
        """The waves, none of them fainter than ``FAINTEST`` [m], shape of ``waves``."""
        size = np.abs(self.waves)
        return np.maximum(size, FAINTEST * size.max()) * np.exp(1j * np.angle(self.waves))

    def grown(self, growth: Array, X: Array, wavelength: float) -> ComplexArray:
        """Complex amplitude, beside exp(2 pi i X / wavelength), of all waves together [m], shape [n_times, n_points].

        Args:
            growth: of each wave, over its seed, shape [n_times, n_points, n_wavelengths].
            X: undeformed positions of the points [m].
            wavelength: of the wave that the result multiplies [m].
        """
        start = self.waves * np.exp(-2j * np.pi / wavelength * X)[:, np.newaxis]
        return np.einsum("tpm,pm->tp", growth, start)


def of_one_wave(amplitude: float, wavelength: float, X: Array) -> Seeds:
    """A single cosine: amplitude * cos(2 pi X / wavelength)."""
    return Seeds(np.array([wavelength]), amplitude * np.exp(2j * np.pi / wavelength * X)[:, np.newaxis])


def shared_evenly(amplitude: float, wavelengths: Array, X: Array) -> Seeds:
    """Waves of equal amplitude, of a mean square like a sine's of ``amplitude``; their phases keep peaks apart.

    Phases that grow with the square of the wave's number (Schroeder, IEEE Trans. Inf. Theory 16, 85 (1970)).
    """
    number = np.arange(wavelengths.size)
    phases = 2 * np.pi * X[:, np.newaxis] / wavelengths + np.pi * number**2 / number.size
    return Seeds(wavelengths, amplitude / np.sqrt(number.size) * np.exp(1j * phases))


def of_height(X: Array, height: Array, wavelengths: Array, points: Array) -> Seeds:
    """Parts of a height that is known along the whole film.

    Args:
        X: evenly spaced undeformed positions from end to end [m].
        height: there [m].
        wavelengths: of the bands [m], shorter and shorter, evenly spaced in wavenumber.
        points: where the seeds are wanted [m].
    """
    from scipy.fft import dct

    waves = dct(height, type=1) / (
        X.size - 1
    )  # height = sum_j waves_j cos(pi j X / L), first and last halved
    waves[[0, -1]] *= 0.5
    k = np.pi * np.arange(X.size) / (X[-1] - X[0])
    bands = 2 * np.pi / wavelengths
    near = np.clip(1.0 - np.abs(k[:, np.newaxis] - bands) / (bands[1] - bands[0]), 0.0, None)
    used = near.any(axis=1)
    phase = np.exp(1j * k[used] * (points[:, np.newaxis] - X[0]))
    return Seeds(wavelengths, phase @ (waves[used, np.newaxis] * near[used]))
