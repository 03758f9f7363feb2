"""The plane-strain modulus of a relaxing solid, as a Prony series of its own.

E' = 4 mu (3 K + mu) / (3 K + 4 mu) holds for the Laplace-domain moduli mu(s), K(s) (correspondence principle). Where
shear and bulk relax in different proportion, it has twice as many relaxation times as they: beside theirs those at
which 3 K + 4 mu vanishes, in which the solid expands across the load.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wrinklewave.materials.moduli import Viscoelastic

Array = NDArray[np.float64]


@dataclass(frozen=True)
class RelaxingModulus:
    """M(t) = long_term + sum_k shares_k exp(-t / times_k) [Pa, s], shares and times of shape [n_terms]."""

    long_term: float
    shares: Array
    times: Array


def plane_strain_relaxation(solid: Viscoelastic) -> RelaxingModulus:
    """Exact relaxation of E' = E / (1 - nu^2) of a solid in plane strain, by partial fractions."""
    mu_inf, K_inf = solid.mu_inf, solid.K_inf
    long_term = 4 * mu_inf * (3 * K_inf + mu_inf) / (3 * K_inf + 4 * mu_inf)
    times, term = np.unique(solid.tau_k, return_inverse=True)  # terms of one time are one term
    rates: Array = 1.0 / times
    common = np.poly(-rates)  # prod (s + 1/tau_k), over which both moduli are polynomials of s
    mu, K = (
        _numerator(long, np.array([share[term == k].sum() for k in range(times.size)]), rates)
        for long, share in ((mu_inf, solid.mu_k), (K_inf, solid.K_k))
    )
    numerator = np.polymul(4 * mu, np.polyadd(3 * K, mu))
    denominator = np.polymul(common, np.polyadd(3 * K, 4 * mu))
    poles = np.asarray(np.roots(denominator).real, dtype=np.float64)
    residues = np.polyval(numerator, poles) / np.polyval(np.polyder(denominator), poles)
    return RelaxingModulus(long_term=long_term, shares=residues / poles, times=-1.0 / poles)


def _numerator(long_term: float, shares: Array, rates: Array) -> Array:
    """Coefficients of (long_term + sum_k shares_k s/(s + rates_k)) prod (s + rates_k), highest power first."""
    total = np.asarray(long_term * np.poly(-rates), dtype=np.float64)
    for k, share in enumerate(shares):
        total = np.polyadd(total, share * np.polymul([1.0, 0.0], np.poly(-np.delete(rates, k))))
    return total
