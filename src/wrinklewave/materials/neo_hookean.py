"""Nearly incompressible neo-Hookean solid in plane strain: pure scalar functions, the same on every backend.

Energy per undeformed volume (F the deformation gradient, C = Fᵀ F, J = det F)

    W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)²

(Simo & Hughes, Computational Inelasticity, 1998, ch. 9). The isochoric stress is split as ``mu * shape``, so that
linear viscoelasticity can act on the shape (:mod:`wrinklewave.materials.prony`). Plane strain: F33 = 1.
"""

from __future__ import annotations

from wrinklewave._jit import scalar

J_MIN, J_MAX = 0.15, 2.75
"""Volume ratios for which :func:`inverse_cube_root` is accurate to rounding; a run stops outside them."""


@scalar
def inverse_cube_root(J):
    """J^(-1/3) for J_MIN <= J <= J_MAX from a quadratic start: plain arithmetic, so it vectorises.

    Each step takes the power series of (1 - r)^(-1/3), r = 1 - J y³, to fourth order: the error r/3 of 0.1 at the
    start becomes 1e-4, then less than rounding.
    """
    y = 1.8257 - J * (1.0325 - 0.2369 * J)
    for _ in range(2):
        r = 1.0 - (y * y) * (J * y)
        y += (y * r) * ((1.0 / 3.0 + 2.0 / 9.0 * r) + (r * r) * (14.0 / 81.0 + 35.0 / 243.0 * r))
    return y


@scalar
def right_cauchy_green(F11, F12, F21, F22):
    """C11, C22, C12 of C = Fᵀ F."""
    return F11 * F11 + F21 * F21, F12 * F12 + F22 * F22, F11 * F12 + F21 * F22


@scalar
def isochoric_shape(C11, C22, C12, Ji2):
    """Components 11, 22, 12, 33 of DEV[1] = 1 - (tr C / 3) C⁻¹, the isochoric stress per shear modulus; Ji2 = J⁻²."""
    t = (C11 + C22 + 1.0) * (1.0 / 3.0)
    tj = t * Ji2
    return 1.0 - tj * C22, 1.0 - tj * C11, tj * C12, 1.0 - t


@scalar
def second_piola_kirchhoff(A11, A22, A12, A33, C11, C22, C12, J, J23, Ji2, p):
    """Components 11, 22, 12 of S = J p C⁻¹ + J^(-2/3) DEV[A] (Simo 1987, eq. 3.10).

    A is the isochoric stress after its history, p the mean stress, J23 = J^(-2/3), Ji2 = J⁻²;
    DEV[A] = A - (A : C / 3) C⁻¹.
    """
    a = (J * p - J23 * (A11 * C11 + A22 * C22 + 2.0 * A12 * C12 + A33) * (1.0 / 3.0)) * Ji2
    return J23 * A11 + a * C22, J23 * A22 + a * C11, J23 * A12 - a * C12


@scalar
def first_piola_kirchhoff(F11, F12, F21, F22, A11, A22, A12, A33, C11, C22, C12, J23, Ji, p):
    """Components 11, 12, 21, 22 of P = F S = J^(-2/3) F A + q cof F, q = p - J^(-2/3) A : C / (3 J).

    Symbols as in :func:`second_piola_kirchhoff`; Ji = 1/J. Linear in J23 and p taken together.
    """
    q = p - J23 * Ji * (A11 * C11 + A22 * C22 + 2.0 * A12 * C12 + A33) * (1.0 / 3.0)
    A11, A22, A12 = J23 * A11, J23 * A22, J23 * A12
    return (
        F11 * A11 + F12 * A12 + q * F22,
        F11 * A12 + F12 * A22 - q * F21,
        F21 * A11 + F22 * A12 - q * F12,
        F21 * A12 + F22 * A22 + q * F11,
    )


@scalar
def isochoric_energy(C11, C22, J23):
    """Isochoric energy per shear modulus: (J^(-2/3) tr C - 3) / 2."""
    return 0.5 * (J23 * (C11 + C22 + 1.0) - 3.0)
