"""What both quadrilaterals share: gradients at a point, volume rate, bulk viscosity."""

from __future__ import annotations

import math

from wrinklewave._jit import scalar


@scalar
def centre_gradients(x13, y13, x24, y24):
    """Shape-function gradients at the centre, and the area (Flanagan & Belytschko 1981, eq. 23).

    Returns b1x, b1y, b2x, b2y [1/m] and A [m²]; the gradients of nodes 3 and 4 are those of 1 and 2, negated.
    """
    A2 = x13 * y24 - x24 * y13
    i = 1.0 / A2
    return y24 * i, -x24 * i, -y13 * i, x13 * i, 0.5 * A2


@scalar
def gradient(b1x, b1y, b2x, b2y, d13, d24):
    """Gradient at the centre of a nodal field, from its diagonal differences."""
    return b1x * d13 + b2x * d24, b1y * d13 + b2y * d24


@scalar
def volume_rate(F11, F12, F21, F22, V11, V12, V21, V22, Ji):
    """Rate of volume per volume, F⁻ᵀ : Ḟ [1/s], with V = Ḟ and Ji = 1/J."""
    return (F22 * V11 + F11 * V22 - F12 * V21 - F21 * V12) * Ji


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
