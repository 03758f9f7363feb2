"""Half a wavelength of film and substrate as implicit finite elements: a solver of its own to hold the model against.

Nine-node quadrilaterals, plane strain, without inertia; both ends are planes of symmetry that move together as the
strain says, the base slips. Material as in :mod:`wrinklewave.theory.biaxial`, but for any deformation:

    S = J p C^-1 + J^(-2/3) (A - (A : C / 3) C^-1),   A = mu shape + memory,   shape = 1 - (tr C / 3) C^-1,
    p = K (J - 1) + memory,

with one Prony term at most. Lengths and stresses in any units.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csc_matrix
from scipy.sparse.linalg import splu

from wrinklewave.materials.moduli import Viscoelastic

Array = NDArray[np.float64]
PLACES, WEIGHTS = np.array([-(0.6**0.5), 0.0, 0.6**0.5]), np.array([5.0, 8.0, 5.0]) / 9.0


@dataclass(frozen=True)
class Strip:
    """Mesh and moduli, shapes for n nodes in columns [n_x, n_y], e elements and 9 points in each.

    Args:
        X: undeformed positions, imperfection included, shape [n, 2].
        columns: numbers of the nodes, the base first, shape [n_x, n_y].
        elements: nodes of each, shape [e, 9].
        gradients: of the shape functions, shape [e, 9, 9, 2].
        volumes: of the points, shape [e, 9].
        mu, K, mu_1, K_1: moduli, shape [e, 1]; the last two relax in ``tau``.
    """

    X: Array
    columns: NDArray[np.int64]
    elements: NDArray[np.int64]
    gradients: Array
    volumes: Array
    mu: Array
    K: Array
    mu_1: Array
    K_1: Array
    tau: float


def strip(
    film: Viscoelastic, substrate: Viscoelastic, *, thickness: float, wavelength: float, imperfection: float
) -> Strip:
    """Mesh half a wavelength: 4 elements along, 2 through the film, 8 through two wavelengths of substrate."""
    x = np.linspace(0.0, wavelength / 2, 9)
    layers = np.geomspace(12.0, 1.0, 8)
    edges = np.concatenate([[0.0], np.cumsum(layers)]) / layers.sum() * 2 * wavelength - 2 * wavelength
    edges = np.concatenate([edges, thickness * np.array([0.5, 1.0])])
    y = np.sort(np.concatenate([edges, 0.5 * (edges[1:] + edges[:-1])]))
    columns = np.arange(x.size * y.size).reshape(x.size, y.size)
    X, Y = np.meshgrid(x, y, indexing="ij")
    below = np.clip(1.0 + Y / (2 * wavelength), 0.0, 1.0) ** 2
    Y = Y + imperfection * np.cos(2 * np.pi * X / wavelength) * below
    nodes = np.stack([X.ravel(), Y.ravel()], axis=1)
    corners = [(i, j) for i in range(0, x.size - 1, 2) for j in range(0, y.size - 1, 2)]
    elements = np.array([columns[i : i + 3, j : j + 3].ravel() for i, j in corners])
    in_film = np.array([y[j] >= -1e-12 for _, j in corners])[:, np.newaxis]
    gradients, volumes = _gradients(nodes[elements])

    def pair(name: str) -> Array:
        values = [np.sum(getattr(solid, name)) for solid in (film, substrate)]
        return np.where(in_film, *values)

    tau = float([*film.tau_k, *substrate.tau_k, 1.0][0])
    moduli = (pair(name) for name in ("mu_inf", "K_inf", "mu_k", "K_k"))
    return Strip(nodes, columns, elements, gradients, volumes, *moduli, tau)


def surface_amplitudes(strip: Strip, strains: Array, step: float) -> Array:
    """Half the difference in height between the top's two ends, after each of the strains, ``step`` apart."""
    n = strip.X.shape[0]
    u, left_A, left_p = np.zeros((n, 2)), None, None
    fixed = np.concatenate([2 * strip.columns[0], 2 * strip.columns[-1], 2 * strip.columns[:, 0] + 1])
    free = np.setdiff1d(np.arange(2 * n), fixed)
    keep, add = np.exp(-step / strip.tau), -np.expm1(-step / strip.tau) * strip.tau / step
    shape = np.zeros((*strip.volumes.shape, 3, 3))
    H, h, dilation = shape, 0.0 * strip.volumes, 0.0 * strip.volumes
    amplitudes, strain_before = [], 0.0
    for strain in strains:
        u = u + (strain - strain_before) * (strip.X - strip.X.min(axis=0)) * [-1.0, 1.0]
        strain_before = strain
        left_A = keep * H - add * strip.mu_1[..., np.newaxis, np.newaxis] * shape
        left_p = keep * h - add * strip.K_1 * dilation
        mu, K = strip.mu + add * strip.mu_1, strip.K + add * strip.K_1
        for _ in range(20):
            force, stiffness, new_shape, new_dilation = _assembled(strip, u, mu, K, left_A, left_p)
            change = np.zeros(2 * n)
            change[free] = -splu(stiffness[free][:, free]).solve(force[free])
            u = u + change.reshape(-1, 2)
            if np.abs(change).max() < 1e-10:
                break
        H = left_A + add * strip.mu_1[..., np.newaxis, np.newaxis] * new_shape
        h = left_p + add * strip.K_1 * new_dilation
        shape, dilation = new_shape, new_dilation
        top = (strip.X + u)[strip.columns[:, -1], 1]
        amplitudes.append(0.5 * (top[0] - top[-1]))
    return np.array(amplitudes)


def _assembled(
    strip: Strip, u: Array, mu: Array, K: Array, left_A: Array, left_p: Array
) -> tuple[Array, csc_matrix, Array, Array]:
    """Nodal forces, their derivative, and the isochoric shape and J - 1 of the points."""
    F = np.einsum("eai,eqaj->eqij", u[strip.elements], strip.gradients) + np.eye(2)
    C = np.einsum("eqki,eqkj->eqij", F, F)
    J = np.linalg.det(F)
    Ci, trace = np.linalg.inv(C), C[..., 0, 0] + C[..., 1, 1] + 1.0
    shape = np.eye(3) - np.zeros((*J.shape, 3, 3))
    shape[..., :2, :2] -= _up(trace / 3, 2) * Ci
    shape[..., 2, 2] -= trace / 3
    A, p = left_A + _up(mu, 2) * shape, left_p + K * (J - 1.0)
    j, A_C = J ** (-2 / 3), np.einsum("eqij,eqij->eq", A[..., :2, :2], C) + A[..., 2, 2]
    A = A[..., :2, :2]
    S = _up(J * p - j * A_C / 3, 2) * Ci + _up(j, 2) * A

    CC = np.einsum("eqij,eqkl->eqijkl", Ci, Ci)
    mixed = np.einsum("eqij,eqkl->eqijkl", A, Ci) + np.einsum("eqij,eqkl->eqijkl", Ci, A)
    turned = np.einsum("eqik,eqjl->eqijkl", Ci, Ci)
    turned = 0.5 * (turned + turned.swapaxes(-1, -2))
    D = _up(J * p + J**2 * K + 2 / 9 * j * (A_C - mu * trace), 4) * CC - _up(2 / 3 * j, 4) * mixed
    D += _up(2 / 3 * j * (A_C + mu * trace) - 2 * J * p, 4) * turned
    moduli = np.einsum("eqik,eqkjlm,eqnl->eqijnm", F, D, F) + np.einsum("in,eqjm->eqijnm", np.eye(2), S)

    forces = np.einsum("eq,eqij,eqaj->eai", strip.volumes, F @ S, strip.gradients).reshape(-1, 18)
    K_e = np.einsum("eqaj,eqijnm->eqainm", strip.gradients * _up(strip.volumes, 2), moduli)
    K_e = np.einsum("eqainm,eqbm->eaibn", K_e, strip.gradients).reshape(-1, 18, 18)
    dofs = (2 * strip.elements[..., np.newaxis] + [0, 1]).reshape(-1, 18)
    place = (np.repeat(dofs, 18, axis=1).ravel(), np.tile(dofs, 18).ravel())
    return np.bincount(dofs.ravel(), forces.ravel()), csc_matrix((K_e.ravel(), place)), shape, J - 1.0


def _up(values: Array, axes: int) -> Array:
    return values.reshape(*values.shape, *(1,) * axes)


def _gradients(X: Array) -> tuple[Array, Array]:
    """Gradients [e, 9, 9, 2] and volumes [e, 9] of nine-node elements with nodes ``X`` [e, 9, 2]."""
    value = np.array([[a * (a - 1) / 2, 1 - a * a, a * (a + 1) / 2] for a in PLACES])
    slope = np.array([[a - 0.5, -2 * a, a + 0.5] for a in PLACES])
    along = np.einsum("pa,qb->pqab", slope, value).reshape(9, 9)
    across = np.einsum("pa,qb->pqab", value, slope).reshape(9, 9)
    derivatives = np.stack([along, across], axis=-1)
    jacobian = np.einsum("eai,qaj->eqij", X, derivatives)
    volumes = np.linalg.det(jacobian) * np.outer(WEIGHTS, WEIGHTS).ravel()
    return np.einsum("qaj,eqji->eqai", derivatives, np.linalg.inv(jacobian)), volumes
