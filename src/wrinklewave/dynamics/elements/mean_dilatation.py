"""Fully integrated four-node quadrilateral with one mean volume ratio (B-bar, Nagtegaal, Parks & Rice 1974).

The isochoric stress is integrated at 2 x 2 Gauss points; the mean stress follows from the ratio of current to
undeformed area, so that a nearly incompressible element does not lock (Simo, Taylor & Pister 1985, eq. 3.6). Its
forces are the gradient of an energy, so the energy balance holds.
"""

from __future__ import annotations

from wrinklewave._jit import scalar

GAUSS = 0.5773502691896258  # 1/sqrt(3)


@scalar
def dot(b, v):
    """Sum over the four nodes: one component of the gradient of a nodal field."""
    return b[0] * v[0] + b[1] * v[1] + b[2] * v[2] + b[3] * v[3]


@scalar
def point_gradients(xi, eta, x, y):
    """Shape-function gradients of nodes 1 to 4 at (xi, eta), and the area of that point.

    Returns the four x-derivatives, the four y-derivatives [1/m] and the Jacobian determinant [m²].
    """
    a1, a2, a3, a4 = -0.25 * (1 - eta), 0.25 * (1 - eta), 0.25 * (1 + eta), -0.25 * (1 + eta)
    c1, c2, c3, c4 = -0.25 * (1 - xi), -0.25 * (1 + xi), 0.25 * (1 + xi), 0.25 * (1 - xi)
    x_xi, y_xi = dot((a1, a2, a3, a4), x), dot((a1, a2, a3, a4), y)
    x_eta, y_eta = dot((c1, c2, c3, c4), x), dot((c1, c2, c3, c4), y)
    D = x_xi * y_eta - y_xi * x_eta
    i = 1.0 / D
    p, q, r, s = y_eta * i, -y_xi * i, -x_eta * i, x_xi * i
    return (
        (a1 * p + c1 * q, a2 * p + c2 * q, a3 * p + c3 * q, a4 * p + c4 * q),
        (a1 * r + c1 * s, a2 * r + c2 * s, a3 * r + c3 * s, a4 * r + c4 * s),
        D,
    )
