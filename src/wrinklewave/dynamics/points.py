"""Integration points of either element, seen alike: for energies, fields and the stable step, which need no speed.

The number of values that an element remembers per Prony term tells which element it is: a one-point element has one
point of weight 4 and two hourglass components, a mean-dilatation element four points of weight 1.
"""

from __future__ import annotations

from numba import types
from numba.extending import overload

from wrinklewave._jit import INLINED, scalar, uintp
from wrinklewave.dynamics.elements.mean_dilatation import GAUSS

ONE_POINT_COMPONENTS, MEAN_DILATATION_COMPONENTS = (6, 7), (16, 17)
"""Numbers kept per Prony term, without and with a relaxing bulk modulus."""


@scalar
def n_points(memory, terms):
    """Integration points of the element that this memory belongs to."""
    return 1 if len(memory) // len(terms) <= 7 else 4


@scalar
def bulk_place(memory, terms):
    """Place of the mean overstress among the components, or 0 if the bulk does not relax."""
    stride = len(memory) // len(terms)
    return stride - 1 if stride == 7 or stride == 17 else 0


@scalar
def point_place(g, n):
    """Natural coordinates of integration point ``g`` of ``n``."""
    if n == 1:
        return 0.0, 0.0
    return (-GAUSS if g == 0 or g == 3 else GAUSS), (-GAUSS if g < 2 else GAUSS)


@scalar
def corners(field, j, i):
    """Values of a nodal field at the corners 1 to 4 of element (j, i), unsigned indices."""
    k, s = i + uintp(1), j + uintp(1)
    return field[j, i], field[j, k], field[s, k], field[s, i]


@scalar
def corners_x(X, j, i):
    """Undeformed x at the corners of element (j, i); ``X`` [n_columns] by column if columns are straight."""
    if X.ndim == 1:
        return X[i], X[i + uintp(1)], X[i + uintp(1)], X[i]
    return corners(X, j, i)


def corners_y(Y, j, i):
    """Undeformed y at the corners of element (j, i); ``Y`` are two heights, below and above, if rows are level."""
    return (Y[0], Y[0], Y[1], Y[1]) if isinstance(Y, tuple) else corners(Y, j, i)


@overload(corners_y, jit_options=INLINED)
def choose_corners_y(Y, j, i):
    """What numba compiles in place of :func:`corners_y`."""
    if isinstance(Y, types.BaseTuple):
        return lambda Y, j, i: (Y[0], Y[0], Y[1], Y[1])
    return lambda Y, j, i: corners(Y, j, i)


@scalar
def area(x, y):
    """Area of a quadrilateral from its corners."""
    return 0.5 * ((x[2] - x[0]) * (y[3] - y[1]) - (x[3] - x[1]) * (y[2] - y[0]))


@scalar
def volume_change(X, Y, u, w):
    """J̄ - 1 of an element: change of area per undeformed area, without cancellation."""
    X13, X24, Y13, Y24 = X[0] - X[2], X[1] - X[3], Y[0] - Y[2], Y[1] - Y[3]
    u13, u24, w13, w24 = u[0] - u[2], u[1] - u[3], w[0] - w[2], w[1] - w[3]
    change = X13 * w24 + u13 * Y24 + u13 * w24 - X24 * w13 - u24 * Y13 - u24 * w13
    return change / (X13 * Y24 - X24 * Y13)
