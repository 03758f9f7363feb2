"""Wrinkles of a slowly compressed sample against the strain along its arc (Figs. 1D, 1E, S3 and S6).

Every image's surface is unrolled: the smooth surface's arc, from end to end, becomes the undeformed length of the
sample, and what stands out of it along its normal the height of the wrinkles. Material points keep their places in
these coordinates as long as the sample is strained evenly along its arc, so that windows mean the same material in all
images, and a wavelength L in them is L (1 - eps) on the compressed sample. Eq. 1 holds for material points: its
lambda_c is the former.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.filters import ORDER, low_pass
from wrinklewave.analysis.strain import arc_positions
from wrinklewave.analysis.subject import Settings, Subject, subject_of
from wrinklewave.analysis.wrinkles import (
    WavelengthSpectra,
    amplitude_envelope,
    mean_amplitude,
    wavelength_spectra,
)
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr

NOISE_ENVELOPE = np.sqrt(np.pi / 2)
"""Mean envelope of Gaussian noise over its standard deviation."""
ARC_CUTOFF = 1.4
"""Cut-off of the arc's smoothing over the filter's: where wrinkles reach the ends, the filter follows the last half
wave and lengthens the arc; too long a cut-off rounds the bulge and shortens it."""
MARGIN_SHARE = 0.5
"""Wrinkles count as suppressed where their envelope stays below this share of the mean in the window."""
DOUBLED_SHARE = 0.1
"""Period doubling has begun when a wave of twice the wavelength has this share of the wrinkles' amplitude."""


@dataclass(frozen=True)
class CompressionSeries:
    """What the images of a slow compression show; arrays of shape [n_images] unless said otherwise.

    Attributes:
        name: of the test.
        length: undeformed length L_0 of the sample [m].
        strain: 1 - s / s_0, s the arc length without wrinkles, s_0 that of the undeformed images.
        undeformed_arc: s_0 [m].
        amplitude: mean of the Hilbert envelope over the window, freed of what noise adds; what the filter takes of
            wrinkles of their wavelength is given back [m].
        amplitude_noise: mean envelope of the noise alone [m]; zero where the uncertainty of heights is unknown.
        wavelength: of the strongest Fourier component, on the compressed sample, along its arc [m]; NaN where there
            are no wrinkles.
        material_wavelength: the same in the undeformed sample, wavelength / (1 - strain) [m].
        doubled: amplitude of a wave of twice the material wavelength over that of the wrinkles' own.
        struck_margin, held_margin: undeformed distances from the ends to where the envelope first reaches half the
            amplitude [m]; NaN where there are no wrinkles.
        X: undeformed positions [m], shape [n_X].
        height: of the wrinkles, shape [n_images, n_X]. envelope: their local amplitude, same shape [m].
        spectra: of the material wavelengths in the window.
        window: undeformed positions over which amplitude and wavelength are taken [m].
        threshold: amplitude from which on there are wrinkles [m].
    """

    name: str
    length: float
    strain: Array
    undeformed_arc: float
    amplitude: Array
    amplitude_noise: Array
    wavelength: Array
    material_wavelength: Array
    doubled: Array
    struck_margin: Array
    held_margin: Array
    X: Array
    height: Array
    envelope: Array
    spectra: WavelengthSpectra
    window: tuple[float, float]
    threshold: float

    @property
    def doubling_strain(self) -> float:
        """Smallest strain from which on all images with wrinkles show period doubling; NaN if the last does not."""
        order = np.argsort(self.strain)
        known = order[np.isfinite(self.doubled[order])]
        single = np.flatnonzero(~(self.doubled[known] >= DOUBLED_SHARE))
        first = int(single[-1]) + 1 if single.size else 0
        return float(self.strain[known[first]]) if first < known.size else float("nan")


def compression_series(
    surface: xr.Dataset, settings: Settings, *, undeformed_images: int = 1
) -> CompressionSeries:
    """Analyse the surfaces of a slowly compressed sample, measured or simulated; one time is one image.

    Args:
        surface: a surface motion; the uncertainty ``u_y_sigma``, where it has one, tells the noise.
        settings: the section ``analysis`` of a case or an experiment; its window is one of undeformed positions.
        undeformed_images: how many, from the first on, show the undeformed sample.

    Raises:
        InputError: if there are fewer than four images, or the grid is uneven or does not suit the filter.
    """
    subject, cutoff = subject_of(surface), settings.filter_wavelength
    X, height, arcs = _unrolled_surface(subject, cutoff)
    undeformed_arc = float(np.nanmean(arcs[:undeformed_images]))
    envelope = amplitude_envelope(height)
    noise = _noise(surface, subject, undeformed_images)
    window = settings.amplitude_window
    raw = mean_amplitude(envelope, X, window=window)
    spectra = wavelength_spectra(height, X, window=window, longest=cutoff)
    wrinkled = raw >= settings.wrinkle_threshold
    material = np.where(wrinkled, spectra.peak, np.nan)
    strain = 1.0 - arcs / undeformed_arc
    usual = float(np.median(material[wrinkled])) if wrinkled.any() else 0.0
    seen = np.where(wrinkled, material, usual) * (1.0 - strain)
    amplitude = np.sqrt(np.maximum(raw**2 - (NOISE_ENVELOPE * noise) ** 2, 0.0)) / _kept(seen, cutoff)
    margins = np.array(
        [_margins(row, X, limit) for row, limit in zip(envelope, MARGIN_SHARE * raw, strict=True)]
    )
    margins[~wrinkled] = np.nan
    return CompressionSeries(
        name=subject.name,
        length=subject.length,
        strain=strain,
        undeformed_arc=undeformed_arc,
        amplitude=amplitude,
        amplitude_noise=NOISE_ENVELOPE * noise,
        wavelength=material * (1.0 - strain),
        material_wavelength=material,
        doubled=_doubled(spectra, material) * _kept(seen, cutoff) / _kept(2.0 * seen, cutoff),
        struck_margin=margins[:, 0],
        held_margin=margins[:, 1],
        X=X,
        height=height,
        envelope=envelope,
        spectra=spectra,
        window=window,
        threshold=settings.wrinkle_threshold,
    )


def _unrolled_surface(subject: Subject, cutoff: float) -> tuple[Array, Array, Array]:
    """Undeformed positions X, heights of the wrinkles there [n_images, n_X], and arc lengths [n_images], all in m."""
    smooth, smoother = (
        low_pass(subject.y, spacing=subject.pixel, cutoff_wavelength=wavelength)
        for wavelength in (cutoff, ARC_CUTOFF * cutoff)
    )
    X = np.arange(0.0, subject.length + 0.5 * subject.pixel, subject.pixel)
    heights, arcs = [], []
    for y, low, lowest, end in zip(subject.y, smooth, smoother, subject.x_boundary, strict=True):
        along, arc = arc_positions(subject.x, lowest, start=end, end=subject.length)
        heights.append(_unrolled(subject.x, y, low, along * subject.length / arc, X))
        arcs.append(arc)
    return X, np.stack(heights), np.array(arcs)


def _unrolled(x: Array, y: Array, smooth: Array, along: Array, X: Array) -> Array:
    """Height of the wrinkles along the normal at undeformed positions [m], shape [n_X]; NaN beyond the surface.

    A point d above the smooth surface of inclination alpha stands d cos(alpha) out of it, d sin(alpha) further along.
    """
    from scipy.interpolate import CubicSpline

    known = np.isfinite(y) & np.isfinite(smooth) & np.isfinite(along)
    if known.sum() < 4:
        return np.full(X.size, np.nan)
    x, d, along = x[known], (y - smooth)[known], along[known]
    alpha = np.arctan(np.gradient(smooth[known], x))
    stretch = np.gradient(along, x) * np.cos(alpha)  # of undeformed positions along the arc
    foot = along + stretch * d * np.sin(alpha)
    order = np.argsort(foot)
    height = CubicSpline(foot[order], (d * np.cos(alpha))[order])(X)
    return np.where((foot.min() <= X) & (foot.max() >= X), height, np.nan)


def _noise(surface: xr.Dataset, subject: Subject, undeformed_images: int) -> Array:
    """Root mean square of the standard uncertainty of an image's heights [m]; zero where it is unknown.

    That of displacements has the share of the undeformed images in it.
    """
    if "u_y_sigma" not in surface:
        return np.zeros(subject.time.size)
    sigma = surface["u_y_sigma"].values
    known = np.isfinite(sigma)
    mean_square = (
        np.where(known, sigma, 0.0) ** 2 @ np.ones(subject.x.size) / np.maximum(known.sum(axis=1), 1)
    )
    return np.sqrt(mean_square / (1.0 + 1.0 / undeformed_images))


def _margins(envelope: Array, X: Array, limit: float) -> tuple[float, float]:
    """Distances from both ends to where the envelope first reaches ``limit`` [m]."""
    reached = np.flatnonzero(envelope >= limit)
    if not limit > 0.0 or reached.size == 0:
        return float("nan"), float("nan")
    return float(X[reached[0]] - X[0]), float(X[-1] - X[reached[-1]])


def _kept(wavelength: Array, cutoff: float) -> Array:
    """Share of a wave of this wavelength in the laboratory that the filter of this cut-off leaves to the wrinkles."""
    return np.asarray(1.0 / (1.0 + (wavelength / cutoff) ** (2 * ORDER)))


def _doubled(spectra: WavelengthSpectra, material: Array) -> Array:
    """Magnitude at twice the material wavelength over that at the wavelength itself, shape [n_images]."""
    shares = np.full(material.size, np.nan)
    for image in np.flatnonzero(np.isfinite(material)):
        twice, own = (
            np.interp(factor * material[image], spectra.wavelength, spectra.magnitude[image])
            for factor in (2.0, 1.0)
        )
        shares[image] = twice / own
    return shares
