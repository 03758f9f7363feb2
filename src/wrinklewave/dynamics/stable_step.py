"""The largest stable time step, from the instantaneous moduli in the deformed state.

Highest frequency of an element (upper bound): the eigenvalues of its stiffness for uniform strain follow from the
Gram matrix of the current shape-function gradients, gx and gy its eigenvalues:

    omega² = 4 J/rho · max{ [M (gx + gy) + sqrt(M² (gx - gy)² + 4 lambda² gx gy)]/2,  mu (gx + gy) }

with current moduli of the compressible neo-Hookean law per current volume: mu -> mu_i J^(-5/3) times the largest
principal stretch squared, K -> K_i (2 J - 1). Bulk viscosity shortens the step by sqrt(1 + xi²) - xi.
"""

from __future__ import annotations

import numpy as np
from numba import prange

from wrinklewave._jit import parallel, serial
from wrinklewave.dynamics.elements.mean_dilatation import dot, point_gradients
from wrinklewave.dynamics.elements.quadrilateral import squared_length
from wrinklewave.dynamics.points import area, corners, volume_change

STEP, PLACE = range(2)


@serial
def _stable_step_row(j, a, memory, terms, density, out):
    layer = a.layer[j]
    mu_i, K_i = a.moduli[layer, 0], a.moduli[layer, 1]
    for m in range(a.terms.shape[1]):
        mu_i += a.terms[layer, m, 0]
        K_i += a.terms[layer, m, 1]
    rho = density[layer]
    out[STEP], out[PLACE] = np.inf, -1
    for i in range(a.X.shape[1] - 1):
        X, Y, u, w = corners(a.X, j, i), corners(a.Y, j, i), corners(a.u, j, i), corners(a.w, j, i)
        x = (X[0] + u[0], X[1] + u[1], X[2] + u[2], X[3] + u[3])
        y = (Y[0] + w[0], Y[1] + w[1], Y[2] + w[2], Y[3] + w[3])
        J = 1.0 + volume_change(X, Y, u, w)
        if not J > 0.0:
            out[STEP], out[PLACE] = 0.0, i
            return
        bx, by, D = point_gradients(0.0, 0.0, x, y)
        Gx, Gy, Gxy = dot(bx, bx), dot(by, by), dot(bx, by)
        spread = np.sqrt(0.25 * (Gx - Gy) ** 2 + Gxy**2)
        gx, gy = 0.5 * (Gx + Gy) + spread, max(0.5 * (Gx + Gy) - spread, 0.0)
        BX, BY, D = point_gradients(0.0, 0.0, X, Y)
        F11, F12, F21, F22 = dot(BX, x), dot(BY, x), dot(BX, y), dot(BY, y)
        trace = F11**2 + F12**2 + F21**2 + F22**2
        stretch2 = 0.5 * trace + np.sqrt(max(0.25 * trace**2 - J * J, 0.0))
        mu = mu_i * max(stretch2, 1.0) * J ** (-5.0 / 3.0)
        K = K_i * max(2.0 * J - 1.0, 0.5)
        M, lam = K + 4.0 / 3.0 * mu, K - 2.0 / 3.0 * mu
        longitudinal = 0.5 * (M * (gx + gy) + np.sqrt(M**2 * (gx - gy) ** 2 + 4.0 * lam**2 * gx * gy))
        omega = np.sqrt(4.0 * J / rho * max(longitudinal, mu * (gx + gy)))
        L2 = squared_length(X[0] - X[2], Y[0] - Y[2], X[1] - X[3], Y[1] - Y[3], area(X, Y))
        vx, vy = corners(a.vx, j, i), corners(a.vy, j, i)
        rate = dot(bx, vx) + dot(by, vy)
        damping = a.moduli[layer, 2] * np.sqrt(L2) - a.moduli[layer, 3] * L2 * min(rate, 0.0)
        xi = 0.5 * damping * 4.0 * J / rho * (gx + gy) / omega
        dt = 2.0 / omega * (np.sqrt(1.0 + xi * xi) - xi)
        if not dt >= out[STEP]:
            out[STEP], out[PLACE] = dt, i


@parallel
def stable_step(a, memory, terms, density, out):
    """Fill ``out`` [n_rows, 2] with the smallest stable step [s] of each element row and the column that sets it.

    The step is zero where an element is inverted, and NaN where the state is.
    """
    n_parts = a.shares.size - 1
    for part in prange(n_parts):
        for j in range(a.shares[part], a.shares[part + 1]):
            _stable_step_row(j, a, memory, terms, density, out[j])
