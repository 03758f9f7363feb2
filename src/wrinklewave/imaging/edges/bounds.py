"""Cramér-Rao bounds: how well an edge can be known from an image at all.

Derived in docs/measurement_theory.md. ``contrast_to_noise`` is the difference of grey values across the edge
over the standard deviation of a pixel's noise; lengths are in pixels.
"""

from __future__ import annotations

import numpy as np

_REACH = 10.0  # blurs on either side that are summed over


def column_bound(contrast_to_noise: float, blur: float, *, phase: float = 0.0, slope: float = 0.0) -> float:
    """Least standard deviation of an unbiased estimate of the edge's row in one column [px].

    (C/N)^-2 = sum_j [Phi((j + 1/2 - y)/s) - Phi((j - 1/2 - y)/s)]^2 sigma_y^2, with levels and blur known.

    Args:
        contrast_to_noise: contrast over noise, 1.
        blur: standard deviation of the optical blur, the pixel's size not included [px].
        phase: where between two rows the edge lies, 0 to 1.
        slope: of the edge; it widens the blur that the column sees.
    """
    from scipy.special import ndtr

    seen = np.sqrt(blur**2 * (1 + slope**2) + slope**2 / 12)
    reach = int(np.ceil(_REACH * seen)) + 2
    u = np.arange(-reach, reach + 1) - phase
    sensitivity = ndtr((u + 0.5) / seen) - ndtr((u - 0.5) / seen)
    return float(1 / (contrast_to_noise * np.sqrt(np.sum(sensitivity**2))))


def mean_column_bound(contrast_to_noise: float, blur: float) -> float:
    """Root mean square of ``column_bound`` of a level edge over all phases [px]."""
    bounds = [
        column_bound(contrast_to_noise, blur, phase=phase) for phase in np.linspace(0, 1, 16, endpoint=False)
    ]
    return float(np.sqrt(np.mean(np.square(bounds))))


def band_limited_bound(contrast_to_noise: float, blur: float, resolution: float) -> float:
    """Least standard deviation of a surface without wavelengths below ``resolution`` [px].

    Each wave number k is known from all columns, through the lateral blur exp(-k^2 v/2), v = blur^2 + 1/12:
    sigma^2 = sigma_column^2 / pi * integral of exp(k^2 v) over 0 < k < 2 pi/resolution, for a long level
    surface.
    """
    k = np.linspace(0, 2 * np.pi / resolution, 2001)
    share = np.trapezoid(np.exp(k**2 * (blur**2 + 1 / 12)), k) / np.pi
    return mean_column_bound(contrast_to_noise, blur) * float(np.sqrt(share))
