"""Films on a substrate that is the stiffer the faster it is strained (Fig. S4 of "Wrinkles Riding Waves").

The substrate's momentary modulus is estimated as the ratio of depth-averaged nominal stress and strain, and
put into eps_c = (3 E_s / E_f)^(2/3) / 4: the critical strain grows with E_s^(2/3).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.laboratory_frame import Array


def instantaneous_modulus(stress: ArrayLike, strain: ArrayLike, *, smallest_strain: float) -> Array:
    """Ratio of stress to strain [Pa], shape of the arguments; NaN where the strain is too small to divide by.

    Args:
        stress: depth-averaged nominal stress [Pa], compression > 0.
        strain: depth-averaged nominal strain, compression > 0.
        smallest_strain: strains below it give no modulus.
    """
    stress, strain = np.broadcast_arrays(np.asarray(stress, dtype=float), np.asarray(strain, dtype=float))
    modulus = np.full(strain.shape, np.nan)
    np.divide(stress, strain, out=modulus, where=strain >= smallest_strain)
    return modulus


def instantaneous_critical_strain(
    modulus: ArrayLike, *, critical_strain: float, long_term_modulus: float
) -> Array:
    """Critical strain of the film on a substrate of momentary modulus ``modulus`` [Pa].

    Args:
        modulus: from ``instantaneous_modulus``; a negative one (stress and strain of opposite sign) gives
            NaN.
        critical_strain: measured quasi-statically, where the substrate has its long-term modulus.
        long_term_modulus: of the same kind as ``modulus``: in plane strain E_0 / (1 - nu^2) [Pa].
    """
    ratio = np.asarray(modulus, dtype=float) / long_term_modulus
    return critical_strain * np.where(ratio >= 0.0, np.abs(ratio) ** (2.0 / 3.0), np.nan)
