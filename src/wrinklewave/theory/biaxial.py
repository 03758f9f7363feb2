"""Neo-Hookean solid with memory, stretched along the axes in plane strain: its stress, and its stiffness to increments.

F = diag(l1, l2, 1), J = l1 l2, C = F^T F. The second Piola-Kirchhoff stress has Simo's form

    S = J p C^-1 + J^(-2/3) DEV[A],     DEV[A] = A - (A : C / 3) C^-1,

where A is made of histories of ``shape`` = DEV[1] = 1 - (tr C / 3) C^-1, and p of histories of J - 1: without memory
A = mu shape and p = K (J - 1), which is W = mu/2 (J^(-2/3) tr C - 3) + K/2 (J - 1)^2 (Simo, Comput. Methods Appl.
Mech. Eng. 60, 153 (1987)). Stiffnesses are 2 dS/dC with components 1111, 2222, 1122, 1212; the others vanish or
follow by symmetry. Everything works on floats and on arrays alike.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

Number = TypeVar("Number", float, NDArray[np.float64])
Three = tuple[Number, Number, Number]
Stiffness = tuple[Number, Number, Number, Number]


def shape(l1: Number, l2: Number) -> Three[Number]:
    """Components 11, 22, 33 of 1 - (tr C / 3) C^-1."""
    third = (l1 * l1 + l2 * l2 + 1.0) / 3.0
    return 1.0 - third / (l1 * l1), 1.0 - third / (l2 * l2), 1.0 - third


def shape_increments(l1: Number, l2: Number, e_11: Number, e_22: Number, g_12: Number) -> Stiffness[Number]:
    """Increments 11, 22, 12, 33 of ``shape`` under those of Green's strain; g_12 is twice the component 12."""
    third, trace = (l1 * l1 + l2 * l2 + 1.0) / 3.0, -(e_11 + e_22) * (2.0 / 3.0)
    c1, c2 = 1.0 / (l1 * l1), 1.0 / (l2 * l2)
    return (
        (trace + 2.0 * third * c1 * e_11) * c1,
        (trace + 2.0 * third * c2 * e_22) * c2,
        third * c1 * c2 * g_12,
        trace,
    )


def normal_stress(l1: Number, l2: Number, A: Sequence[Number], p: Number) -> tuple[Number, Number]:
    """S_11 and S_22 for A_11, A_22, A_33 and the mean stress p."""
    J = l1 * l2
    factor = J ** (-2.0 / 3.0)
    hydrostatic = J * p - factor * (A[0] * l1 * l1 + A[1] * l2 * l2 + A[2]) / 3.0
    return factor * A[0] + hydrostatic / (l1 * l1), factor * A[1] + hydrostatic / (l2 * l2)


def held_stiffness(l1: Number, l2: Number, A: Sequence[Number], p: Number) -> Stiffness[Number]:
    """Stiffness at constant A and p, components 1111, 2222, 1122, 1212."""
    J, c1, c2 = l1 * l2, 1.0 / (l1 * l1), 1.0 / (l2 * l2)
    factor = J ** (-2.0 / 3.0)
    a1, a2 = 2.0 / 3.0 * factor * A[0], 2.0 / 3.0 * factor * A[1]
    mean = 2.0 / 3.0 * factor * (A[0] * l1 * l1 + A[1] * l2 * l2 + A[2])
    dilation, rotation = J * p + mean / 3.0, 0.5 * mean - J * p
    return (
        (dilation * c1 + 2.0 * rotation * c1 - 2.0 * a1) * c1,
        (dilation * c2 + 2.0 * rotation * c2 - 2.0 * a2) * c2,
        dilation * c1 * c2 - a1 * c2 - a2 * c1,
        rotation * c1 * c2,
    )


def shear_stiffness(l1: Number, l2: Number) -> Stiffness[Number]:
    """Stiffness by dA = mu d shape, per unit of mu: 2/3 J^(-2/3) tr C (sym C^-1 C^-1 - C^-1 x C^-1 / 3)."""
    c1, c2 = 1.0 / (l1 * l1), 1.0 / (l2 * l2)
    factor = 2.0 / 9.0 * (l1 * l2) ** (-2.0 / 3.0) * (l1 * l1 + l2 * l2 + 1.0)
    return 2.0 * factor * c1 * c1, 2.0 * factor * c2 * c2, -factor * c1 * c2, 1.5 * factor * c1 * c2


def bulk_stiffness(l1: Number, l2: Number) -> Stiffness[Number]:
    """Stiffness by dp = K dJ, per unit of K: J^2 C^-1 x C^-1."""
    return (l2 / l1) ** 2, (l1 / l2) ** 2, 1.0 + 0.0 * l1, 0.0 * l1
