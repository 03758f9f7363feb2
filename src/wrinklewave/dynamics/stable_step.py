"""The largest stable time step, from the instantaneous moduli in the deformed state.

Highest frequency of an element (upper bound): the eigenvalues of its stiffness for uniform strain follow from the
Gram matrix of the current shape-function gradients, gx and gy its eigenvalues:

    omega² = 4 J/rho · max{ [M (gx + gy) + sqrt(M² (gx - gy)² + 4 lambda² gx gy)]/2,  G (gx + gy) }

with moduli of the compressible neo-Hookean law per current volume. Under the mean stress p = K (J - 1) the second
variation of K (J - 1)²/2 in a uniform displacement gradient L is K J (tr L)² + 2 p det L, so with mu = mu_i J^(-5/3)
times the largest principal stretch squared

    M = K_i J + 4/3 mu,   lambda = K_i J + max(p, 0) - 2/3 mu,   G = mu + |p|,   p = K_i (J - 1),

where a bulk modulus that has relaxed leaves any p between 0 and K_i (J - 1). Bulk viscosity shortens the step by
sqrt(1 + xi²) - xi.
"""

from __future__ import annotations

import math

from wrinklewave._jit import scalar, serial, uintp, vector
from wrinklewave.dynamics.elements.mean_dilatation import dot, point_gradients
from wrinklewave.dynamics.elements.quadrilateral import squared_length
from wrinklewave.dynamics.points import area, corners, volume_change
from wrinklewave.materials.neo_hookean import inverse_cube_root


@scalar
def element_step(X, Y, u, w, vx, vy, mu_i, K_i, linear, quadratic, rho):
    """Largest stable step [s] of one element; zero or less if it is inverted, NaN if its state is."""
    x = (X[0] + u[0], X[1] + u[1], X[2] + u[2], X[3] + u[3])
    y = (Y[0] + w[0], Y[1] + w[1], Y[2] + w[2], Y[3] + w[3])
    J = 1.0 + volume_change(X, Y, u, w)
    bx, by, _ = point_gradients(0.0, 0.0, x, y)
    Gx, Gy, Gxy = dot(bx, bx), dot(by, by), dot(bx, by)
    spread = math.sqrt(0.25 * (Gx - Gy) * (Gx - Gy) + Gxy * Gxy)
    gx, gy = 0.5 * (Gx + Gy) + spread, max(0.5 * (Gx + Gy) - spread, 0.0)
    BX, BY, _ = point_gradients(0.0, 0.0, X, Y)
    F11, F12, F21, F22 = dot(BX, x), dot(BY, x), dot(BX, y), dot(BY, y)
    trace = F11 * F11 + F12 * F12 + F21 * F21 + F22 * F22
    stretch2 = 0.5 * trace + math.sqrt(max(0.25 * trace * trace - J * J, 0.0))
    root = inverse_cube_root(J)
    mu = mu_i * max(stretch2, 1.0) * root * root * root * root * root
    p = K_i * (J - 1.0)
    M, lam, G = K_i * J + 4.0 / 3.0 * mu, K_i * J + max(p, 0.0) - 2.0 / 3.0 * mu, mu + abs(p)
    along = 0.5 * (M * (gx + gy) + math.sqrt(M * M * (gx - gy) * (gx - gy) + 4.0 * lam * lam * gx * gy))
    omega2 = 4.0 * J / rho * max(along, G * (gx + gy))
    rate = dot(bx, vx) + dot(by, vy)
    L2 = squared_length(X[0] - X[2], Y[0] - Y[2], X[1] - X[3], Y[1] - Y[3], area(X, Y))
    damping = linear * math.sqrt(L2) - quadratic * L2 * min(rate, 0.0)
    xi2 = damping * damping * (2.0 * J / rho * (gx + gy)) ** 2 / omega2
    step = 2.0 / math.sqrt(omega2) * (math.sqrt(1.0 + xi2) - math.sqrt(xi2))
    return step if J > 0.0 else J


@vector
def stable_step_run(j, start, stop, layer, a, density, out):
    """Largest stable steps of elements ``start`` to ``stop`` of row ``j``, all of one layer."""
    r = uintp(j)
    mu_i, K_i = a.moduli[layer, 0], a.moduli[layer, 1]
    for m in range(a.terms.shape[1]):
        mu_i += a.terms[layer, m, 0]
        K_i += a.terms[layer, m, 1]
    linear, quadratic, rho = a.moduli[layer, 2], a.moduli[layer, 3], density[layer]
    for i in range(uintp(start), uintp(stop)):
        X, Y, u, w = corners(a.X, r, i), corners(a.Y, r, i), corners(a.u, r, i), corners(a.w, r, i)
        vx, vy = corners(a.vx, r, i), corners(a.vy, r, i)
        out[r, i] = element_step(X, Y, u, w, vx, vy, mu_i, K_i, linear, quadratic, rho)


@serial
def stable_steps_share(part, a, density, out):
    """Fill the rows of one share in ``out`` [n_rows, n_columns] with the largest stable step of each element [s]."""
    for j in range(a.shares[part], a.shares[part + 1]):
        for k in range(a.first_run[j], a.first_run[j + 1]):
            start, stop, layer = a.runs[k]
            stable_step_run(j, start, stop, layer, a, density, out)
