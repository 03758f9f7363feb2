"""The kernels. They share out elements, nodes, edge nodes and rows; the arithmetic is that of the processor's loops.

``a`` are the :class:`~wrinklewave.dynamics.step.Arrays` on the device, with two differences: ``forces``
[n_rows, 8, n_columns + 2] has a buffer for every row of elements, and ``layer`` [n_rows, n_columns] stands in for runs.
All that names ``cuda`` is in this one module, as numba's simulator demands.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from numba import config, cuda, float64, uintp

from wrinklewave._jit import choose_cache
from wrinklewave.dynamics.boundary import (
    BOTTOM,
    FORCE,
    FREE,
    LEFT_STRAIGHT,
    TOP,
    drive_position,
    hold_apart,
    hold_node,
    keep_straight,
    n_edge_nodes,
    remember_node,
    straight_rate,
)
from wrinklewave.dynamics.energy import (
    HOURGLASS_AMPLITUDE,
    J_LEAST,
    KINETIC,
    N_COLUMNS,
    kinetic_energy,
    survey_run,
)
from wrinklewave.dynamics.fields import fields_run
from wrinklewave.dynamics.stable_step import stable_step_run
from wrinklewave.dynamics.step import element, move_row

BLOCK = 256
"""Threads per block on a device; kernels work with fewer, if a power of two."""


def _kernel(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Compile when first launched, and keep it on disk; the simulator knows no options."""

    def compile_lazily(function: Callable[..., Any]) -> Any:
        choose_cache(function)
        return cuda.jit(cache=True, **({} if config.ENABLE_CUDASIM else options))(function)

    return compile_lazily


@cuda.jit(device=True)
def _elements(first, a, factors, layer, memory, terms, boundary):
    """Forces of all elements; and what the edges have to remember of the state before the step."""
    rows, columns = layer.shape
    for e in range(first, rows * columns, cuda.gridsize(1)):
        j = e // columns
        i = e - j * columns
        n = layer[j, i]
        b, moduli, forces = factors[n], a.moduli[n], a.forces[j]
        r, c = uintp(j), uintp(i)
        element(r, c, a.X, a.Y, a.u, a.w, a.vx, a.vy, memory, terms, b, moduli, forces)
    for n in range(first, n_edge_nodes(rows + 1, columns + 1), cuda.gridsize(1)):
        remember_node(n, a, boundary)


@cuda.jit(device=True)
def _nodes(first, dt_velocity, dt, a):
    """Move all nodes freely."""
    rows, columns = a.u.shape
    for p in range(first, rows * columns, cuda.gridsize(1)):
        j = p // columns
        i = p - j * columns
        below = a.forces[j - 1] if j > 0 else a.nothing
        above = a.forces[j] if j < rows - 1 else a.nothing
        move_row(j, i, i + 1, below, above, a.inverse_mass, dt_velocity, dt, a.u, a.w, a.vx, a.vy)


@cuda.jit(device=True)
def _overhangs(a, row):
    """Whether this thread sees a surface that folds; only then can it touch itself."""
    for i in range(cuda.threadIdx.x, a.u.shape[1] - 1, cuda.blockDim.x):
        if a.X[row, i + 1] + a.u[row, i + 1] < a.X[row, i] + a.u[row, i]:
            return 1
    return 0


@cuda.jit(device=True)
def _edges(t, dt, a, boundary, totals):
    """Conditions at the edges, by one block; ``totals`` [n_edge_nodes, N_TOTALS] are gathered node by node."""
    thread, threads = cuda.threadIdx.x, cuda.blockDim.x
    rows = a.u.shape[0]
    if boundary.bins.shape[2] > 0:
        folded = 0
        if boundary.top == FREE:
            folded += _overhangs(a, rows - 1)
        if boundary.bottom == FREE:
            folded += _overhangs(a, 0)
        if cuda.syncthreads_or(folded) and thread == 0:
            hold_apart(BOTTOM, dt, a, boundary, totals[0])
            hold_apart(TOP, dt, a, boundary, totals[rows - 1])
        cuda.syncthreads()
    drive = drive_position(t, dt, boundary)
    for n in range(thread, n_edge_nodes(rows, a.u.shape[1]), threads):
        totals[n, FORCE] = 0.0
        hold_node(n, drive, dt, a, boundary, totals[n])
    if boundary.left == LEFT_STRAIGHT:
        cuda.syncthreads()
        rate = straight_rate(a)
        cuda.syncthreads()
        for j in range(thread, rows, threads):
            keep_straight(j, rate, dt, a, boundary)


@cuda.jit(device=True)
def _combined(column, x, y):
    """Two sums, or extremes, as one; NaN if either is."""
    if column < HOURGLASS_AMPLITUDE or column == KINETIC or x != x or y != y:
        return x + y
    return min(x, y) if column == J_LEAST else max(x, y)


@cuda.jit(device=True)
def _total(column, value, shared):
    """The block's values as one, in a fixed order; for thread 0."""
    thread, half = cuda.threadIdx.x, cuda.blockDim.x // 2
    shared[thread] = value
    cuda.syncthreads()
    while half > 0:
        if thread < half:
            shared[thread] = _combined(column, shared[thread], shared[thread + half])
        cuda.syncthreads()
        half //= 2
    value = shared[0]
    cuda.syncthreads()
    return value


@cuda.jit(device=True)
def _sums(dt, a, layer, memory, terms, sums):
    """Sums of each row by one block, in an order that the size of the grid does not change.

    The contributions of the elements lie where their forces were: the next step computes those anew.
    """
    shared = cuda.shared.array(0, float64)  # as much as the launch asks for
    thread, threads = cuda.threadIdx.x, cuda.blockDim.x
    rows, columns = layer.shape
    for j in range(cuda.blockIdx.x, rows + 1, cuda.gridDim.x):
        value = 0.0
        for i in range(thread, columns + 1, threads):
            value += kinetic_energy(a.inverse_mass[j, i], a.vx[j, i], a.vy[j, i])
        sums[j, KINETIC] = _total(KINETIC, value, shared)
        if j == rows:
            continue
        work = a.forces[j][:, 1:-1]
        for i in range(thread, columns, threads):
            survey_run(j, i, i + 1, layer[j, i], dt, a, memory, terms, work)
        for column in range(N_COLUMNS):
            value = 1e300 if column == J_LEAST else 0.0
            for i in range(thread, columns, threads):
                value = _combined(column, value, work[column, i])
            sums[j, column] = _total(column, value, shared)


@cuda.jit(device=True)
def _steps(n, t, dt_last, dt, first_factors, a, layer, memory, terms, boundary, totals):
    """Take ``n`` steps of ``dt`` from time ``t``; the Prony coefficients of the first follow on one of ``dt_last``."""
    grid = cuda.cg.this_grid()
    first = cuda.grid(1)
    for step in range(n):
        dt_before = dt_last if step == 0 else dt
        _elements(first, a, first_factors if step == 0 else a.factors, layer, memory, terms, boundary)
        grid.sync()
        _nodes(first, 0.5 * (dt_before + dt), dt, a)
        grid.sync()
        if cuda.blockIdx.x == 0:
            _edges(t + (step + 1) * dt, dt, a, boundary, totals)
        grid.sync()


@cuda.jit(device=True)
def _sample(dt, a, layer, memory, terms, totals, sums, totals_now, corner):
    """The present state in numbers: ``sums`` [n_rows + 1, N_SUMS], ``totals_now`` as ``totals``, ``corner`` [2]."""
    _sums(dt, a, layer, memory, terms, sums)
    first = cuda.grid(1)
    for n in range(first, totals.shape[0], cuda.gridsize(1)):
        for k in range(totals.shape[1]):
            totals_now[n, k] = totals[n, k]
    if first == 0:
        corner[0], corner[1] = a.u[-1, 0], a.w[-1, 0]


@_kernel(max_registers=128)
def steps(n, t, dt_last, dt, first_factors, a, layer, memory, terms, boundary, totals):
    """Steps alone, with registers for half as many threads again: for meshes that take all of them."""
    _steps(n, t, dt_last, dt, first_factors, a, layer, memory, terms, boundary, totals)


@_kernel()
def sample(dt, a, layer, memory, terms, totals, sums, totals_now, corner):
    """A sample alone."""
    _sample(dt, a, layer, memory, terms, totals, sums, totals_now, corner)


@_kernel()
def march(
    n,
    group,
    t,
    dt_last,
    dt,
    first_factors,
    a,
    layer,
    memory,
    terms,
    boundary,
    totals,
    sums,
    totals_then,
    corner,
):
    """``n`` steps, and a sample after every ``group`` of them and at the end: for meshes with a thread for every node.

    Samples are the first index of ``sums``, ``totals_then`` and ``corner``.
    """
    grid = cuda.cg.this_grid()
    done = 0
    while done < n:
        count = min(group, n - done)
        dt_before, factors = dt_last if done == 0 else dt, first_factors if done == 0 else a.factors
        _steps(count, t + done * dt, dt_before, dt, factors, a, layer, memory, terms, boundary, totals)
        k = done // group
        _sample(dt, a, layer, memory, terms, totals, sums[k], totals_then[k], corner[k])
        grid.sync()
        done += count


@_kernel()
def snapshot(a, layer, memory, terms, nodal, elements):
    """The present state: ``nodal`` [4, ...] u, w, vx, vy, and the fields, ``elements`` [len(FIELDS), ...]."""
    rows, columns = layer.shape
    for e in range(cuda.grid(1), rows * columns, cuda.gridsize(1)):
        j = e // columns
        i = e - j * columns
        fields_run(j, i, i + 1, layer[j, i], a, memory, terms, elements)
    rows, columns = a.u.shape
    for p in range(cuda.grid(1), rows * columns, cuda.gridsize(1)):
        j = p // columns
        i = p - j * columns
        nodal[0, j, i], nodal[1, j, i] = a.u[j, i], a.w[j, i]
        nodal[2, j, i], nodal[3, j, i] = a.vx[j, i], a.vy[j, i]


@_kernel()
def stable_steps(a, layer, density, out, least):
    """Largest stable step of each element [s], ``out`` [n_rows, n_columns], and the ``least`` of each row [n_rows]."""
    shared = cuda.shared.array(0, float64)  # as much as the launch asks for
    thread, threads = cuda.threadIdx.x, cuda.blockDim.x
    rows, columns = layer.shape
    for j in range(cuda.blockIdx.x, rows, cuda.gridDim.x):
        value = 1e300
        for i in range(thread, columns, threads):
            stable_step_run(j, i, i + 1, layer[j, i], a, density, out)
            value = _combined(J_LEAST, value, out[j, i])
        least[j] = _total(J_LEAST, value, shared)
