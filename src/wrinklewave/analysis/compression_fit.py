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
NOISE_POWER_SIGMA = 0.1
"""Relative standard uncertainty of the noise's power."""
SCALE_SIGMA = 0.002
"""Relative standard uncertainty of all amplitudes, and of all strains, of a series: what filter, envelope and arc leave
of analytic compressions (tests/verification/test_quasi_static_test.py)."""
NAMES = ("critical_strain", "critical_wavelength", "initial_amplitude", "drift")
INITIAL = NAMES.index("initial_amplitude")


@dataclass(frozen=True)
class CompressionFit:
    """Eq. 1 fitted to a series; lengths in metres.

    Attributes:
        critical_strain, critical_wavelength: eps_c and lambda_c, the wavelength of undeformed material at eps_c.
        initial_amplitude: A_i, of wrinkles that are there before the compression.
        drift: relative change of the material wavelength per strain; zero if wrinkles keep their material and the
            sample is strained evenly along its arc.
        covariance: of the four in this order, from the scatter about the fit, where neighbouring images share their
            errors and count as fewer, and from ``SCALE_SIGMA``. The calibration's uncertainty is not in it.
        strains: smallest and largest that took part.
        n_amplitudes, n_wavelengths: how many took part.
        amplitude_scatter, wavelength_scatter: root mean square of the residuals, the latter of material wavelengths.
    """

    critical_strain: float
    critical_wavelength: float
    initial_amplitude: float
    drift: float
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
        excess = np.asarray(strain, dtype=float) - self.critical_strain
        material = self.critical_wavelength * (1.0 + self.drift * excess)
        return np.where(excess >= 0.0, material * (1.0 - np.asarray(strain)), np.nan)


def fit_compression(
    series: CompressionSeries, *, strains: tuple[float, float] = (-1.0, 1.0)
) -> CompressionFit | None:
    """Fit eps_c, lambda_c, the initial amplitude and the drift to the images within ``strains``.

    Amplitudes follow Eq. 1 with its lambda_c of undeformed material. Wavelengths, divided by 1 - eps, are lambda_c at
    eps_c, and change from there in proportion to the strain. Each kind is weighted by its own scatter, so that the
    wavelengths decide on lambda_c where Eq. 1 misses the amplitudes by more than noise.

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
        parameters = _weighted_fit(data, parameters, scatter)
        scatter = np.maximum([_rms(r) for r in data.residuals(parameters)], LEAST_SCATTER * parameters[1])
    noise = float(np.median(series.amplitude_noise[used]))
    return CompressionFit(
        **dict(zip(NAMES, parameters.tolist(), strict=True)),
        covariance=_covariance(data, parameters, noise),
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
        onset, wavelength, initial, drift = parameters.tolist()
        expected = wrinkle_amplitude(
            self.strain,
            critical_strain=onset,
            critical_wavelength=wavelength,
            initial_amplitude=initial,
        )
        material = wavelength * (1.0 + drift * (self.strain[self.seen] - onset))
        return self.amplitude - expected, self.material[self.seen] - material


def _start(strain: Array, amplitude: Array, material: Array) -> Array | None:
    """First guess, from the line of A^2 on the strain that Eq. 1 is to leading order."""
    wavelength = float(np.median(material))
    slope, intercept = np.polyfit(strain, (np.pi * amplitude / wavelength) ** 2, 1)
    if not slope > 0.0:
        return None
    onset = float(np.clip(-intercept / slope, 1e-3, strain.max()))
    return np.array([onset, wavelength, 1e-3 * wavelength, 0.0])


def _weighted_fit(data: _Data, start: Array, scatter: Array) -> Array:
    from scipy.optimize import least_squares

    scale = np.array([0.05, start[1], 0.01 * start[1], 0.1])

    def weighted(scaled: Array) -> Array:
        found = data.residuals(scaled * scale)
        return np.concatenate([r / s for r, s in zip(found, scatter, strict=True)])

    bounds = np.array([1e-6, 1e-3, 0.0, -20.0]), np.array([20.0, 1e3, 50.0, 20.0])
    inside = np.clip(start / scale, bounds[0] + 1e-9, bounds[1] - 1e-9)
    return np.asarray(least_squares(weighted, inside, bounds=bounds, xtol=1e-12, ftol=1e-12).x) * scale


def _covariance(data: _Data, parameters: Array, noise: float) -> Array:
    """Inverse of the information: each kind's Jacobian over its variance, for as many images as are independent.

    A common factor of all amplitudes is a fifth parameter, known beforehand to ``SCALE_SIGMA``. The power of the noise,
    which is taken off all amplitudes, is known to ``NOISE_POWER_SIGMA``: that limits what can be said of wrinkles
    fainter than it.
    """
    n = len(NAMES)
    information = np.zeros((n + 1, n + 1))
    information[n, n] = SCALE_SIGMA**-2
    residuals = data.residuals(parameters)
    scaled = (data.amplitude - residuals[0], np.zeros(residuals[1].size))
    for kind in range(2):
        columns = [_slope(data, parameters, k, kind) for k in range(n)]
        slopes = np.stack([*columns, scaled[kind]], axis=1)
        residual = residuals[kind]
        share = max(independent_count(residual) - 2.0, 1.0) / residual.size  # each kind spends two parameters
        variance = max(float(np.mean(residual**2)), (LEAST_SCATTER * parameters[1]) ** 2) / share
        information += slopes.T @ slopes / variance
    covariance = _inverse(information)[:n, :n]
    initial = parameters[INITIAL]
    faint = np.sqrt(initial**2 + 2.0 * NOISE_POWER_SIGMA * noise**2) - initial
    covariance[0, 0] += (SCALE_SIGMA * parameters[0]) ** 2
    covariance[INITIAL, INITIAL] += faint**2
    return covariance


def _slope(data: _Data, parameters: Array, k: int, kind: int) -> Array:
    """Derivative of one kind's expected values by parameter ``k``; one-sided for an initial amplitude of zero."""
    step = np.zeros(parameters.size)
    step[k] = 1e-4 * (0.05, parameters[1], max(parameters[INITIAL], 1e-2 * parameters[1]), 0.1)[k]
    below = parameters if k == INITIAL and parameters[k] < step[k] else parameters - step
    above = parameters + step
    return (data.residuals(below)[kind] - data.residuals(above)[kind]) / (above - below)[k]


def _inverse(information: Array) -> Array:
    """Inverse of a matrix whose parameters have very different units."""
    scale = np.sqrt(np.maximum(np.diag(information), np.finfo(float).tiny))
    return np.asarray(np.linalg.pinv(information / np.outer(scale, scale)) / np.outer(scale, scale))


def _rms(values: Array) -> float:
    return float(np.sqrt(np.mean(values**2)))
