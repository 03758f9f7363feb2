"""One time step after another, on one or more threads, with identical results for any number of them.

Threads take contiguous rows of elements, and the nodes from their first row on. A thread moves the rows of nodes
inside its share as it goes. The row between two shares belongs to the upper one, which needs the forces of the lower
one's last row of elements to move it; and the lower one needs it moved. Each has half a step to do so: the lower share
computes that row of elements in the middle of its step, the upper one moves the row of nodes at the end. Each thread
also does what the edges demand of its own nodes: a line of memory that another core has changed takes as long to come
as a dozen elements.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numba import types
from numba.extending import overload

from wrinklewave._jit import INLINED, STRICTLY_INLINED, in_single_precision, serial, strict
from wrinklewave.dynamics.barrier import ABANDONED, LINE, store, wait_for, wait_for_all
from wrinklewave.dynamics.boundary import (
    FORCE,
    LEFT_STRAIGHT,
    N_TOTALS,
    Boundary,
    Nodes,
    hold_rows,
    keep_straight,
    n_edge_nodes,
    remember_rows,
    straight_rate,
)
from wrinklewave.dynamics.mean_dilatation_rows import mean_dilatation_element, mean_dilatation_row
from wrinklewave.dynamics.points import ONE_POINT_COMPONENTS
from wrinklewave.dynamics.rows import move_node, node_row, one_point_element, one_point_row
from wrinklewave.dynamics.team import share_out
from wrinklewave.materials.prony import step_factors

FIRST, BORDER = 2, 3
"""Buffers of forces: of the first row of a share, and of the one next to another share; 0 and 1 take turns."""
MET, MOVED, KNOWN = range(3)
"""What each thread counts: meetings of all; steps after which its nodes are where they belong; steps in which the
forces are known that the next share needs."""


class Arrays(NamedTuple):
    """All that the stepping kernels read and write; see :mod:`wrinklewave.dynamics.rows` for shapes and units.

    ``forces`` [n_parts, 4, 8, n_columns + 2] are the row buffers of each thread: two in turn, its first row and the one
    next to another share;
    ``nothing`` [8, n_columns + 2] is zero: the forces of the row that is not there, below the mesh and above it;
    ``counts`` [3, n_parts * LINE] tell the threads how far the others are, see :mod:`wrinklewave.dynamics.barrier`.
    """

    X: np.ndarray
    Y: np.ndarray
    x: np.ndarray  # as elements read X: by column where all its columns are straight, else X itself
    y: np.ndarray  # as elements read Y: by row where all its rows are level, else Y itself
    u: np.ndarray
    w: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    inverse_mass: np.ndarray
    runs: (
        np.ndarray
    )  # neighbours in a row of one material: first column, the one after the last, layer, [n_runs, 3]
    first_run: np.ndarray  # of each row, and the number of all, [n_rows + 1]
    moduli: np.ndarray  # [n_layers, 5], as one_point_element takes them
    terms: np.ndarray  # [n_layers, n_terms, 3]: shear share, bulk share [Pa], relaxation time [s]
    factors: np.ndarray  # [n_layers, n_terms, 5]
    shares: np.ndarray  # first element row of each thread, and the number of rows, [n_parts + 1]
    forces: np.ndarray
    nothing: np.ndarray
    counts: np.ndarray


@serial
def update_factors(terms, dt_last, dt, factors):
    """Prony coefficients for the step just taken and the one to come."""
    for n in range(terms.shape[0]):
        for m in range(terms.shape[1]):
            tau = terms[n, m, 2]
            b_last = step_factors(dt_last, tau)[1]
            decay, b = step_factors(dt, tau)
            factors[n, m, 0] = terms[n, m, 0] * b_last
            factors[n, m, 1] = decay
            factors[n, m, 2] = terms[n, m, 0] * b
            factors[n, m, 3] = terms[n, m, 1] * b_last
            factors[n, m, 4] = terms[n, m, 1] * b


def element(r, i, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """Forces of an element of whichever kind and precision this state belongs to; chosen when compiled."""
    of = _of_kind(one_point_element, mean_dilatation_element, len(memory), len(terms), u.dtype == np.float32)
    of(r, i, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces)


def _of_kind(one_point, mean_dilatation, n_memory, n_terms, single):
    of = one_point if n_memory // n_terms in ONE_POINT_COMPONENTS else mean_dilatation
    return in_single_precision(of) if single else of


@overload(element, jit_options=INLINED)
def choose_element(r, i, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """What numba compiles in place of :func:`element`."""
    single = u.dtype == types.float32
    of = _of_kind(one_point_element, mean_dilatation_element, memory.count, terms.count, single)

    def call(r, i, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
        of(r, i, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces)

    return call


def element_row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """Forces of part of a row of elements, as :func:`element`; chosen when compiled."""
    of = _of_kind(one_point_row, mean_dilatation_row, len(memory), len(terms), u.dtype == np.float32)
    of(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces)


@overload(element_row, jit_options=INLINED)
def choose_element_row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """What numba compiles in place of :func:`element_row`."""
    single = u.dtype == types.float32
    of = _of_kind(one_point_row, mean_dilatation_row, memory.count, terms.count, single)

    def call(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
        of(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces)

    return call


@strict
def separate(forces):
    """The rows of a buffer of forces as arrays of their own."""
    f = forces
    return f[0], f[1], f[2], f[3], f[4], f[5], f[6], f[7]


def move_row(j, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
    """Move a row of nodes, in the precision of its state; chosen when compiled."""
    of, number = _in_precision(node_row, u.dtype == np.float32)
    of(j, below, above, inverse_mass, number(dt_velocity), number(dt), u, w, vx, vy)


def _in_precision(kernel, single):
    return (in_single_precision(kernel), types.float32) if single else (kernel, types.float64)


@overload(move_row, jit_options=STRICTLY_INLINED)
def choose_move_row(j, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
    """What numba compiles in place of :func:`move_row`."""
    of, number = _in_precision(node_row, u.dtype == types.float32)

    def call(j, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
        of(j, below, above, inverse_mass, number(dt_velocity), number(dt), u, w, vx, vy)

    return call


def move(r, i, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
    """Move one node, as :func:`move_row`; chosen when compiled."""
    of, number = _in_precision(move_node, u.dtype == np.float32)
    of(r, i, below, above, inverse_mass, number(dt_velocity), number(dt), u, w, vx, vy)


@overload(move, jit_options=STRICTLY_INLINED)
def choose_move(r, i, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
    """What numba compiles in place of :func:`move`."""
    of, number = _in_precision(move_node, u.dtype == types.float32)

    def call(r, i, below, above, inverse_mass, dt_velocity, dt, u, w, vx, vy):
        of(r, i, below, above, inverse_mass, number(dt_velocity), number(dt), u, w, vx, vy)

    return call


@strict
def border_of(part, a):
    """The last element row of a share, if another share follows it; else -1."""
    return a.shares[part + 1] - 1 if part < a.shares.size - 2 else -1


@strict
def _slot(j, part, a):
    """Buffer of element row j of a share."""
    if j == a.shares[part]:
        return FIRST
    return BORDER if j == border_of(part, a) else (j - a.shares[part]) % 2


@strict
def _move_row(j, below, above, a, dt_velocity, dt):
    move_row(j, below, above, a.inverse_mass, dt_velocity, dt, a.u, a.w, a.vx, a.vy)


@strict
def forces_of_row(j, a, memory, terms, out):
    """Forces of element row ``j`` on its corners, to a buffer ``out`` [8, n_columns + 2]."""
    forces = separate(out)
    for k in range(a.first_run[j], a.first_run[j + 1]):
        begin, end, n = a.runs[k]
        factors, moduli = a.factors[n], a.moduli[n]
        element_row(j, begin, end, a.x, a.y, a.u, a.w, a.vx, a.vy, memory, terms, factors, moduli, forces)


@serial
def _rows(part, start, stop, a, memory, terms, dt_velocity, dt):
    """Forces of element rows ``start`` to ``stop`` of a share; the nodes below each move if both rows are known."""
    first, border = a.shares[part], border_of(part, a)
    for j in range(start, stop):
        forces_of_row(j, a, memory, terms, a.forces[part, _slot(j, part, a)])
        if j > first and j != border:
            _move_between(j, part, a, dt_velocity, dt)


@strict
def _move_between(j, part, a, dt_velocity, dt):
    """Move the row of nodes between element rows j - 1 and j of a share."""
    below, above = a.forces[part, _slot(j - 1, part, a)], a.forces[part, _slot(j, part, a)]
    _move_row(j, below, above, a, dt_velocity, dt)


@strict
def _share(part, step, a, memory, terms, dt_velocity, dt):
    """Forces of all elements of a share in a step, and all its nodes but the first row moved.

    There is one call of :func:`_rows`: a second one could be compiled to other roundings.
    """
    first, last, border = a.shares[part], a.shares[part + 1], border_of(part, a)
    middle = (first + last) // 2 if border >= 0 else last
    for stage in range(3 if border >= 0 else 1):
        if stage == 1:
            wait_for(a.counts[MOVED], part + 1, step)
        start = first if stage == 0 else border if stage == 1 else middle
        stop = middle if stage == 0 else last if stage == 1 else border
        _rows(part, start, stop, a, memory, terms, dt_velocity, dt)
        if stage == 1:
            store(a.counts[KNOWN], part * LINE, step + 1)
    if border > first:
        _move_between(border, part, a, dt_velocity, dt)


@strict
def _edge_rows_of_share(part, step, a, dt_velocity, dt):
    """Move the first row of nodes of a share, with the forces of the share below; and the last row of the mesh."""
    first, last = a.shares[part], a.shares[part + 1]
    below = a.nothing
    if part > 0:
        wait_for(a.counts[KNOWN], part - 1, step + 1)
        below = a.forces[part - 1, _slot(first - 1, part - 1, a)]
    _move_row(first, below, a.forces[part, FIRST], a, dt_velocity, dt)
    if last == a.u.shape[0] - 1:
        _move_row(last, a.forces[part, _slot(last - 1, part, a)], a.nothing, a, dt_velocity, dt)


@serial
def march(part, n_steps, t, dt_last, dt, a, memory, terms, boundary, totals):
    """Take all steps of one share, in step with the other shares. A share has the nodes from its first row on."""
    n_parts, rows = a.shares.size - 1, a.u.shape[0]
    first = a.shares[part]
    stop = rows if part == n_parts - 1 else a.shares[part + 1]
    nodes = Nodes(a.X, a.Y, a.u, a.w, a.vx, a.vy, a.inverse_mass)
    meeting = 0
    for n in range(n_steps):
        dt_velocity = 0.5 * ((dt_last if n == 0 else dt) + dt)
        if n < 2:
            meeting = wait_for_all(a.counts[MET], part, n_parts, meeting + 1)
            if part == 0:
                update_factors(a.terms, dt_last if n == 0 else dt, dt, a.factors)
            meeting = wait_for_all(a.counts[MET], part, n_parts, meeting + 1)
        remember_rows(first, stop, nodes, boundary)
        _share(part, n, a, memory, terms, dt_velocity, dt)
        _edge_rows_of_share(part, n, a, dt_velocity, dt)
        hold_rows(first, stop, t + (n + 1) * dt, dt, nodes, boundary, totals, n == n_steps - 1)
        if boundary.left == LEFT_STRAIGHT:
            meeting = wait_for_all(a.counts[MET], part, n_parts, meeting + 1)
            rate = straight_rate(nodes)
            meeting = wait_for_all(a.counts[MET], part, n_parts, meeting + 1)
            for j in range(first, stop):
                keep_straight(j, rate, dt, nodes, boundary)
        store(a.counts[MOVED], part * LINE, n + 1)


def advance(
    n_steps: int,
    t: float,
    dt_last: float,
    dt: float,
    a: Arrays,
    memory: tuple[np.ndarray, ...],
    terms: tuple[float, ...],
    boundary: Boundary,
    totals: np.ndarray,
) -> None:
    """Take ``n_steps`` steps of ``dt`` [s] from time ``t`` = that of the positions, in place, a thread for each share.

    ``dt_last`` is the length of the step that led to the present state (0 at the start). ``totals`` gathers work and
    impulses at the boundary, see :mod:`wrinklewave.dynamics.boundary`.
    """
    share_out_steps(march, a, totals, n_steps, t, dt_last, dt, a, memory, terms, boundary)


def share_out_steps(march: Callable[..., None], a: Arrays, totals: np.ndarray, *arguments: Any) -> None:
    """Call ``march(part, *arguments, totals of each edge node)`` for every share; sums go to ``totals``."""
    by_node = np.zeros((n_edge_nodes(*a.u.shape), N_TOTALS))
    a.counts[:] = 0
    try:
        share_out(march, a.shares.size - 1, *arguments, by_node)
    except BaseException:
        a.counts[:] = ABANDONED  # so that nobody waits for a share that will not come
        raise
    totals[FORCE] = 0.0
    totals += by_node.sum(axis=0)
