"""The neo-Hookean solid in three-dimensional matrix form, written without the solver's help."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def in_space(F: Array) -> Array:
    """A plane deformation gradient in three dimensions: F33 = 1."""
    G = np.eye(3)
    G[:2, :2] = F
    return G


def first_piola_kirchhoff(F: Array, mu: float, K: float) -> Array:
    """P = dW/dF = mu J^(-2/3) (F - (I1/3) F^-T) + K (J - 1) J F^-T [Pa], in-plane components."""
    G = in_space(F)
    J, G_T = np.linalg.det(G), np.linalg.inv(G).T
    P = mu * J ** (-2 / 3) * (G - np.sum(G * G) / 3 * G_T) + K * (J - 1) * J * G_T
    return P[:2, :2]


def cauchy(F: Array, P: Array) -> Array:
    """sigma = P F^T / J [Pa]."""
    return P @ F.T / np.linalg.det(F)
