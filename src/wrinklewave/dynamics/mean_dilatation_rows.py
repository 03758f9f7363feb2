"""The fully integrated mean-dilatation quadrilateral; the check on the one-point element.

Arguments as in :mod:`wrinklewave.dynamics.rows`, but ``memory`` holds, per Prony term, the components 11, 22, 12, 33
of Gauss points 1 to 4, and the mean stress if the bulk relaxes.
"""

from __future__ import annotations

from wrinklewave._jit import inlined_vector, scalar, uintp
from wrinklewave.dynamics.elements.mean_dilatation import GAUSS, dot, point_gradients
from wrinklewave.dynamics.elements.quadrilateral import (
    bulk_viscosity,
    squared_length,
    twice_area,
    twice_area_rate,
)
from wrinklewave.dynamics.loops import heights, numbers, numbers_of_terms
from wrinklewave.dynamics.points import corners_x, corners_y
from wrinklewave.dynamics.rows import relaxed
from wrinklewave.materials.neo_hookean import (
    first_piola_kirchhoff,
    inverse_cube_root,
    isochoric_shape,
    right_cauchy_green,
)

ONE = uintp(1)


@scalar
def _point(g, xi, eta, x, y, u, w, r, i, memory, terms, factors, mu):
    """Shape-function gradients at Gauss point ``g``, and the isochoric nominal stress 11, 12, 21, 22 times its area."""
    stride = len(memory) // len(terms)
    bx, by, D = point_gradients(xi, eta, x, y)
    F11, F12 = 1.0 + dot(bx, u), dot(by, u)
    F21, F22 = dot(bx, w), 1.0 + dot(by, w)
    J = F11 * F22 - F12 * F21
    root = inverse_cube_root(J)
    J23 = root * root
    Ji = J23 * root
    C11, C22, C12 = right_cauchy_green(F11, F12, F21, F22)
    s11, s22, s12, s33 = isochoric_shape(C11, C22, C12, Ji * Ji)
    A11, A22, A12, A33 = mu * s11, mu * s22, mu * s12, mu * s33
    for m in range(len(terms)):
        b, a, b_next = factors[m][0], factors[m][1], factors[m][2]
        A11 += relaxed(memory[stride * m + 4 * g], r, i, b, a, b_next, s11)
        A22 += relaxed(memory[stride * m + 4 * g + 1], r, i, b, a, b_next, s22)
        A12 += relaxed(memory[stride * m + 4 * g + 2], r, i, b, a, b_next, s12)
        A33 += relaxed(memory[stride * m + 4 * g + 3], r, i, b, a, b_next, s33)
    P11, P12, P21, P22 = first_piola_kirchhoff(
        F11, F12, F21, F22, A11, A22, A12, A33, C11, C22, C12, D * J23, Ji, 0.0
    )
    return bx, by, (P11, P12, P21, P22)


@scalar
def mean_dilatation_element(r, i, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """Forces of element ``i`` of row ``r`` (unsigned); ``memory`` is brought to the next step."""
    mu, K, linear, quadratic = moduli[0], moduli[1], moduli[2], moduli[3]
    stride = len(memory) // len(terms)
    bulk_relaxes = stride == 17
    k, s = i + ONE, r + ONE
    X1, X2, X3, X4 = corners_x(X, r, i)
    Y1, Y2, Y3, Y4 = corners_y(Y, r, i)
    u1, u2, u3, u4 = u[r, i], u[r, k], u[s, k], u[s, i]
    w1, w2, w3, w4 = w[r, i], w[r, k], w[s, k], w[s, i]

    X13, Y13, X24, Y24 = X1 - X3, Y1 - Y3, X2 - X4, Y2 - Y4
    u13, w13, u24, w24 = u1 - u3, w1 - w3, u2 - u4, w2 - w4
    x13, y13, x24, y24 = X13 + u13, Y13 + w13, X24 + u24, Y24 + w24
    A = 0.5 * twice_area(X13, Y13, X24, Y24)
    e = 0.5 * (X13 * w24 + u13 * Y24 + u13 * w24 - X24 * w13 - u24 * Y13 - u24 * w13) / A
    rate = twice_area_rate(
        x13,
        y13,
        x24,
        y24,
        vx[r, i] - vx[s, k],
        vy[r, i] - vy[s, k],
        vx[r, k] - vx[s, i],
        vy[r, k] - vy[s, i],
    )
    rate /= twice_area(x13, y13, x24, y24)
    p = K * e + bulk_viscosity(rate, squared_length(X13, Y13, X24, Y24, A), linear, quadratic)
    if bulk_relaxes:
        for m in range(len(terms)):
            p += relaxed(memory[stride * m + 16], r, i, factors[m][3], factors[m][1], factors[m][4], e)
    fx1, fy1, fx2, fy2 = 0.5 * p * y24, -0.5 * p * x24, -0.5 * p * y13, 0.5 * p * x13
    fx3, fy3, fx4, fy4 = -fx1, -fy1, -fx2, -fy2

    x, y = (X1, X2, X3, X4), (Y1, Y2, Y3, Y4)
    p, q = (u1, u2, u3, u4), (w1, w2, w3, w4)
    bx1, by1, P1 = _point(0, -GAUSS, -GAUSS, x, y, p, q, r, i, memory, terms, factors, mu)
    bx2, by2, P2 = _point(1, GAUSS, -GAUSS, x, y, p, q, r, i, memory, terms, factors, mu)
    bx3, by3, P3 = _point(2, GAUSS, GAUSS, x, y, p, q, r, i, memory, terms, factors, mu)
    bx4, by4, P4 = _point(3, -GAUSS, GAUSS, x, y, p, q, r, i, memory, terms, factors, mu)
    bx, by, P = (bx1, bx2, bx3, bx4), (by1, by2, by3, by4), (P1, P2, P3, P4)
    for g in range(4):
        fx1 += bx[g][0] * P[g][0] + by[g][0] * P[g][1]
        fy1 += bx[g][0] * P[g][2] + by[g][0] * P[g][3]
        fx2 += bx[g][1] * P[g][0] + by[g][1] * P[g][1]
        fy2 += bx[g][1] * P[g][2] + by[g][1] * P[g][3]
        fx3 += bx[g][2] * P[g][0] + by[g][2] * P[g][1]
        fy3 += bx[g][2] * P[g][2] + by[g][2] * P[g][3]
        fx4 += bx[g][3] * P[g][0] + by[g][3] * P[g][1]
        fy4 += bx[g][3] * P[g][2] + by[g][3] * P[g][3]
    forces[0][k], forces[1][k], forces[2][k], forces[3][k] = fx1, fy1, fx2, fy2
    forces[4][k], forces[5][k], forces[6][k], forces[7][k] = fx3, fy3, fx4, fy4


@inlined_vector
def mean_dilatation_row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """Forces of elements ``start`` to ``stop`` of row ``j``; ``forces`` are eight arrays."""
    r = uintp(j)
    y, c, f = heights(Y, r), numbers(moduli), numbers_of_terms(factors, terms)
    for i in range(uintp(start), uintp(stop)):
        mean_dilatation_element(r, i, X, y, u, w, vx, vy, memory, terms, f, c, forces)
