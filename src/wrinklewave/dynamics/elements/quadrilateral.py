"""What both quadrilaterals share: gradients at a point, volume rate, bulk viscosity."""

from __future__ import annotations

import math

from wrinklewave._jit import scalar


@scalar
def opposite_differences(v1, v2, v3, v4):
    """d13 and d24 of a nodal field, and its hourglass component."""
    return v1 - v3, v2 - v4, (v1 + v3) - (v2 + v4)


@scalar
def twice_area(x13, y13, x24, y24):
    """Cross product of the diagonals [m²]."""
    return x13 * y24 - x24 * y13


@scalar
def twice_area_rate(x13, y13, x24, y24, vx13, vy13, vx24, vy24):
    """Rate of :func:`twice_area` [m²/s] from the diagonals and their velocities."""
    return (vx13 * y24 - vx24 * y13) + (x13 * vy24 - x24 * vy13)


@scalar
def centre_gradient(x13, y13, x24, y24, inverse, d13, d24):
    """Gradient at the centre of a nodal field, from its diagonal differences (Flanagan & Belytschko 1981, eq. 23).

    ``inverse`` is 1 / twice the area.
    """
    return (y24 * d13 - y13 * d24) * inverse, (x13 * d24 - x24 * d13) * inverse


@scalar
def squared_length(x13, y13, x24, y24, A):
    """Square of the element's short side [m²]: 2 A² over the longer diagonal squared, exact for squares."""
    return 2.0 * A * A / max(x13 * x13 + y13 * y13, x24 * x24 + y24 * y24)


@scalar
def bulk_viscosity(rate, L2, linear, quadratic):
    """Mean stress [Pa] that damps volume oscillation, and shocks in compression (von Neumann & Richtmyer 1950).

    ``linear`` is rho c_d b_1, ``quadratic`` is rho b_2²; L2 the squared element length, ``rate`` the volume rate.
    """
    compression = min(rate, 0.0)
    return linear * math.sqrt(L2) * rate - quadratic * L2 * compression * compression
