"""Small-strain viscoelasticity of solids with a Prony series: dynamic moduli and characteristic times.

E(t) = E_0 + sum_k E_k exp(-t/tau_k), and the same for any other modulus. One term is the standard linear
solid. Source: Lakes, Viscoelastic Materials (2009), chapters 2 and 3, doi:10.1017/CBO9780511626722.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def complex_modulus(
    omega: ArrayLike, long_term: float, shares: ArrayLike, relaxation_times: ArrayLike
) -> NDArray[np.complex128]:
    """Complex modulus E* = E' + i E'' = E_0 + sum_k E_k i omega tau_k / (1 + i omega tau_k).

    Its real part is the storage modulus, for one term E_0 + E_1 (omega tau)^2 / (1 + (omega tau)^2); its
    imaginary part is the loss modulus E_1 omega tau / (1 + (omega tau)^2).

    Args:
        omega: angular frequency [rad/s], any shape.
        long_term: E_0 [Pa].
        shares: E_k [Pa], shape [n_terms].
        relaxation_times: tau_k [s], shape [n_terms].

    Returns:
        [Pa], of the shape of ``omega``.
    """
    phase = 1j * np.asarray(omega, dtype=np.float64)[..., np.newaxis] * np.asarray(relaxation_times)
    return long_term + (phase / (1 + phase)) @ np.asarray(shares, dtype=np.float64)


def retardation_times(
    long_term: float, shares: ArrayLike, relaxation_times: ArrayLike
) -> NDArray[np.float64]:
    """Times in which the strain under a constant stress creeps [s], shape [n_terms], increasing.

    They are the -1/s at which the relaxance E_0 + sum_k E_k s tau_k/(1 + s tau_k) vanishes; for one term
    tau (E_0 + E_1)/E_0. With the stress q_k in each Maxwell branch and none in total, dq_k/dt = -q_k/tau_k +
    E_k deps/dt and (E_0 + sum E_k) deps/dt = sum q_k/tau_k make a linear system with these times.

    Args:
        long_term: E_0 [Pa].
        shares: E_k [Pa], shape [n_terms].
        relaxation_times: tau_k [s], shape [n_terms].
    """
    E_k, rates = np.asarray(shares, dtype=np.float64), 1 / np.asarray(relaxation_times, dtype=np.float64)
    system = np.outer(E_k, rates) / (long_term + E_k.sum()) - np.diag(rates)
    return np.sort(-1 / np.linalg.eigvals(system).real)
