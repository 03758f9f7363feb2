"""One time step after another, on one or more threads, with identical results for any number of them.

Threads take contiguous rows of elements. A thread moves the node rows inside its share; the rows between two shares
need the forces of both and are moved after all have finished, in the same order of additions.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numba import prange
from numba.extending import overload

from wrinklewave._jit import parallel, serial
from wrinklewave.dynamics.barrier import wait_for_all
from wrinklewave.dynamics.boundary import apply_boundary, remember_boundary
from wrinklewave.dynamics.mean_dilatation_rows import mean_dilatation_row
from wrinklewave.dynamics.points import ONE_POINT_COMPONENTS
from wrinklewave.dynamics.rows import node_row, one_point_row
from wrinklewave.materials.prony import step_factors

FIRST = 0


class Arrays(NamedTuple):
    """All that the stepping kernels read and write; see :mod:`wrinklewave.dynamics.rows` for shapes and units.

    ``forces`` [n_parts, 3, 8, n_columns + 2] are the row buffers of each thread: its first row, and two in turn;
    ``nothing`` [8, n_columns + 2] is zero: the forces of the row that is not there, below the mesh and above it;
    ``meetings`` [n_parts * LINE] counts the meetings of each thread, see :mod:`wrinklewave.dynamics.barrier`.
    """

    X: np.ndarray
    Y: np.ndarray
    u: np.ndarray
    w: np.ndarray
    vx: np.ndarray
    vy: np.ndarray
    inverse_mass: np.ndarray
    runs: (
        np.ndarray
    )  # neighbours in a row of one material: first column, the one after the last, layer, [n_runs, 3]
    first_run: np.ndarray  # of each row, and the number of all, [n_rows + 1]
    moduli: np.ndarray  # [n_layers, 5], as one_point_row takes them
    terms: np.ndarray  # [n_layers, n_terms, 3]: shear share, bulk share [Pa], relaxation time [s]
    factors: np.ndarray  # [n_layers, n_terms, 5]
    shares: np.ndarray  # first element row of each thread, and the number of rows, [n_parts + 1]
    forces: np.ndarray
    nothing: np.ndarray
    meetings: np.ndarray


@serial
def update_factors(a, dt_last, dt):
    """Prony coefficients for the step just taken and the one to come."""
    for n in range(a.terms.shape[0]):
        for m in range(a.terms.shape[1]):
            tau = a.terms[n, m, 2]
            b_last = step_factors(dt_last, tau)[1]
            decay, b = step_factors(dt, tau)
            a.factors[n, m, 0] = a.terms[n, m, 0] * b_last
            a.factors[n, m, 1] = decay
            a.factors[n, m, 2] = a.terms[n, m, 0] * b
            a.factors[n, m, 3] = a.terms[n, m, 1] * b_last
            a.factors[n, m, 4] = a.terms[n, m, 1] * b


def element_row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """Forces of part of a row of whichever element this memory belongs to; chosen when the kernel is compiled."""
    row = _row_of(len(memory), len(terms))
    row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces)


def _row_of(n_memory, n_terms):
    return one_point_row if n_memory // n_terms in ONE_POINT_COMPONENTS else mean_dilatation_row


@overload(element_row)
def choose_element_row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
    """What numba compiles in place of :func:`element_row`."""
    row = _row_of(memory.count, terms.count)

    def call(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces):
        row(j, start, stop, X, Y, u, w, vx, vy, memory, terms, factors, moduli, forces)

    return call


@serial
def _slot(j, first):
    """Buffer of element row j in a share that begins at ``first``."""
    return 0 if j == first else 1 + (j - first) % 2


@serial
def _share(part, a, memory, terms, dt_velocity, dt):
    first, last = a.shares[part], a.shares[part + 1]
    forces = a.forces[part]
    for j in range(first, last):
        above = forces[_slot(j, first)]
        for k in range(a.first_run[j], a.first_run[j + 1]):
            start, stop, n = a.runs[k]
            factors, moduli = a.factors[n], a.moduli[n]
            element_row(j, start, stop, a.X, a.Y, a.u, a.w, a.vx, a.vy, memory, terms, factors, moduli, above)
        if j > first:
            below = forces[_slot(j - 1, first)]
            node_row(j, 0, a.u.shape[1], below, above, a.inverse_mass, dt_velocity, dt, a.u, a.w, a.vx, a.vy)


@serial
def _rows_between_shares(a, dt_velocity, dt):
    n_parts = a.shares.size - 1
    for part in range(n_parts + 1):
        j = a.shares[part]
        below = a.nothing
        if part > 0:
            below = a.forces[part - 1, _slot(j - 1, a.shares[part - 1])]
        above = a.nothing
        if part < n_parts:
            above = a.forces[part, FIRST]
        node_row(j, 0, a.u.shape[1], below, above, a.inverse_mass, dt_velocity, dt, a.u, a.w, a.vx, a.vy)


@serial
def _before_step(n, dt_last, dt, a, boundary):
    if n < 2:
        update_factors(a, dt_last if n == 0 else dt, dt)
    remember_boundary(a, boundary)


@serial
def _after_shares(n, t, dt_velocity, dt, a, boundary, totals):
    _rows_between_shares(a, dt_velocity, dt)
    apply_boundary(t + (n + 1) * dt, dt, a, boundary, totals)


@serial
def _march(part, n_parts, n_steps, t, dt_last, dt, a, memory, terms, boundary, totals):
    """Take all steps of one share, in step with the other shares; the first also does what concerns all."""
    for n in range(n_steps):
        dt_velocity = 0.5 * ((dt_last if n == 0 else dt) + dt)
        if part == 0:
            _before_step(n, dt_last, dt, a, boundary)
        wait_for_all(a.meetings, part, n_parts, 2 * n + 1)
        _share(part, a, memory, terms, dt_velocity, dt)
        wait_for_all(a.meetings, part, n_parts, 2 * n + 2)
        if part == 0:
            _after_shares(n, t, dt_velocity, dt, a, boundary, totals)


@parallel
def advance(n_steps, t, dt_last, dt, a, memory, terms, boundary, totals):
    """Take ``n_steps`` steps of ``dt`` [s] from time ``t`` = that of the positions, in place.

    ``dt_last`` is the length of the step that led to the present state (0 at the start). ``totals`` gathers work and
    impulses at the boundary, see :mod:`wrinklewave.dynamics.boundary`. There must be a thread for each share.
    """
    n_parts = a.shares.size - 1
    a.meetings[:] = 0
    for part in prange(n_parts):
        _march(part, n_parts, n_steps, t, dt_last, dt, a, memory, terms, boundary, totals)
