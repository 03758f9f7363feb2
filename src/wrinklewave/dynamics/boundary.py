"""What happens at the edges of the mesh after each step: drives, contact, symmetry, walls; and what they cost.

The nodes are moved freely first; then a condition replaces the velocity of its nodes, which amounts to an impulse
m (v_new - v_free). Its work on the body is exact for central differences: impulse · (v_old + v_new)/2.
Contact with the rigid plates is unilateral: a node is pushed out of a plate, never pulled to it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import serial, strict, uintp, vector
from wrinklewave.dynamics.self_contact import NO_BINS, keep_apart

FREE, FIXED, ROLLER = 0, 1, 2
LEFT, BOTTOM, TOP, RIGHT = range(4)
"""Edges. A corner belongs to the left end if it can, else to the bottom or the top."""

LEFT_FREE, LEFT_MOVED, LEFT_HELD, LEFT_LINEAR, LEFT_STRAIGHT, LEFT_STRUCK = 0, 1, 2, 3, 4, 5

WORK, CONTACT_LOSS, FRICTION_LOSS, IMPULSE_LEFT, IMPULSE_RIGHT, IMPULSE_ACROSS, FORCE = range(7)
"""Places in ``totals``: external work, losses in contact and friction [J/m]; impulses in x from the left and from the
right, and in y [N s/m]; force of the struck end in the last step [N/m]."""
N_TOTALS = 7


class Nodes(NamedTuple):
    """What the edges see of the :class:`~wrinklewave.dynamics.step.Arrays`: fields of shape [n_rows, n_columns]."""

    X: np.ndarray
    Y: np.ndarray
    u: np.ndarray
    w: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    inverse_mass: np.ndarray


class Boundary(NamedTuple):
    """Edge conditions and their working memory.

    ``motion`` and ``motion_across`` [n_segments, 6] are piecewise cubic histories of the plate or end: t0, t1 [s],
    U0, U1 [m], V0, V1 [m/s]; ``old`` [3, 4, n] holds u, w, vx, vy before the step, of the left column, the bottom row
    and the top row. A free surface may touch itself if there are ``bins`` [3, 2, n_columns] for its segments
    to be sorted into, edge by edge. ``slipping`` is how many nodes of a fixed right end, below each free surface,
    slip along it.
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
    slipping: int = 0


@serial
def position(motion, t):
    """Value at time ``t`` of a piecewise cubic history; constant before its start, linear after its end."""
    n = motion.shape[0]
    if t <= motion[0, 0]:
        return motion[0, 2]
    if t >= motion[n - 1, 1]:
        return motion[n - 1, 3] + motion[n - 1, 5] * (t - motion[n - 1, 1])
    k, last = 0, n - 1
    while k < last:
        middle = (k + last) // 2
        if motion[middle, 1] < t:
            k = middle + 1
        else:
            last = middle
    h = motion[k, 1] - motion[k, 0]
    s = (t - motion[k, 0]) / h
    return (
        (1 + 2 * s) * (1 - s) ** 2 * motion[k, 2]
        + s**2 * (3 - 2 * s) * motion[k, 3]
        + h * s * (1 - s) ** 2 * motion[k, 4]
        + h * s**2 * (s - 1) * motion[k, 5]
    )


@strict
def n_edge_nodes(rows, columns):
    """Nodes at the edges of a grid of ``rows`` by ``columns`` nodes."""
    return 2 * (rows + columns) - 4


@strict
def edge_node(n, rows, columns):
    """Edge of the ``n``-th edge node, its place along it, and its row and column in the grid."""
    if n < rows:
        return LEFT, n, n, 0
    i = n - rows + 1
    if i < columns:
        return BOTTOM, i, 0, i
    i -= columns - 1
    if i < columns:
        return TOP, i, rows - 1, i
    j = i - columns + 1
    return RIGHT, j, j, columns - 1


@strict
def _remember(old, k, j, i, a):
    old[0, k], old[1, k], old[2, k], old[3, k] = a.u[j, i], a.w[j, i], a.vx[j, i], a.vy[j, i]


@strict
def remember_node(n, a, boundary):
    """Keep what the edges need of the state of their ``n``-th node before a step; corners for both their edges."""
    rows, columns = a.u.shape
    j, i = edge_node(n, rows, columns)[2:]
    if i == 0:
        _remember(boundary.old[LEFT], j, j, i, a)
    if j == 0:
        _remember(boundary.old[BOTTOM], i, j, i, a)
    if j == rows - 1:
        _remember(boundary.old[TOP], i, j, i, a)


@strict
def edge_ranges(first, stop, rows, columns):
    """Numbers of the edge nodes in node rows ``first`` to ``stop``: ranges of the left, bottom, top and right edge."""
    n_left, n_along = rows, columns - 1
    bottom, top = n_left, n_left + n_along
    right = top + n_along - 1  # the number that the right edge's node of row 0 would have
    return (
        (first, stop),
        (bottom, bottom + n_along if first == 0 else bottom),
        (top, top + n_along if stop == rows else top),
        (right + max(first, 1), right + min(stop, rows - 1)),
    )


@vector
def _remember_row(j, u, w, vx, vy, old):
    r = uintp(j)
    for i in range(uintp(u.shape[1])):
        old[0, i], old[1, i], old[2, i], old[3, i] = u[r, i], w[r, i], vx[r, i], vy[r, i]


@strict
def remember_rows(first, stop, a, boundary):
    """Keep what the edges in node rows ``first`` to ``stop`` need of the state before a step."""
    rows = a.u.shape[0]
    for j in range(first, stop):
        _remember(boundary.old[LEFT], j, j, 0, a)
    if first == 0 and boundary.bottom == FREE:
        _remember_row(0, a.u, a.w, a.vx, a.vy, boundary.old[BOTTOM])
    if stop == rows and boundary.top == FREE:
        _remember_row(rows - 1, a.u, a.w, a.vx, a.vy, boundary.old[TOP])


@strict
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


@strict
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


@strict
def _stop_across(a, j, i, totals):
    """Symmetry or a frictionless guide: node (j, i) keeps its height."""
    if a.inverse_mass[j, i] > 0.0:
        totals[IMPULSE_ACROSS] -= a.vy[j, i] / a.inverse_mass[j, i]
    a.w[j, i] = 0.0
    a.vy[j, i] = 0.0


@strict
def _stop(a, j, i, right, totals):
    """A node of the right edge keeps its place along x, and across if the edge is fixed."""
    if a.inverse_mass[j, i] > 0.0:
        totals[IMPULSE_RIGHT] -= a.vx[j, i] / a.inverse_mass[j, i]
        if right == FIXED:
            totals[IMPULSE_ACROSS] -= a.vy[j, i] / a.inverse_mass[j, i]
    a.u[j, i] = 0.0
    a.vx[j, i] = 0.0
    if right == FIXED:
        a.w[j, i] = 0.0
        a.vy[j, i] = 0.0


@strict
def drive_position(t, dt, boundary):
    """Where the plate or end is at time ``t`` and was ``dt`` before, and how far its top has moved across [m]."""
    if boundary.left == LEFT_FREE:
        return 0.0, 0.0, 0.0
    across = position(boundary.motion_across, t) if boundary.left == LEFT_LINEAR else 0.0
    return position(boundary.motion, t), position(boundary.motion, t - dt), across


@strict
def _drive(a, j, i, edge, k, drive, dt, boundary, totals):
    """What the left end does to a node of an edge, its own or one that may touch the plate."""
    U, U_old, W_top = drive
    if boundary.left == LEFT_STRUCK:
        impulse = _push(a, j, i, edge, k, U, U_old, 1.0, boundary.friction, dt, boundary, totals)
    elif edge == LEFT:
        across = boundary.left == LEFT_HELD or boundary.left == LEFT_LINEAR
        W = W_top * a.Y[j, 0] / a.Y[a.Y.shape[0] - 1, 0]
        impulse = _prescribe(a, j, i, edge, k, U, across, W, dt, boundary, totals)
    else:
        return
    totals[IMPULSE_LEFT] += impulse
    totals[FORCE] += impulse / dt


@strict
def hold_node(n, drive, dt, a, boundary, totals):
    """Make the ``n``-th edge node, moved by a free step ``dt`` [s], obey the conditions there.

    Everything but the straight end (:func:`keep_straight`) concerns one node at a time; ``drive`` is that of
    :func:`drive_position`. The order matters: guides, left end, wall, right edge.
    """
    rows, columns = a.u.shape
    edge, k, j, i = edge_node(n, rows, columns)
    if (j == 0 and boundary.bottom == ROLLER) or (j == rows - 1 and boundary.top == ROLLER):
        _stop_across(a, j, i, totals)
    surface = (edge == BOTTOM and boundary.bottom == FREE) or (edge == TOP and boundary.top == FREE)
    if boundary.left != LEFT_FREE and (edge == LEFT or surface):
        _drive(a, j, i, edge, k, drive, dt, boundary, totals)
    if boundary.wall and surface and i < columns - 1:
        L = boundary.length
        totals[IMPULSE_RIGHT] += _push(a, j, i, edge, k, L, L, -1.0, 0.0, dt, boundary, totals)
    if boundary.right != FREE and i == columns - 1:
        slips = j >= rows - boundary.slipping or (boundary.bottom == FREE and j < boundary.slipping)
        _stop(a, j, i, ROLLER if slips else boundary.right, totals)


@strict
def straight_rate(a):
    """Rate of the left end's motion across per height [1/s], from the momentum across that its nodes have together."""
    momentum, inertia = 0.0, 0.0
    for j in range(a.w.shape[0]):
        if a.inverse_mass[j, 0] > 0.0:
            momentum += a.Y[j, 0] * a.vy[j, 0] / a.inverse_mass[j, 0]
            inertia += a.Y[j, 0] ** 2 / a.inverse_mass[j, 0]
    return momentum / inertia


@strict
def keep_straight(j, rate, dt, a, boundary):
    """Let the left end move across only in proportion to height: the constraint that does no work."""
    a.vy[j, 0] = rate * a.Y[j, 0]
    a.w[j, 0] = boundary.old[LEFT, 1, j] + dt * a.vy[j, 0]


@strict
def hold_apart(edge, dt, a, boundary, totals):
    """Contact of the free surface at the bottom or top ``edge`` with itself; before all other conditions there."""
    row, side = (a.u.shape[0] - 1, 1.0) if edge == TOP else (0, -1.0)
    if (boundary.top if edge == TOP else boundary.bottom) == FREE:
        totals[CONTACT_LOSS] += keep_apart(a, row, side, dt, boundary.old[edge], boundary.bins[edge])


@vector
def _reach(j, X, u):
    """Least and largest x of a row of nodes."""
    r = uintp(j)
    least = most = X[r, 0] + u[r, 0]
    for i in range(uintp(u.shape[1])):
        x = X[r, i] + u[r, i]
        least, most = min(least, x), max(most, x)
    return least, most


@strict
def _is_clear(edge, drive, a, boundary):
    """Whether a surface is free, and touches neither plate nor wall: then nothing holds it but the ends."""
    if (boundary.top if edge == TOP else boundary.bottom) != FREE:
        return False
    least, most = _reach(a.u.shape[0] - 1 if edge == TOP else 0, a.X, a.u)
    return (boundary.left == LEFT_FREE or least >= drive[0]) and (
        not boundary.wall or most <= boundary.length
    )


@strict
def hold_rows(first, stop, t, dt, a, boundary, totals, is_last):
    """Make node rows ``first`` to ``stop`` at time ``t`` [s], reached by a free step ``dt``, obey their conditions.

    All but :func:`keep_straight`. ``totals`` [n_edge_nodes, N_TOTALS] are gathered node by node, so that their sum does
    not depend on who takes which rows; the force is that of the last of all steps.
    """
    rows, columns = a.u.shape
    if boundary.bins.shape[2] > 0:
        for edge in (BOTTOM, TOP):
            if (edge == TOP and stop == rows) or (edge == BOTTOM and first == 0):
                hold_apart(edge, dt, a, boundary, totals[0 if edge == BOTTOM else rows - 1])
    drive, ranges = drive_position(t, dt, boundary), edge_ranges(first, stop, rows, columns)
    for edge in range(len(ranges)):
        start, end = ranges[edge]
        if is_last:
            totals[start:end, FORCE] = 0.0
        if edge in (BOTTOM, TOP) and end > start and _is_clear(edge, drive, a, boundary):
            start = end - 1  # the corner belongs to the right end
        for n in range(start, end):
            hold_node(n, drive, dt, a, boundary, totals[n])
