"""The steps of members whose rows of elements have steps of their own, see :mod:`wrinklewave.dynamics.row_steps`.

All rows that are due at a tick, a step of the fastest row, are the first ones of a list that is sorted by their steps:
rows that are not due cost no work. The grid waits for itself twice in a tick, as in
:mod:`wrinklewave.dynamics.cuda.kernels`. That kernel remains for models with one step for all: what this one needs to
know beside takes registers.
"""

from __future__ import annotations

from typing import Any, NamedTuple

from numba import cuda, uintp

from wrinklewave.dynamics.boundary import (
    BOTTOM,
    FORCE,
    TOP,
    drive_position,
    edge_node,
    hold_apart,
    hold_node,
    n_edge_nodes,
    remember_node,
)
from wrinklewave.dynamics.cuda.kernels import START, boundary_of, clear, folds, kernel, nodes_of
from wrinklewave.dynamics.row_steps import impulse_time, is_due
from wrinklewave.dynamics.step import element, move

WARP = 32
"""Threads that go through the code together."""


class Timetable(NamedTuple):
    """Which rows of elements take a step at which tick of a launch.

    ``listed`` [n_members * n_rows, 2] are the rows, each a member of the launch and a row of it, those with the
    shortest steps first; ``due`` [MOST] how many of them take a step at a tick, by its remainder;
    ``period`` [n_members, n_rows] the ticks from one step of a row to the next; ``ticks`` [n_members] how many there
    are, ``dt`` [n_members] how long each is [s]; ``last`` [n_members, n_rows] the steps that led to the present state
    [s].
    """

    listed: Any
    due: Any
    period: Any
    ticks: Any
    dt: Any
    last: Any


class Mean(NamedTuple):
    """Mean velocities of the last large step [m/s], shape [n_tall_rows, n_columns + 1]."""

    vx: Any
    vy: Any


@cuda.jit(device=True)
def _spread():
    """Number of this thread, counted so that warps of all blocks take turns: few rows occupy all multiprocessors."""
    warp = cuda.threadIdx.x // WARP
    return (warp * cuda.gridDim.x + cuda.blockIdx.x) * WARP + cuda.threadIdx.x % WARP


@cuda.jit(device=True)
def _scale_upper(ratio, forces, i):
    """Forces of element ``i`` on its upper corners, whose row of nodes reckons with impulses of another time."""
    for component in range(4, 8):
        forces[component, i + 1] = ratio * forces[component, i + 1]


@cuda.jit(device=True)
def _elements(tick, table, members, factors, a, memory, terms):
    """Forces of all elements that are due."""
    columns, n_rows = a.layer.shape[1], table.period.shape[1]
    n_layers = a.moduli.shape[0] // (a.layer.shape[0] // (n_rows + 1))
    due = table.due[tick % table.due.shape[0]]
    for e in range(_spread(), due * columns, cuda.gridsize(1)):
        k, row = table.listed[e // columns, 0], table.listed[e // columns, 1]
        if tick >= table.ticks[k]:
            continue
        b, i = members[k], e % columns
        j = b * (n_rows + 1) + row
        n = b * n_layers + a.layer[j, i]
        forces, moduli = a.forces[j], a.moduli[n]
        r, c = uintp(j), uintp(i)
        element(r, c, a.X, a.Y, a.u, a.w, a.vx, a.vy, memory, terms, factors[n], moduli, forces)
        if row < n_rows - 1:
            dt, period, last = table.dt[k], table.period[k], table.last[k]
            own = impulse_time(row, tick, dt, period, last)
            above = impulse_time(row + 1, tick, dt, period, last)
            if own != above:
                _scale_upper(own / above, forces, i)


@cuda.jit(device=True)
def _move(k, b, row, i, tick, table, a):
    """Move one node of a member freely; a row of elements below it that is not due exerts no force."""
    dt, period, last = table.dt[k], table.period[k], table.last[k]
    n_rows = period.shape[0]
    bottom, above = b * (n_rows + 1), min(row, n_rows - 1)
    j = bottom + row
    below = j - 1
    if row > 0 and not is_due(row - 1, tick, period):
        below = bottom + n_rows  # where there are no elements
    dt_velocity, step = impulse_time(above, tick, dt, period, last), dt * period[above]
    forces = a.forces[below], a.forces[j]
    move(uintp(j), uintp(i), forces[0], forces[1], a.inverse_mass, dt_velocity, step, a.u, a.w, a.vx, a.vy)


@cuda.jit(device=True)
def _gather(k, b, row, i, tick, table, a, mean):
    """Add to the mean velocities of a node in the last large step."""
    period = table.period[k]
    begin, j = table.ticks[k] - period[0], b * (period.shape[0] + 1) + row
    if tick < begin:
        return
    weight = period[min(row, period.shape[0] - 1)] / period[0]
    x, y = weight * a.vx[j, i], weight * a.vy[j, i]
    if tick > begin:
        x += mean.vx[j, i]
        y += mean.vy[j, i]
    mean.vx[j, i], mean.vy[j, i] = x, y


@cuda.jit(device=True)
def _inner_nodes(tick, table, members, a, mean):
    """Move all nodes that are due but those at the edges; the first blocks, which have the edges, have the fewest."""
    columns = a.u.shape[1] - 2
    due = table.due[tick % table.due.shape[0]]
    for p in range(cuda.gridsize(1) - 1 - cuda.grid(1), due * columns, cuda.gridsize(1)):
        k, row = table.listed[p // columns, 0], table.listed[p // columns, 1]
        if row > 0 and tick < table.ticks[k]:
            i = 1 + p % columns
            _move(k, members[k], row, i, tick, table, a)
            _gather(k, members[k], row, i, tick, table, a, mean)


@cuda.jit(device=True)
def _move_edges(k, b, tick, table, a, nodes, boundary):
    """Remember and move the edge nodes of a member that are due, by one block."""
    own, edges = nodes_of(b, nodes), boundary_of(b, boundary)
    rows, columns = own.u.shape
    for n in range(cuda.threadIdx.x, n_edge_nodes(rows, columns), cuda.blockDim.x):
        j, i = edge_node(n, rows, columns)[2:]
        if is_due(min(j, rows - 2), tick, table.period[k]):
            remember_node(n, own, edges)
            _move(k, b, j, i, tick, table, a)


@cuda.jit(device=True)
def _hold_apart(k, b, tick, table, nodes, boundary, totals):
    """Contact of a member's free surfaces with themselves, by one thread of its block if there is any."""
    own, edges = nodes_of(b, nodes), boundary_of(b, boundary)
    dt, period, top = table.dt[k], table.period[k], own.u.shape[0] - 1
    folded = folds(own, edges, cuda.threadIdx.x, cuda.blockDim.x)
    if cuda.syncthreads_or(folded) and cuda.threadIdx.x == 0:
        for edge in range(BOTTOM, TOP + 1):
            j, row = (0, 0) if edge == BOTTOM else (top, top - 1)
            if is_due(row, tick, period):
                hold_apart(edge, dt * period[row], own, edges, totals[b, j])


@cuda.jit(device=True)
def _hold(k, b, start, tick, table, a, nodes, boundary, totals, mean):
    """Conditions at the edges of a member, by one block: those of a row hold at the end of its own step."""
    own, edges = nodes_of(b, nodes), boundary_of(b, boundary)
    rows, columns = own.u.shape
    dt, period = table.dt[k], table.period[k]
    known, drive = 0, (0.0, 0.0, 0.0)
    for n in range(cuda.threadIdx.x, totals.shape[1], cuda.blockDim.x):
        j, i = edge_node(n, rows, columns)[2:]
        row = min(j, rows - 2)
        if is_due(row, tick, period):
            step = dt * period[row]
            if period[row] != known:
                known = period[row]
                drive = drive_position(start + (tick + known) * dt, step, edges)
            totals[b, n, FORCE] = 0.0
            hold_node(n, drive, step, own, edges, totals[b, n])
            _gather(k, b, j, i, tick, table, a, mean)


@cuda.jit(device=True)
def _edges(tick, table, members, times, a, nodes, boundary, totals, mean):
    """Move the edge nodes that are due and see to their conditions, a block for each member."""
    for k in range(cuda.blockIdx.x, members.shape[0], cuda.gridDim.x):
        if tick < table.ticks[k]:
            _move_edges(k, members[k], tick, table, a, nodes, boundary)
            if boundary.bins.shape[3] > 0:
                cuda.syncthreads()
                _hold_apart(k, members[k], tick, table, nodes, boundary, totals)
                cuda.syncthreads()
            _hold(k, members[k], times[k, START], tick, table, a, nodes, boundary, totals, mean)


@kernel
def row_steps(ticks, table, members, times, first_factors, a, memory, terms, nodes, boundary, totals, mean):
    """Take all steps of a launch, as many ``ticks`` as the member with the most of them.

    The other arguments are those of :func:`wrinklewave.dynamics.cuda.kernels.steps`.
    """
    grid = cuda.cg.this_grid()
    clear(members, totals, cuda.grid(1), cuda.gridsize(1))
    for tick in range(ticks):
        factors = first_factors if tick == 0 else a.factors
        _elements(tick, table, members, factors, a, memory, terms)
        grid.sync()
        _edges(tick, table, members, times, a, nodes, boundary, totals, mean)
        _inner_nodes(tick, table, members, a, mean)
        grid.sync()
