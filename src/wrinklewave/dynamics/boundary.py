"""What happens at the edges of the mesh after each step: drives, contact, symmetry, walls; and what they cost.

The nodes are moved freely first; then a condition replaces the velocity of its nodes, which amounts to an impulse
m (v_new - v_free). Its work on the body is exact for central differences: impulse · (v_old + v_new)/2.
Contact with the rigid plates is unilateral: a node is pushed out of a plate, never pulled to it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import serial
from wrinklewave.dynamics.self_contact import NO_BINS, keep_apart

FREE, FIXED, ROLLER = 0, 1, 2
LEFT_FREE, LEFT_MOVED, LEFT_HELD, LEFT_LINEAR, LEFT_STRAIGHT, LEFT_STRUCK = 0, 1, 2, 3, 4, 5

WORK, CONTACT_LOSS, FRICTION_LOSS, IMPULSE_LEFT, IMPULSE_RIGHT, IMPULSE_ACROSS, FORCE = range(7)
"""Places in ``totals``: external work, losses in contact and friction [J/m]; impulses in x from the left and from the
right, and in y [N s/m]; force of the struck end in the last step [N/m]."""
N_TOTALS = 7


class Boundary(NamedTuple):
    """Edge conditions and their working memory.

    ``motion`` and ``motion_across`` [n_segments, 6] are piecewise cubic histories of the plate or end: t0, t1 [s],
    U0, U1 [m], V0, V1 [m/s]; ``old`` [3, 4, n] holds u, w, vx, vy before the step, of the left column, the bottom row
    and the top row. A free surface may touch itself if there are ``bins`` [2, n_columns] for it to be sorted into.
    """

    left: int
    right: int
    top: int
    bottom: int
    wall: bool
    length: float
    friction: float
    motion: np.ndarray
    motion_across: np.ndarray
    old: np.ndarray
    bins: np.ndarray = NO_BINS


@serial
def position(motion, t):
    """Value at time ``t`` of a piecewise cubic history; constant before its start, linear after its end."""
    n = motion.shape[0]
    if t <= motion[0, 0]:
        return motion[0, 2]
    if t >= motion[n - 1, 1]:
        return motion[n - 1, 3] + motion[n - 1, 5] * (t - motion[n - 1, 1])
    k = np.searchsorted(motion[:, 1], t)
    h = motion[k, 1] - motion[k, 0]
    s = (t - motion[k, 0]) / h
    return (
        (1 + 2 * s) * (1 - s) ** 2 * motion[k, 2]
        + s**2 * (3 - 2 * s) * motion[k, 3]
        + h * s * (1 - s) ** 2 * motion[k, 4]
        + h * s**2 * (s - 1) * motion[k, 5]
    )


@serial
def remember_boundary(u, w, vx, vy, boundary):
    """Keep what the edges need of the state before a step."""
    rows, columns = u.shape
    for field, values in enumerate((u, w, vx, vy)):
        for j in range(rows):
            boundary.old[0, field, j] = values[j, 0]
        for i in range(columns):
            boundary.old[1, field, i] = values[0, i]
            boundary.old[2, field, i] = values[rows - 1, i]


@serial
def _push(a, j, i, edge, k, plate, plate_old, side, friction, dt, boundary, totals):
    """Keep node (j, i) out of a rigid plate; ``side`` is +1 for a plate on the left, -1 on the right."""
    gap = side * (a.X[j, i] + a.u[j, i] - plate)
    if gap >= 0.0 or a.inverse_mass[j, i] == 0.0:
        return 0.0
    mass = 1.0 / a.inverse_mass[j, i]
    u_old = boundary.old[edge, 0, k]
    vx_old, vy_old = boundary.old[edge, 2, k], boundary.old[edge, 3, k]
    v = (plate - a.X[j, i] - u_old) / dt
    impulse = mass * (v - a.vx[j, i])
    a.u[j, i] = plate - a.X[j, i]
    a.vx[j, i] = v
    work = impulse * (plate - plate_old) / dt
    totals[WORK] += work
    totals[CONTACT_LOSS] += work - impulse * 0.5 * (vx_old + v)
    limit = friction * abs(impulse)
    if limit > 0.0:
        tangential = min(max(-mass * a.vy[j, i], -limit), limit)
        a.vy[j, i] += tangential / mass
        a.w[j, i] += dt * tangential / mass
        totals[FRICTION_LOSS] -= tangential * 0.5 * (vy_old + a.vy[j, i])
        totals[IMPULSE_ACROSS] += tangential
    return impulse


@serial
def _prescribe(a, j, i, edge, k, U, across, W, dt, boundary, totals):
    """Put node (j, i) where the end is; ``across`` says whether its transverse displacement W is prescribed too."""
    if a.inverse_mass[j, i] == 0.0:
        return 0.0
    mass = 1.0 / a.inverse_mass[j, i]
    v = (U - boundary.old[edge, 0, k]) / dt
    impulse = mass * (v - a.vx[j, i])
    totals[WORK] += impulse * 0.5 * (v + boundary.old[edge, 2, k])
    a.u[j, i] = U
    a.vx[j, i] = v
    if across:
        v = (W - boundary.old[edge, 1, k]) / dt
        push = mass * (v - a.vy[j, i])
        totals[WORK] += push * 0.5 * (v + boundary.old[edge, 3, k])
        totals[IMPULSE_ACROSS] += push
        a.w[j, i] = W
        a.vy[j, i] = v
    return impulse


@serial
def _keep_straight(dt, a, boundary):
    """Let the left end move across only in proportion to height: the constraint that does no work."""
    momentum, inertia = 0.0, 0.0
    for j in range(a.w.shape[0]):
        if a.inverse_mass[j, 0] > 0.0:
            momentum += a.Y[j, 0] * a.vy[j, 0] / a.inverse_mass[j, 0]
            inertia += a.Y[j, 0] ** 2 / a.inverse_mass[j, 0]
    for j in range(a.w.shape[0]):
        a.vy[j, 0] = momentum / inertia * a.Y[j, 0]
        a.w[j, 0] = boundary.old[0, 1, j] + dt * a.vy[j, 0]


@serial
def _left(t, dt, a, boundary, totals):
    rows, columns = a.u.shape
    U, U_old = position(boundary.motion, t), position(boundary.motion, t - dt)
    impulse = 0.0
    if boundary.left == LEFT_STRUCK:
        for j in range(rows):
            impulse += _push(a, j, 0, 0, j, U, U_old, 1.0, boundary.friction, dt, boundary, totals)
        for i in range(1, columns):
            if boundary.top == FREE:
                impulse += _push(a, rows - 1, i, 2, i, U, U_old, 1.0, boundary.friction, dt, boundary, totals)
            if boundary.bottom == FREE:
                impulse += _push(a, 0, i, 1, i, U, U_old, 1.0, boundary.friction, dt, boundary, totals)
    else:
        across = boundary.left in (LEFT_HELD, LEFT_LINEAR)
        W_top = position(boundary.motion_across, t) if boundary.left == LEFT_LINEAR else 0.0
        half_height = a.Y[rows - 1, 0]
        for j in range(rows):
            W = W_top * a.Y[j, 0] / half_height
            impulse += _prescribe(a, j, 0, 0, j, U, across, W, dt, boundary, totals)
    if boundary.left == LEFT_STRAIGHT:
        _keep_straight(dt, a, boundary)
    totals[IMPULSE_LEFT] += impulse
    totals[FORCE] = impulse / dt


@serial
def _stop_across(a, j, dt, totals):
    """Symmetry or a frictionless guide: row j keeps its height."""
    for i in range(a.w.shape[1]):
        if a.inverse_mass[j, i] > 0.0:
            totals[IMPULSE_ACROSS] -= a.vy[j, i] / a.inverse_mass[j, i]
        a.w[j, i] = 0.0
        a.vy[j, i] = 0.0


@serial
def _right(a, boundary, totals):
    c = a.u.shape[1] - 1
    for j in range(a.u.shape[0]):
        if a.inverse_mass[j, c] > 0.0:
            totals[IMPULSE_RIGHT] -= a.vx[j, c] / a.inverse_mass[j, c]
            if boundary.right == FIXED:
                totals[IMPULSE_ACROSS] -= a.vy[j, c] / a.inverse_mass[j, c]
        a.u[j, c] = 0.0
        a.vx[j, c] = 0.0
        if boundary.right == FIXED:
            a.w[j, c] = 0.0
            a.vy[j, c] = 0.0


@serial
def _wall(dt, a, boundary, totals):
    rows, columns = a.u.shape
    L = boundary.length
    for i in range(1, columns - 1):
        if boundary.top == FREE:
            totals[IMPULSE_RIGHT] += _push(a, rows - 1, i, 2, i, L, L, -1.0, 0.0, dt, boundary, totals)
        if boundary.bottom == FREE:
            totals[IMPULSE_RIGHT] += _push(a, 0, i, 1, i, L, L, -1.0, 0.0, dt, boundary, totals)


@serial
def hold_apart(dt, a, boundary, totals):
    """Contact of the free surfaces with themselves; before all other conditions."""
    last = a.u.shape[0] - 1
    if boundary.top == FREE:
        totals[CONTACT_LOSS] += keep_apart(a, last, 1.0, dt, boundary.old[2], boundary.bins)
    if boundary.bottom == FREE:
        totals[CONTACT_LOSS] += keep_apart(a, 0, -1.0, dt, boundary.old[1], boundary.bins)


@serial
def apply_boundary(t, dt, a, boundary, totals):
    """Make the state at time ``t`` [s], reached by a free step ``dt``, obey the conditions at the edges."""
    if boundary.bins.shape[1] > 0:
        hold_apart(dt, a, boundary, totals)
    if boundary.bottom == ROLLER:
        _stop_across(a, 0, dt, totals)
    if boundary.top == ROLLER:
        _stop_across(a, a.u.shape[0] - 1, dt, totals)
    if boundary.left != LEFT_FREE:
        _left(t, dt, a, boundary, totals)
    if boundary.wall:
        _wall(dt, a, boundary, totals)
    if boundary.right != FREE:
        _right(a, boundary, totals)
