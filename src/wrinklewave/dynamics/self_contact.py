"""A free surface that folds onto itself: its nodes may not pass through its own segments.

The surface is a chain of nodes from the struck end to the held one. It can touch itself only where it overhangs,
which is looked for first and costs next to nothing. Then segments are sorted into bins along x, and every node is held
against the segments nearby that face it. A node behind such a segment gets, and the segment's two nodes share with
opposite sign, the impulse that stops their approach and returns part of the overlap: momentum is kept, and what kinetic
energy is lost is counted.
"""

from __future__ import annotations

import math

import numpy as np

from wrinklewave._jit import serial, strict, uintp, vector

RETURNED = 0.01
"""Part of the overlap that is given back in one step."""
DEEPEST = 0.5
"""Overlaps beyond this fraction of a segment's length are no contact, but a place seen through the body."""
EMPTY = -1


@vector
def _steps(row, X, u):
    """Least and largest step along x from node to node of a surface [m]; it overhangs where one is negative."""
    r = uintp(row)
    least = most = X[r, 1] + u[r, 1] - X[r, 0] - u[r, 0]
    for i in range(uintp(1), uintp(X.shape[1] - 1)):
        step = X[r, i + uintp(1)] + u[r, i + uintp(1)] - X[r, i] - u[r, i]
        least, most = min(least, step), max(most, step)
    return least, most


@strict
def _place(a, row, i):
    return a.X[row, i] + a.u[row, i], a.Y[row, i] + a.w[row, i]


@strict
def _sort_segments(a, row, left, width, bins):
    """Chain the segments of each bin: ``bins`` [2, n] holds the first of a bin, and each one's successor."""
    bins[0, :] = EMPTY
    for k in range(a.X.shape[1] - 1):
        middle = 0.5 * (_place(a, row, k)[0] + _place(a, row, k + 1)[0])
        b = min(max(int((middle - left) / width), 0), bins.shape[1] - 1)
        bins[1, k] = bins[0, b]
        bins[0, b] = k


@serial
def _hold(a, row, side, i, k, dt, old):
    """Keep node ``i`` on the outer side of segment ``k``; returns the energy lost."""
    (px, py), (ax, ay), (bx, by) = _place(a, row, i), _place(a, row, k), _place(a, row, k + 1)
    tx, ty = bx - ax, by - ay
    length = math.hypot(tx, ty)
    nx, ny = -side * ty / length, side * tx / length
    gap = (px - ax) * nx + (py - ay) * ny
    share = ((px - ax) * tx + (py - ay) * ty) / (length * length)
    if gap >= 0.0 or gap < -DEEPEST * length or share < 0.0 or share > 1.0:
        return 0.0
    (lx, ly), (rx, ry) = _place(a, row, i - 1), _place(a, row, i + 1)
    if (-side * (ry - ly)) * nx + side * (
        rx - lx
    ) * ny >= 0.0:  # the surface at the node does not face the segment
        return 0.0
    m0, m1, m2 = a.inverse_mass[row, i], a.inverse_mass[row, k], a.inverse_mass[row, k + 1]
    w1, w2 = 1.0 - share, share
    vx = a.vx[row, i] - w1 * a.vx[row, k] - w2 * a.vx[row, k + 1]
    vy = a.vy[row, i] - w1 * a.vy[row, k] - w2 * a.vy[row, k + 1]
    approach = vx * nx + vy * ny
    wanted = -RETURNED * gap / dt
    if approach >= wanted:
        return 0.0
    impulse = (wanted - approach) / (m0 + w1 * w1 * m1 + w2 * w2 * m2)
    before = (old[2, i] - w1 * old[2, k] - w2 * old[2, k + 1]) * nx
    before += (old[3, i] - w1 * old[3, k] - w2 * old[3, k + 1]) * ny
    for node, change in ((i, m0 * impulse), (k, -w1 * m1 * impulse), (k + 1, -w2 * m2 * impulse)):
        a.vx[row, node] += change * nx
        a.vy[row, node] += change * ny
        a.u[row, node] += dt * change * nx
        a.w[row, node] += dt * change * ny
    return -0.5 * impulse * (before + wanted)


@serial
def keep_apart(a, row, side, dt, old, bins):
    """Hold a free surface, node row ``row``, against itself; returns the energy lost [J/m].

    ``side`` is +1 for the upper surface, -1 for the lower one; ``old`` holds u, w, vx, vy of the row before the step.
    """
    least, most = _steps(row, a.X, a.u)
    if least >= 0.0:
        return 0.0
    n = a.X.shape[1]
    left, right = _place(a, row, 0)[0], _place(a, row, 0)[0]
    for i in range(n):
        x = _place(a, row, i)[0]
        left, right = min(left, x), max(right, x)
    width = max(most, -least, (right - left) / bins.shape[1])
    _sort_segments(a, row, left, width, bins)
    lost = 0.0
    for i in range(1, n - 1):
        b = int((_place(a, row, i)[0] - left) / width)
        for near in range(max(b - 1, 0), min(b + 2, bins.shape[1])):
            k = bins[0, near]
            while k != EMPTY:
                if k > i + 1 or k < i - 2:
                    lost += _hold(a, row, side, i, k, dt, old)
                k = bins[1, k]
    return lost


NO_BINS = np.zeros((3, 2, 0), dtype=np.int64)
"""For a surface that is not held against itself."""
