"""Independent static answers: the stored energy of a block in plain NumPy, and its minimum by Newton's method.

    E(u) = sum over elements of  mu/2 ∫ (J^(-2/3) I1 - 3) dA + A K/2 (J̄ - 1)²  [+ hourglass energy]

J̄ is the ratio of an element's areas. The mean-dilatation element integrates the first term at 2 x 2 Gauss points, the
one-point element at its centre, and adds the hourglass energy k |q|²/2 with q = sum_a h_a (x_a - F X_a) and
k = factor mu A (7/72) sum_a |grad N_a|². Everything works with complex displacements, so that derivatives by the
complex step, Im E(u + i h d)/h, are exact to rounding.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.sparse import csr_array
from scipy.sparse.linalg import spsolve

from wrinklewave.mesh.block import GridMesh

Array = NDArray[Any]

HOURGLASS = np.array([1.0, -1.0, 1.0, -1.0])
CORNERS = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1]])
COMPLEX_STEP = 1e-30


@dataclass(frozen=True, eq=False)
class ElasticBlock:
    """A block of one neo-Hookean material.

    Args:
        mesh: the undeformed mesh.
        mu, K: shear and bulk modulus [Pa].
        element: ``"one-point"`` or ``"mean-dilatation"``.
        hourglass: factor of the one-point element's hourglass stiffness.
    """

    mesh: GridMesh
    mu: float
    K: float
    element: str
    hourglass: float = 1.0

    @cached_property
    def nodes(self) -> Array:
        """Node numbers of each element, counter-clockwise, shape [n_elements, 4]."""
        number = np.arange(self.mesh.X.size).reshape(self.mesh.X.shape)
        corners = [number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]]
        return np.stack(corners, axis=-1).reshape(-1, 4)

    @cached_property
    def corners(self) -> Array:
        """Undeformed corners of each element [m], shape [n_elements, 4, 2]."""
        return np.stack([self.mesh.X.ravel(), self.mesh.Y.ravel()], axis=-1)[self.nodes]

    @cached_property
    def gradients(self) -> tuple[Array, Array]:
        """dN/dX [1/m], shape [n_points, n_elements, 4, 2], and areas of the points [m²], [n_points, n_elements]."""
        if self.element == "one-point":
            places, weight = np.zeros((1, 2)), 4.0
        else:
            places, weight = CORNERS / np.sqrt(3.0), 1.0
        natural = np.array([self._natural(p) for p in places])  # [n_points, 4, 2]
        jacobian = np.einsum("gac,eak->geck", natural, self.corners)  # dX_k/dxi_c
        inverse = np.linalg.inv(jacobian)  # dxi_c/dX_k
        return np.einsum("gac,gekc->geak", natural, inverse), weight * np.linalg.det(jacobian)

    def _natural(self, place: Array) -> Array:
        """dN_a/dxi_c at a place, shape [4, 2]."""
        factors = 1 + CORNERS * place
        return 0.25 * CORNERS * factors[:, ::-1]

    @cached_property
    def areas(self) -> Array:
        """Undeformed areas [m²], shape [n_elements]."""
        return _area(self.corners)

    @cached_property
    def hourglass_modes(self) -> tuple[Array, Array]:
        """What makes q of the nodal displacements, shape [n_elements, 4], and the stiffness k [N/m²], [n_elements]."""
        dN = self.gradients[0][0]
        mode = HOURGLASS - np.einsum("a,eak,ebk->eb", HOURGLASS, self.corners, dN)
        k = self.hourglass * self.mu * self.areas * 7.0 / 72.0 * np.sum(dN**2, axis=(1, 2))
        return mode, k

    def energy(self, u: Array) -> Any:
        """Stored energy [J/m] of the displacements ``u`` [m], shape [2, n_rows + 1, n_columns + 1]."""
        U = u.reshape(2, -1).T[self.nodes]
        F = np.eye(2) + np.einsum("eai,geak->geik", U, self.gradients[0])
        J = F[..., 0, 0] * F[..., 1, 1] - F[..., 0, 1] * F[..., 1, 0]
        shear = 0.5 * self.mu * (J ** (-2 / 3) * (np.sum(F * F, axis=(2, 3)) + 1) - 3)
        volume = 0.5 * self.K * self.areas * (_area(self.corners + U) / self.areas - 1) ** 2
        return np.sum(shear * self.gradients[1]) + np.sum(volume) + self.hourglass_energy(u)

    def hourglass_energy(self, u: Array) -> Any:
        """Part of the energy that the hourglass control stores [J/m]."""
        if self.element != "one-point":
            return 0.0
        mode, k = self.hourglass_modes
        q = np.einsum("ea,eai->ei", mode, u.reshape(2, -1).T[self.nodes])
        return 0.5 * np.sum(k[:, None] * q**2)

    def element_forces(self, U: Array) -> Array:
        """Forces on the corners of each element [N/m], of the shape of their displacements, [n_elements, 4, 2]."""
        dN, dA = self.gradients
        F = np.eye(2) + np.einsum("eai,geak->geik", U, dN)
        J = F[..., 0, 0] * F[..., 1, 1] - F[..., 0, 1] * F[..., 1, 0]
        cofactor = np.empty_like(F)
        cofactor[..., 0, 0], cofactor[..., 0, 1] = F[..., 1, 1], -F[..., 1, 0]
        cofactor[..., 1, 0], cofactor[..., 1, 1] = -F[..., 0, 1], F[..., 0, 0]
        third = (np.sum(F * F, axis=(2, 3)) + 1) / (3 * J)
        P = self.mu * (J ** (-2 / 3) * dA)[..., None, None] * (F - third[..., None, None] * cofactor)
        f = np.einsum("geik,geak->eai", P, dN)
        pressure = self.K * (_area(self.corners + U) / self.areas - 1)
        f += pressure[:, None, None] * _area_gradient(self.corners + U)
        if self.element == "one-point":
            mode, k = self.hourglass_modes
            f += np.einsum("e,ea,eb,ebi->eai", k, mode, mode, U)
        return f

    def gradient(self, u: Array) -> Array:
        """Internal forces dE/du [N/m], of the shape of ``u``."""
        out = np.zeros((self.mesh.X.size, 2))
        np.add.at(out, self.nodes, self.element_forces(u.reshape(2, -1).T[self.nodes]))
        return out.T.reshape(u.shape)

    def stiffness(self, u: Array) -> csr_array:
        """d²E/du² [N/m²] of all degrees of freedom, by complex steps of each corner of all elements at once."""
        U = u.reshape(2, -1).T[self.nodes].astype(complex)
        columns = []
        for a in range(4):
            for i in range(2):
                shifted = U.copy()
                shifted[:, a, i] += 1j * COMPLEX_STEP
                columns.append(self.element_forces(shifted).imag / COMPLEX_STEP)
        values = np.stack(columns, axis=-1).reshape(-1, 8, 8)
        place = (self.nodes[:, :, None] + self.mesh.X.size * np.arange(2)).reshape(-1, 8)
        rows, columns_of = np.broadcast_arrays(place[:, :, None], place[:, None, :])
        return csr_array((values.ravel(), (rows.ravel(), columns_of.ravel())), shape=(u.size, u.size))

    def equilibrium(self, u: Array, held: Array) -> Array:
        """Displacements of least energy, from the guess ``u``; those where ``held`` is true stay as they are."""
        free = np.flatnonzero(~held)
        u = u.copy()
        scale = self.mu * float(np.sqrt(self.areas.max()))
        for _ in range(30):
            residual = self.gradient(u).ravel()[free]
            if np.abs(residual).max() < 1e-11 * scale:
                return u
            u.flat[free] -= spsolve(self.stiffness(u)[free][:, free], residual)
        raise AssertionError("Newton's method does not converge: take smaller load steps")


def _area(x: Array) -> Array:
    """Areas of quadrilaterals, corners [..., 4, 2]."""
    d13, d24 = x[..., 2, :] - x[..., 0, :], x[..., 3, :] - x[..., 1, :]
    return 0.5 * (d13[..., 0] * d24[..., 1] - d13[..., 1] * d24[..., 0])


def _area_gradient(x: Array) -> Array:
    """d(area)/d(corner), of the shape of ``x``: half the opposite diagonal, turned by a right angle."""
    before, after = np.roll(x, 1, axis=-2), np.roll(x, -1, axis=-2)
    d = after - before
    return 0.5 * np.stack([d[..., 1], -d[..., 0]], axis=-1)
