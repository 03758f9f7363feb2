"""Small plane-strain motions on top of a finite compression: the exact incremental problem of a layer.

A layer is held at the axial stretch l1, fully relaxed, with no traction across it (P22 = 0, which gives l2). On top
of it ride displacements u = U(Y) exp(s t) sin kX along and v = V(Y) exp(s t) cos kX across the layer, in the
undeformed coordinates X and Y. With P = F S the increments are

    dP = dF S + F (C(s) : dE),   C(s) = C_held + mu(s) C_shear + K(s) C_bulk,
    mu(s) = mu_inf + sum_k mu_k s tau_k / (1 + s tau_k),   and K(s) likewise,

with the stiffnesses of :mod:`wrinklewave.theory.biaxial`: the stress of the base state is relaxed, its increments are
not. The equations of motion d(dP_ij)/dX_j = rho s^2 u_i, with the tractions T1 sin kX = dP_12 and T2 cos kX = dP_22,
are a linear system of first order in Y for (U, V, T1, T2) (Stroh's form). Lengths are in units of 1/k here and
stresses in units of a shear modulus of the caller's choice.

An incompressible solid is one with K_inf = inf; its pressure increment is eliminated by the constraint.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.biaxial import bulk_stiffness, held_stiffness, normal_stress, shape, shear_stiffness

Matrix = NDArray[np.float64]


@dataclass(frozen=True)
class PrestressedLayer:
    """Moduli A_ijkl = d^2 W / dF_ij dF_kl of a compressed layer, for increments that grow as exp(s t).

    Stresses are in units of ``unit`` [Pa]. ``inertia`` is rho s^2 in units of ``unit`` [1/m^2].
    """

    stretch: float
    transverse_stretch: float
    axial_stress: float
    A_1111: float
    A_2222: float
    A_1122: float
    A_1212: float
    A_2121: float
    A_1221: float
    inertia: float
    incompressible: bool


def transverse_stretch(stretch: float, mu: float, K: float) -> float:
    """Stretch l2 at which S22 = 0 in plane strain, for moduli ``mu`` and ``K`` (inf: incompressible)."""
    from scipy.optimize import brentq

    if np.isinf(K):
        return 1.0 / stretch

    def transverse_stress(l2: float) -> float:
        return normal_stress(stretch, l2, _scaled(mu, shape(stretch, l2)), K * (stretch * l2 - 1.0))[1]

    return float(brentq(transverse_stress, 0.2, 2.0 / stretch, xtol=1e-15, rtol=1e-15))


def prestressed_layer(
    solid: Viscoelastic, stretch: float, *, rate: float = 0.0, unit: float = 1.0
) -> PrestressedLayer:
    """Compress a solid to ``stretch`` along X, let it relax, and return its moduli for increments.

    Args:
        solid: K_inf = inf stands for an incompressible solid, of which only the shear relaxes.
        stretch: axial stretch l1 = 1 - strain.
        rate: s [1/s], real; 0 for static increments.
        unit: stress unit of the result [Pa].
    """
    incompressible = bool(np.isinf(solid.K_inf))
    mu, K = solid.mu_inf / unit, solid.K_inf / unit
    l2 = transverse_stretch(stretch, mu, K)
    A = _scaled(mu, shape(stretch, l2))
    # an incompressible solid's pressure makes S_22 vanish; its increments are left to the constraint
    pressure = -normal_stress(stretch, l2, A, 0.0)[1] * l2**2 if incompressible else K * (stretch * l2 - 1.0)
    axial = normal_stress(stretch, l2, A, pressure)[0]
    active = rate * solid.tau_k / (1.0 + rate * solid.tau_k)
    tangent = np.array(held_stiffness(stretch, l2, A, pressure))
    tangent += (mu + solid.mu_k @ active / unit) * np.array(shear_stiffness(stretch, l2))
    if not incompressible:
        tangent += (K + solid.K_k @ active / unit) * np.array(bulk_stiffness(stretch, l2))
    C_1111, C_2222, C_1122, C_1212 = (float(component) for component in tangent)
    return PrestressedLayer(
        stretch=stretch,
        transverse_stretch=l2,
        axial_stress=axial,
        A_1111=axial + stretch**2 * C_1111,
        A_2222=l2**2 * C_2222,
        A_1122=stretch * l2 * C_1122,
        A_1212=stretch**2 * C_1212,
        A_2121=axial + l2**2 * C_1212,
        A_1221=stretch * l2 * C_1212,
        inertia=solid.density * rate**2 / unit,
        incompressible=incompressible,
    )


def stroh_matrix(layer: PrestressedLayer, wavenumber: float) -> Matrix:
    """N of d/d(kY) (U, V, T1/k, T2/k) = N (U, V, T1/k, T2/k), shape [4, 4].

    Args:
        layer: the compressed solid.
        wavenumber: k of the undeformed state [1/m]; it matters only through the inertia.
    """
    N = np.zeros((4, 4))
    N[0, 1], N[0, 2] = layer.A_1221 / layer.A_1212, 1.0 / layer.A_1212
    if layer.incompressible:
        N[1, 0] = -layer.transverse_stretch / layer.stretch
        pressure = layer.transverse_stretch * (layer.A_2222 * N[1] + [layer.A_1122, 0.0, 0.0, -1.0])
        N[2] = layer.A_1122 * N[1] - pressure / layer.stretch
    else:
        N[1, 0], N[1, 3] = -layer.A_1122 / layer.A_2222, 1.0 / layer.A_2222
        N[2] = layer.A_1122 * N[1]
    N[3] = -layer.A_1221 * N[0]
    N[2, 0] += layer.A_1111 + layer.inertia / wavenumber**2
    N[3, 1] += layer.A_2121 + layer.inertia / wavenumber**2
    return N


def half_space_stiffness(N: Matrix) -> Matrix:
    """Z of T = k Z U on the surface of a half-space below it, shape [2, 2]: what decays into the depth."""
    from scipy.linalg import schur

    _, vectors, _ = schur(N, sort="rhp")
    return vectors[2:, :2] @ np.linalg.inv(vectors[:2, :2])


def block_stiffness(N: Matrix, depth: float) -> Matrix:
    """Z of T = k Z U on the surface of a block whose base slips without rising (V = T1 = 0), shape [2, 2].

    Args:
        N: Stroh matrix of the block.
        depth: k times its depth.
    """
    from scipy.linalg import expm, schur

    from_surface, downward, from_base, upward = (
        part for half in ("rhp", "lhp") for part in _invariant(*schur(N, sort=half))
    )
    at_base = np.array([1, 2])  # V and T1
    decay_down, decay_up = expm(-downward * depth), expm(upward * depth)
    reflection = -np.linalg.solve(from_base[at_base], from_surface[at_base] @ decay_down)
    surface = from_surface + from_base @ decay_up @ reflection
    return surface[2:] @ np.linalg.inv(surface[:2])


def film_transfer(N: Matrix, thickness: float) -> Matrix:
    """E of (U, V, T/k) on top of a film = E (U, V, T/k) on its underside, shape [4, 4]; ``thickness`` is k h."""
    from scipy.linalg import expm

    return expm(N * thickness)


def bilayer_stiffness(film: Matrix, below: Matrix) -> Matrix:
    """Z of T = k Z U on top of a film, shape [2, 2], from its transfer matrix and the stiffness below it."""
    displacement = film[:2, :2] + film[:2, 2:] @ below
    traction = film[2:, :2] + film[2:, 2:] @ below
    return traction @ np.linalg.inv(displacement)


def _scaled(factor: float, values: Sequence[float]) -> tuple[float, float, float]:
    return factor * values[0], factor * values[1], factor * values[2]


def _invariant(triangular: Matrix, vectors: Matrix, count: int) -> tuple[Matrix, Matrix]:
    """Basis of the invariant subspace that was sorted first, and the matrix restricted to it."""
    return vectors[:, :count], triangular[:count, :count]
