"""Quasi-static wrinkling of a stiff film on a soft foundation (Eq. 1 of "Wrinkles Riding Waves ...", after
Brau et al., Nature Physics 7, 56 (2011), doi:10.1038/nphys1806).

    lambda = lambda_c [1 - (eps - eps_c)]
    A = lambda_c sqrt(eps - eps_c) / pi * [1 - 3/8 (eps - eps_c) - 17/128 (eps - eps_c)^2]

A is the series of an inextensible film in the material coordinate; eps is the compressive nominal strain.
Below the
critical strain there are no wrinkles: the amplitude is zero and the wavelength undefined (NaN).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.laboratory_frame import Array


def wrinkle_amplitude(strain: ArrayLike, *, critical_strain: float, critical_wavelength: float) -> Array:
    """Wrinkle amplitude [m] at compressive strain ``strain`` (any shape; NaN stays NaN)."""
    excess = np.maximum(np.asarray(strain, dtype=float) - critical_strain, 0.0)
    series = 1.0 - 3.0 / 8.0 * excess - 17.0 / 128.0 * excess**2
    return critical_wavelength * np.sqrt(excess) / np.pi * series


def wrinkle_wavelength(strain: ArrayLike, *, critical_strain: float, critical_wavelength: float) -> Array:
    """Wavelength in the laboratory [m] at compressive strain ``strain``; NaN below the critical strain."""
    excess = np.asarray(strain, dtype=float) - critical_strain
    return np.where(excess >= 0.0, critical_wavelength * (1.0 - excess), np.nan)
