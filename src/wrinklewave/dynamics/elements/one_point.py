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
def hourglass_stiffness(x13, y13, x24, y24, inverse, factor):
    """Stiffness [m⁰] per shear modulus of the hourglass field; ``inverse`` is 1 / twice the area.

    A (gx + gy) is the sum of the squared diagonals over twice the area.
    """
    return factor * HOURGLASS_STIFFNESS * ((x13 * x13 + y13 * y13) + (x24 * x24 + y24 * y24)) * inverse


@scalar
def nodal_forces(x13, y13, x24, y24, inverse, T1, T2, hX, hY, Q):
    """Internal forces of one direction on nodes 1 to 4.

    T1, T2 are half the nominal stress components of that direction, Q the hourglass force; hX, hY the hourglass
    components of the coordinates, which make the hourglass field blind to uniform gradients.
    """
    R = Q * inverse
    T1 -= hX * R
    T2 -= hY * R
    f1 = y24 * T1 - x24 * T2
    f2 = x13 * T2 - y13 * T1
    return f1 + Q, f2 - Q, Q - f1, -f2 - Q
