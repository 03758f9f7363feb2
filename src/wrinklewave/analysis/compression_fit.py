"""Critical strain and wavelength from a slow compression: Eq. 1 fitted to amplitudes and wavelengths together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wrinklewave.analysis.compression import CompressionSeries
from wrinklewave.analysis.fronts import independent_count
from wrinklewave.laboratory_frame import Array
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude

FEWEST_IMAGES = 4
"""Images with wrinkles that a fit needs."""
ROUNDS = 4
"""Times that the weights of amplitudes and wavelengths are taken from the scatter about the last fit."""
LEAST_SCATTER = 1e-6
"""Of the wavelength: scatter below it is rounding."""
NAMES = ("critical_strain", "critical_wavelength", "initial_amplitude")


@dataclass(frozen=True)
class CompressionFit:
    """Eq. 1 fitted to a series; lengths in metres.

    Attributes:
        critical_strain, critical_wavelength, initial_amplitude: eps_c, lambda_c (of undeformed material) and the
            amplitude A_i of wrinkles that are there before the compression.
        covariance: of the three in this order, from the scatter about the fit. Neighbouring images share their
            errors: they count as fewer. What all images share, such as the scale, is not in it.
        strains: smallest and largest that took part.
        n_amplitudes, n_wavelengths: how many took part.
        amplitude_scatter, wavelength_scatter: root mean square of the residuals, the latter of material wavelengths.
    """

    critical_strain: float
    critical_wavelength: float
    initial_amplitude: float
    covariance: Array
    strains: tuple[float, float]
    n_amplitudes: int
    n_wavelengths: int
    amplitude_scatter: float
    wavelength_scatter: float

    @property
    def sigmas(self) -> dict[str, float]:
        """Standard uncertainties by name."""
        return dict(zip(NAMES, np.sqrt(np.diag(self.covariance)).tolist(), strict=True))

    @property
    def compressed_wavelength(self) -> float:
        """lambda_c as it is seen on the sample compressed by eps_c: the undeformed one times 1 - eps_c [m]."""
        return self.critical_wavelength * (1.0 - self.critical_strain)

    def amplitude(self, strain: Array) -> Array:
        """Amplitude of Eq. 1 with the wrinkles that were there before [m], same shape."""
        return wrinkle_amplitude(
            strain,
            critical_strain=self.critical_strain,
            critical_wavelength=self.critical_wavelength,
            initial_amplitude=self.initial_amplitude,
        )

    def wavelength(self, strain: Array) -> Array:
        """Wavelength on the compressed sample [m], same shape; NaN below the critical strain."""
        return np.where(
            strain >= self.critical_strain, self.critical_wavelength * (1.0 - np.asarray(strain)), np.nan
        )


def fit_compression(
    series: CompressionSeries, *, strains: tuple[float, float] = (-1.0, 1.0)
) -> CompressionFit | None:
    """Fit eps_c, lambda_c and the initial amplitude to the images within ``strains``.

    Amplitudes follow Eq. 1 with its lambda_c of undeformed material; wavelengths, divided by 1 - eps, are lambda_c
    itself. Each kind is weighted by its own scatter, so that the wavelengths decide on lambda_c where Eq. 1 misses the
    amplitudes by more than noise.

    Returns:
        The fit; None if fewer than four of the images have wrinkles, or their amplitude does not grow.
    """
    used = np.isfinite(series.strain + series.amplitude)
    used &= (series.strain >= strains[0]) & (series.strain <= strains[1])
    strain, amplitude = series.strain[used], series.amplitude[used]
    material = series.material_wavelength[used]
    seen = np.isfinite(material)
    start = _start(strain[seen], amplitude[seen], material[seen]) if seen.sum() >= FEWEST_IMAGES else None
    if start is None:
        return None
    order = np.argsort(strain, kind="stable")
    data = _Data(strain[order], amplitude[order], material[order], seen[order])
    parameters, scatter = start, np.full(2, 0.01 * start[1])
    for _ in range(ROUNDS):
        parameters = _least_squares(data, parameters, scatter)
        scatter = np.maximum([_rms(r) for r in data.residuals(parameters)], LEAST_SCATTER * parameters[1])
    return CompressionFit(
        **dict(zip(NAMES, parameters.tolist(), strict=True)),
        covariance=_covariance(data, parameters),
        strains=(float(strain.min()), float(strain.max())),
        n_amplitudes=strain.size,
        n_wavelengths=int(seen.sum()),
        amplitude_scatter=float(scatter[0]),
        wavelength_scatter=float(scatter[1]),
    )


@dataclass(frozen=True)
class _Data:
    """Images in the order of their strain."""

    strain: Array
    amplitude: Array
    material: Array
    seen: Array

    def residuals(self, parameters: Array) -> tuple[Array, Array]:
        """Of amplitudes and of material wavelengths [m]."""
        expected = wrinkle_amplitude(self.strain, **dict(zip(NAMES, parameters.tolist(), strict=True)))
        return self.amplitude - expected, self.material[self.seen] - parameters[1]


def _start(strain: Array, amplitude: Array, material: Array) -> Array | None:
    """First guess, from the line of A^2 on the strain that Eq. 1 is to leading order."""
    wavelength = float(np.median(material))
    slope, intercept = np.polyfit(strain, (np.pi * amplitude / wavelength) ** 2, 1)
    if not slope > 0.0:
        return None
    onset = float(np.clip(-intercept / slope, 1e-3, strain.max()))
    return np.array([onset, wavelength, 1e-3 * wavelength])


def _least_squares(data: _Data, start: Array, scatter: Array) -> Array:
    from scipy.optimize import least_squares

    scale = np.array([0.05, start[1], 0.01 * start[1]])

    def weighted(scaled: Array) -> Array:
        found = data.residuals(scaled * scale)
        return np.concatenate([r / s for r, s in zip(found, scatter, strict=True)])

    bounds = np.array([1e-6, 0.0, 0.0]), np.array([20.0, np.inf, 50.0])
    inside = np.clip(start / scale, bounds[0] + 1e-9, bounds[1] - 1e-9)
    return np.asarray(least_squares(weighted, inside, bounds=bounds, xtol=1e-12, ftol=1e-12).x) * scale


def _covariance(data: _Data, parameters: Array) -> Array:
    """Inverse of the information: each kind's Jacobian over its variance, for as many images as are independent."""
    information = np.zeros((3, 3))
    residuals = data.residuals(parameters)
    for kind, spent in enumerate((2, 1)):
        slopes = np.stack([_slope(data, parameters, k, kind) for k in range(3)], axis=1)
        residual = residuals[kind]
        share = max(independent_count(residual) - spent, 1.0) / residual.size
        variance = max(float(np.mean(residual**2)), (LEAST_SCATTER * parameters[1]) ** 2) / share
        information += slopes.T @ slopes / variance
    return np.linalg.pinv(information)


def _slope(data: _Data, parameters: Array, k: int, kind: int) -> Array:
    """Derivative of one kind's expected values by parameter ``k``; one-sided for an initial amplitude of zero."""
    step = np.zeros(3)
    step[k] = 1e-4 * (parameters[k] if k < 2 else max(parameters[k], 1e-2 * parameters[1]))
    below = parameters if parameters[k] < step[k] else parameters - step
    above = parameters + step
    width = (above - below)[k]
    return (data.residuals(below)[kind] - data.residuals(above)[kind]) / width


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
