"""Energies of the deformed state, and the power of what is lost, at mid-step.

After a step, the positions are those at t_{n+1} and the velocities those at t_{n+1/2}; the positions at t_n follow by
going back. Work over the step is the mean of both stresses times the strain increment, second-order accurate.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from numba import float64

from wrinklewave._jit import scalar, serial, uintp, vector
from wrinklewave.dynamics.elements.mean_dilatation import dot, point_gradients
from wrinklewave.dynamics.elements.one_point import HOURGLASS_STIFFNESS
from wrinklewave.dynamics.elements.quadrilateral import bulk_viscosity, squared_length
from wrinklewave.dynamics.points import area, bulk_place, corners, n_points, point_place, volume_change
from wrinklewave.materials.neo_hookean import inverse_cube_root, isochoric_shape, second_piola_kirchhoff

STORED, SPRINGS, VISCOUS, BULK_VISCOUS, HOURGLASS, HOURGLASS_AMPLITUDE, J_LEAST, J_MOST = range(8)
"""Columns of a survey: long-term elastic energy and energy in the Prony springs [J/m]; power of the overstress, of
bulk viscosity and of hourglass control [W/m]; largest hourglass amplitude per element size; range of J."""
N_COLUMNS = 8
KINETIC, N_SUMS = N_COLUMNS, N_COLUMNS + 1
"""What is summed up of a row: a survey's columns, then the kinetic energy of its nodes at mid-step [J/m]."""
BEYOND = 1e30
"""More than any volume ratio or stable step [s], to look for the least; single precision has room for it."""


class Point(NamedTuple):
    """Deformation at an integration point."""

    F11: float
    F12: float
    F21: float
    F22: float
    C11: float
    C22: float
    C12: float
    J: float
    J23: float
    s11: float
    s22: float
    s12: float
    s33: float


@scalar
def deformation(bx, by, u, w):
    """Deformation and isochoric stress shape at a point, from nodal displacements."""
    F11, F12, F21, F22 = 1.0 + dot(bx, u), dot(by, u), dot(bx, w), 1.0 + dot(by, w)
    C11, C22, C12 = F11 * F11 + F21 * F21, F12 * F12 + F22 * F22, F11 * F12 + F21 * F22
    J = F11 * F22 - F12 * F21
    root = inverse_cube_root(J)
    J23 = root * root
    s11, s22, s12, s33 = isochoric_shape(C11, C22, C12, J23 * J23 * J23)
    return Point(F11, F12, F21, F22, C11, C22, C12, J, J23, s11, s22, s12, s33)


@scalar
def overstresses(memory, terms, factors, place, j, i, shape, back):
    """Sum over terms of H at one place of the memory, after the last step or (``back``) before it."""
    stride = len(memory) // len(terms)
    total = 0.0
    for m in range(len(terms)):
        H = memory[stride * m + place][j, i] + factors[m, 2] * shape
        total += H / factors[m, 1] if back else H
    return total


@scalar
def _overstress_2pk(q, first, memory, terms, factors, j, i, back):
    A11 = overstresses(memory, terms, factors, first, j, i, q.s11, back)
    A22 = overstresses(memory, terms, factors, first + 1, j, i, q.s22, back)
    A12 = overstresses(memory, terms, factors, first + 2, j, i, q.s12, back)
    A33 = overstresses(memory, terms, factors, first + 3, j, i, q.s33, back)
    Ji2 = q.J23 * q.J23 * q.J23
    return second_piola_kirchhoff(A11, A22, A12, A33, q.C11, q.C22, q.C12, q.J, q.J23, Ji2, 0.0)


@scalar
def inverse_or_zero(share):
    """1 / share, or 0 for a term that has none."""
    return 1.0 / share if share > 0.0 else 0.0


@scalar
def _spring_energy(q, first, m, memory, terms, factors, j, i, share):
    """tau : tau / (4 mu_m) of one Prony spring, exact for small strain; tau is its Kirchhoff stress."""
    k = (len(memory) // len(terms)) * m + first
    b = factors[m, 2]
    H11, H22 = memory[k][j, i] + b * q.s11, memory[k + 1][j, i] + b * q.s22
    H12, H33 = memory[k + 2][j, i] + b * q.s12, memory[k + 3][j, i] + b * q.s33
    third = (H11 * q.C11 + H22 * q.C22 + 2.0 * H12 * q.C12 + H33) / 3.0
    Ji2 = q.J23 * q.J23 * q.J23
    S11, S22, S12 = H11 - third * q.C22 * Ji2, H22 - third * q.C11 * Ji2, H12 + third * q.C12 * Ji2
    M11, M12 = S11 * q.C11 + S12 * q.C12, S11 * q.C12 + S12 * q.C22
    M21, M22 = S12 * q.C11 + S22 * q.C12, S12 * q.C12 + S22 * q.C22
    S33 = H33 - third
    return (
        q.J23 * q.J23 * (M11 * M11 + 2.0 * M12 * M21 + M22 * M22 + S33 * S33) * 0.25 * inverse_or_zero(share)
    )


@scalar
def _hourglass(X, Y, bx, by, u):
    """Hourglass component of a nodal field: what is left after rigid and uniform motion."""
    hX, hY, h = X[0] - X[1] + X[2] - X[3], Y[0] - Y[1] + Y[2] - Y[3], u[0] - u[1] + u[2] - u[3]
    return h - hX * dot(bx, u) - hY * dot(by, u)


@scalar
def _hourglass_overstress(q, qx, qy, memory, terms, factors, j, i, back):
    """Sum over terms of F⁻ᵀ H, where H is the history of Fᵀ (qx, qy)."""
    H1 = overstresses(memory, terms, factors, 4, j, i, q.F11 * qx + q.F21 * qy, back)
    H2 = overstresses(memory, terms, factors, 5, j, i, q.F12 * qx + q.F22 * qy, back)
    return (q.F22 * H1 - q.F21 * H2) / q.J, (q.F11 * H2 - q.F12 * H1) / q.J


@vector
def survey_run(j, start, stop, layer, dt, a, memory, terms, out):
    """Contribution of elements ``start`` to ``stop`` of row ``j``, all of one layer, in ``out`` [N_COLUMNS, n_columns].

    Sums are taken afterwards, so that this loop vectorises.
    """
    r = uintp(j)
    factors, shares = a.factors[layer], a.terms[layer]
    mu, K, linear, quadratic, hourglass = a.moduli[layer]
    n, last = n_points(memory, terms), bulk_place(memory, terms)
    stride = len(memory) // len(terms)
    for i in range(uintp(start), uintp(stop)):
        X, Y, u, w = corners(a.X, r, i), corners(a.Y, r, i), corners(a.u, r, i), corners(a.w, r, i)
        vx, vy = corners(a.vx, r, i), corners(a.vy, r, i)
        u0 = (u[0] - dt * vx[0], u[1] - dt * vx[1], u[2] - dt * vx[2], u[3] - dt * vx[3])
        w0 = (w[0] - dt * vy[0], w[1] - dt * vy[1], w[2] - dt * vy[2], w[3] - dt * vy[3])
        A = area(X, Y)
        e, e0 = volume_change(X, Y, u, w), volume_change(X, Y, u0, w0)
        springs, viscous, control, J_least, J_most = 0.0, 0.0, 0.0, BEYOND, 0.0
        stored = 0.25 * K * A * (e * e + e0 * e0)
        rate = (e - e0) / dt
        J = 1.0 + 0.5 * (e + e0)
        L2 = squared_length(X[0] - X[2], Y[0] - Y[2], X[1] - X[3], Y[1] - Y[3], A)
        bulk_viscous = A * bulk_viscosity(rate / J, L2, linear, quadratic) * rate
        if last:
            for m in range(len(terms)):
                b = factors[m, 4]
                Z = memory[stride * m + last][r, i]
                H, H0 = Z + b * e, (Z + b * e0) / factors[m, 1]
                viscous += 0.5 * A * (H + H0) * rate
                springs += 0.5 * A * H * H * inverse_or_zero(shares[m, 1])
        for g in range(n):
            xi, eta = point_place(g, n)
            bx, by, D = point_gradients(xi, eta, X, Y)
            D *= 4.0 / n
            q, q0 = deformation(bx, by, u, w), deformation(bx, by, u0, w0)
            energy = q.J23 * (q.C11 + q.C22 + 1.0) + q0.J23 * (q0.C11 + q0.C22 + 1.0) - 6.0
            stored += 0.25 * D * mu * energy
            S11, S22, S12 = _overstress_2pk(q, 4 * g, memory, terms, factors, r, i, False)
            T11, T22, T12 = _overstress_2pk(q0, 4 * g, memory, terms, factors, r, i, True)
            work = (S11 + T11) * (q.C11 - q0.C11) + (S22 + T22) * (q.C22 - q0.C22)
            work += 2.0 * (S12 + T12) * (q.C12 - q0.C12)
            viscous += 0.25 * D * work / dt
            for m in range(len(terms)):
                springs += D * _spring_energy(q, 4 * g, m, memory, terms, factors, r, i, shares[m, 0])
            J_least, J_most = min(J_least, q.J), max(J_most, q.J)
        bx, by, D = point_gradients(0.0, 0.0, X, Y)
        qx, qy = _hourglass(X, Y, bx, by, u), _hourglass(X, Y, bx, by, w)
        out[HOURGLASS_AMPLITUDE, i] = math.sqrt((qx * qx + qy * qy) / (16.0 * A))
        if n == 1:
            qx0, qy0 = _hourglass(X, Y, bx, by, u0), _hourglass(X, Y, bx, by, w0)
            stiffness = hourglass * HOURGLASS_STIFFNESS * A * (dot(bx, bx) + dot(by, by))
            F, F0 = deformation(bx, by, u, w), deformation(bx, by, u0, w0)
            Qx, Qy = _hourglass_overstress(F, qx, qy, memory, terms, factors, r, i, False)
            Tx, Ty = _hourglass_overstress(F0, qx0, qy0, memory, terms, factors, r, i, True)
            Qx += Tx + mu * (qx + qx0)
            Qy += Ty + mu * (qy + qy0)
            control += 0.5 * stiffness * (Qx * (qx - qx0) + Qy * (qy - qy0)) / dt
        out[STORED, i], out[SPRINGS, i], out[VISCOUS, i], out[BULK_VISCOUS, i] = (
            stored,
            springs,
            viscous,
            bulk_viscous,
        )
        out[HOURGLASS, i], out[J_LEAST, i], out[J_MOST, i] = control, J_least, J_most


@vector
def _sum(values):
    total = 0.0
    for i in range(values.size):
        total += values[i]
    return total


@serial
def _largest(values, sign):
    """Of ``sign`` times the values; NaN if any is."""
    largest = sign * values[0]
    for i in range(values.size):
        value = sign * values[i]
        if value > largest or value != value:
            largest = value
    return largest


@scalar
def kinetic_energy(inverse_mass, vx, vy):
    """Kinetic energy [J/m] of a node, in double precision whatever that of the state; one without mass has none."""
    x, y, m = float64(vx), float64(vy), float64(inverse_mass)
    return 0.5 * (x * x + y * y) / m if m > 0.0 else 0.0


@vector
def _kinetic_row(j, inverse_mass, vx, vy):
    r, total = uintp(j), 0.0
    for i in range(uintp(vx.shape[1])):
        total += kinetic_energy(inverse_mass[r, i], vx[r, i], vy[r, i])
    return total


@serial
def survey_share(part, dt, a, memory, terms, work, out):
    """Fill the rows of one share in ``out`` [n_rows + 1, N_SUMS] with the sums, or extremes, of each row.

    A row of elements counts the nodes below it; the topmost nodes have the last row to themselves.

    ``work`` [n_parts, N_COLUMNS, n_columns] is a buffer. ``dt`` [s] is the step that led to the present state.
    """
    row = work[part]
    for j in range(a.shares[part], a.shares[part + 1]):
        for k in range(a.first_run[j], a.first_run[j + 1]):
            start, stop, layer = a.runs[k]
            survey_run(j, start, stop, layer, dt, a, memory, terms, row)
        for column in range(HOURGLASS_AMPLITUDE):
            out[j, column] = _sum(row[column])
        out[j, HOURGLASS_AMPLITUDE] = _largest(row[HOURGLASS_AMPLITUDE], 1.0)
        out[j, J_LEAST], out[j, J_MOST] = -_largest(row[J_LEAST], -1.0), _largest(row[J_MOST], 1.0)
        out[j, KINETIC] = _kinetic_row(j, a.inverse_mass, a.vx, a.vy)
    top = a.u.shape[0] - 1
    if a.shares[part + 1] == top:
        out[top, KINETIC] = _kinetic_row(top, a.inverse_mass, a.vx, a.vy)
