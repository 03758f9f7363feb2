"""Element fields of the present state, for outputs."""

from __future__ import annotations

import numpy as np

from wrinklewave._jit import serial, uintp, vector
from wrinklewave.dynamics.elements.mean_dilatation import dot, point_gradients
from wrinklewave.dynamics.energy import deformation, overstresses
from wrinklewave.dynamics.points import bulk_place, corners, n_points, point_place, volume_change
from wrinklewave.materials.neo_hookean import second_piola_kirchhoff

FIELDS = (
    "strain_xx",
    "strain_rate_xx",
    "nominal_stress_xx",
    "stress_xx",
    "stress_yy",
    "stress_xy",
    "volume_ratio",
)
"""Element means: nominal strain 1 - F11 and nominal stress -P11 (compression > 0) [1, Pa], rate of the strain along x
per current length, -dv_x/dx [1/s], Cauchy stress (tension > 0) [Pa], volume ratio J [1]."""
STRAIN, RATE, NOMINAL, XX, YY, XY, VOLUME = range(7)


@vector
def fields_run(j, start, stop, layer, a, memory, terms, out):
    """Fields of elements ``start`` to ``stop`` of row ``j``, all of one layer."""
    r = uintp(j)
    factors = a.factors[layer]
    mu, K = a.moduli[layer, 0], a.moduli[layer, 1]
    n, last = n_points(memory, terms), bulk_place(memory, terms)
    for i in range(uintp(start), uintp(stop)):
        X, Y, u, w = corners(a.X, r, i), corners(a.Y, r, i), corners(a.u, r, i), corners(a.w, r, i)
        vx = corners(a.vx, r, i)
        e = volume_change(X, Y, u, w)
        p = K * e
        if last:
            for m in range(len(terms)):
                p += memory[(last + 1) * m + last][r, i] + factors[m, 4] * e
        strain, rate, nominal, xx, yy, xy = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
        for g in range(n):
            xi, eta = point_place(g, n)
            bx, by, _ = point_gradients(xi, eta, X, Y)
            q = deformation(bx, by, u, w)
            A11 = mu * q.s11 + overstresses(memory, terms, factors, 4 * g, r, i, q.s11, False)
            A22 = mu * q.s22 + overstresses(memory, terms, factors, 4 * g + 1, r, i, q.s22, False)
            A12 = mu * q.s12 + overstresses(memory, terms, factors, 4 * g + 2, r, i, q.s12, False)
            A33 = mu * q.s33 + overstresses(memory, terms, factors, 4 * g + 3, r, i, q.s33, False)
            Ji2 = q.J23 * q.J23 * q.J23
            S11, S22, S12 = second_piola_kirchhoff(
                A11, A22, A12, A33, q.C11, q.C22, q.C12, q.J, q.J23, Ji2, p
            )
            P11, P12 = q.F11 * S11 + q.F12 * S12, q.F11 * S12 + q.F12 * S22
            P21, P22 = q.F21 * S11 + q.F22 * S12, q.F21 * S12 + q.F22 * S22
            strain += (1.0 - q.F11) / n
            rate -= (dot(bx, vx) * q.F22 - dot(by, vx) * q.F21) / (q.J * n)
            nominal -= P11 / n
            xx += (P11 * q.F11 + P12 * q.F12) / (q.J * n)
            yy += (P21 * q.F21 + P22 * q.F22) / (q.J * n)
            xy += (P11 * q.F21 + P12 * q.F22) / (q.J * n)
        out[STRAIN, r, i], out[RATE, r, i], out[NOMINAL, r, i] = strain, rate, nominal
        out[XX, r, i], out[YY, r, i], out[XY, r, i], out[VOLUME, r, i] = xx, yy, xy, 1.0 + e


@vector
def set_aside(u, w, vx, vy, memory, nodal, remembered):
    """Copy the state, u, w, vx and vy to ``nodal`` [4, ...], letting go of the interpreter's lock only once."""
    for j in range(uintp(u.shape[0])):
        for i in range(uintp(u.shape[1])):
            nodal[0, j, i], nodal[1, j, i] = u[j, i], w[j, i]
            nodal[2, j, i], nodal[3, j, i] = vx[j, i], vy[j, i]
    for k in range(uintp(memory.shape[0])):
        for j in range(uintp(memory.shape[1])):
            for i in range(uintp(memory.shape[2])):
                remembered[k, j, i] = memory[k, j, i]


@serial
def fields_share(part, a, memory, terms, out):
    """Fill the rows of one share in ``out`` [len(FIELDS), n_rows, n_columns] with the fields of the present state."""
    for j in range(a.shares[part], a.shares[part + 1]):
        for k in range(a.first_run[j], a.first_run[j + 1]):
            start, stop, layer = a.runs[k]
            fields_run(j, start, stop, layer, a, memory, terms, out)


def to_nodes(columns: np.ndarray) -> np.ndarray:
    """Mean of adjacent element columns at the nodes between them; the end nodes take their only neighbour's value."""
    padded = np.concatenate([columns[..., :1], columns, columns[..., -1:]], axis=-1)
    return 0.5 * (padded[..., 1:] + padded[..., :-1])


def depth_weights(mesh_y: np.ndarray, top: float, depth: float) -> np.ndarray:
    """Share of each element row in the mean over ``depth`` below ``top`` [m], shape [n_rows].

    Rows that the depth cuts count in part.
    """
    inside = np.clip(mesh_y, top - depth, top)
    return np.diff(inside) / depth
