"""Quasi-static wrinkling of a stiff film on a soft foundation: Eq. 1 of "Wrinkles Riding Waves ...", after Brau et al.

Nature Physics 7, 56 (2011), doi:10.1038/nphys1806:

    lambda = lambda_c [1 - (eps - eps_c)]
    A = lambda_c sqrt(eps - eps_c) / pi * [1 - 3/8 (eps - eps_c) - 17/128 (eps - eps_c)^2]

A is the series of an inextensible film in the material coordinate; eps is the compressive nominal strain. Below the
critical strain there are no wrinkles: the amplitude is zero and the wavelength undefined (NaN).

A film that is wrinkled before it is compressed, with the amplitude A_i, has no such threshold. Equilibrium of
the mode asks that the bending of film and foundation, in proportion to A - A_i, balances what the compressed
film pushes sideways, in proportion to A, with the strain that the wrinkles take up set against eps:

    eps = eps_c (1 - A_i / A) + e(A) - e(A_i),   e(A) the excess strain of Eq. 1 at the amplitude A.

To leading order this is Koiter's eps = eps_c (1 - A_i/A) + (pi/lambda_c)^2 (A^2 - A_i^2).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.laboratory_frame import Array

LARGEST_EXCESS = 0.6
"""Excess strain up to which the amplitude of Eq. 1 grows."""
SMALLEST_EXCESS = 1e-12
TABLE_SIZE = 4000


def wrinkle_amplitude(
    strain: ArrayLike, *, critical_strain: float, critical_wavelength: float, initial_amplitude: float = 0.0
) -> Array:
    """Wrinkle amplitude [m] at compressive strain ``strain`` (any shape; NaN stays NaN).

    Args:
        critical_strain: eps_c.
        critical_wavelength: lambda_c, in the undeformed material [m].
        initial_amplitude: A_i of wrinkles that are there before the compression [m].
    """
    strain = np.asarray(strain, dtype=float)
    if initial_amplitude == 0.0:
        return critical_wavelength * _amplitude(np.maximum(strain - critical_strain, 0.0))
    initial = initial_amplitude / critical_wavelength
    excess, amplitude = _table()
    initial_excess = np.interp(initial, amplitude, excess)
    e = np.geomspace(max(initial_excess, SMALLEST_EXCESS), LARGEST_EXCESS, TABLE_SIZE)
    A = _amplitude(e)
    reached = critical_strain * (1.0 - A[0] / A) + e - e[0]
    return critical_wavelength * np.interp(strain, reached, A)


def wrinkle_wavelength(strain: ArrayLike, *, critical_strain: float, critical_wavelength: float) -> Array:
    """Wavelength in the laboratory [m] at compressive strain ``strain``; NaN below the critical strain."""
    excess = np.asarray(strain, dtype=float) - critical_strain
    return np.where(excess >= 0.0, critical_wavelength * (1.0 - excess), np.nan)


def _amplitude(excess: Array) -> Array:
    """A / lambda_c of Eq. 1."""
    series = 1.0 - 3.0 / 8.0 * excess - 17.0 / 128.0 * excess**2
    return np.asarray(np.sqrt(excess) / np.pi * series)


def _table() -> tuple[Array, Array]:
    """Excess strains and their amplitudes, to look the inverse of Eq. 1 up in."""
    excess = np.geomspace(SMALLEST_EXCESS, LARGEST_EXCESS, TABLE_SIZE)
    return excess, _amplitude(excess)
