"""Four-node quadrilateral with one integration point and hourglass control.

The hourglass field is what is left of the nodal displacements after rigid and uniform motion (Flanagan & Belytschko
1981, eq. 41), a vector q. Its force has the memory of the material's shear stress, so that the control is as stiff as
the instantaneous modulus in a fast event and relaxes as the material does. As there, the memory H is of what is pulled
back to the reference configuration, Fᵀ q, and is pushed forward to F⁻ᵀ H, so that rotations only rotate the force. Its
stiffness for a factor of one is that of a fully integrated, isochoric rectangle, averaged over both directions so that
it turns with the element:

    k = mu A (7/72) (gx + gy),   gx = sum_a (dN_a/dX)², gy = sum_a (dN_a/dY)²
"""

from __future__ import annotations

from wrinklewave._jit import scalar

HOURGLASS_STIFFNESS = 7.0 / 72.0


@scalar
def hourglass_shape(d12, d43):
    """Hourglass component of a nodal field, value_1 - value_2 + value_3 - value_4, from its edge differences."""
    return d12 - d43


@scalar
def hourglass_stiffness(b1x, b1y, b2x, b2y, A, factor):
    """Stiffness [m⁰] per shear modulus of the hourglass field."""
    return factor * HOURGLASS_STIFFNESS * 2.0 * A * (b1x * b1x + b1y * b1y + b2x * b2x + b2y * b2y)


@scalar
def nodal_forces(b1x, b1y, b2x, b2y, T1, T2, hX, hY, Q):
    """Internal forces of one direction on nodes 1 to 4.

    T1, T2 are the nominal stress components of that direction times the area, Q the hourglass force; hX, hY the
    hourglass components of the coordinates, which make the hourglass field blind to uniform gradients.
    """
    T1 -= hX * Q
    T2 -= hY * Q
    f1 = b1x * T1 + b1y * T2
    f2 = b2x * T1 + b2y * T2
    return f1 + Q, f2 - Q, Q - f1, -f2 - Q
