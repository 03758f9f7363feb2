"""The kernels. They share out elements, nodes, edge nodes and rows; the arithmetic is that of the processor's loops.

The members of a batch, meshes of one shape, stand on top of each other as rows of one tall mesh: member ``b`` has the
node rows from ``b * height`` on, and the row of elements above its top nodes, which would reach to the next member, has
none. Their forces stay zero: they are what lies below and above a mesh. Every layer of every member is a material of
its own. So what works on rows of elements or nodes needs to know of no batch.

``members`` are the places of those that take part in a launch, in the order of what the launch brings back. What a
kernel calls and names ``cuda`` is in the module of the kernel, as numba's simulator demands. Models whose rows have
steps of their own have a kernel of their own, in :mod:`wrinklewave.dynamics.cuda.row_kernels`.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from numba import cuda, float64, uintp

from wrinklewave._jit import choose_cache
from wrinklewave.dynamics.boundary import (
    BOTTOM,
    FORCE,
    FREE,
    LEFT_STRAIGHT,
    N_TOTALS,
    TOP,
    Boundary,
    Nodes,
    drive_position,
    edge_node,
    hold_apart,
    hold_node,
    keep_straight,
    n_edge_nodes,
    remember_node,
    straight_rate,
)
from wrinklewave.dynamics.energy import (
    BEYOND,
    HOURGLASS_AMPLITUDE,
    J_LEAST,
    KINETIC,
    N_COLUMNS,
    kinetic_energy,
    survey_run,
)
from wrinklewave.dynamics.fields import fields_run
from wrinklewave.dynamics.stable_step import stable_step_run
from wrinklewave.dynamics.step import element, move

BLOCK = 256
"""Threads per block on a device, of kernels that add up by halves; they work with fewer, if a power of two."""
START, LAST_DT, DT = range(3)
"""Columns of ``times``: time of the present positions, the step that led to them, the step to take [s]."""


class Tall(NamedTuple):
    """Arrays of the tall mesh, by the names of the processor's :class:`~wrinklewave.dynamics.step.Arrays`.

    ``forces`` [n_tall_rows, 8, n_columns + 2] have a buffer for every row of elements; ``layer``
    [n_tall_rows, n_columns] is counted within a member, whose rows may have layers of their own; ``density``
    [n_batch * n_layers] is that of each material.
    """

    X: Any
    Y: Any
    u: Any
    w: Any
    vx: Any
    vy: Any
    inverse_mass: Any
    moduli: Any
    terms: Any
    factors: Any
    density: Any
    forces: Any
    layer: Any


def kernel(function: Callable[..., Any]) -> Any:
    """Compile when first launched, and keep it on disk."""
    choose_cache(function)
    return cuda.jit(cache=True)(function)


@cuda.jit(device=True)
def _elements(active, members, height, factors, a, memory, terms):
    """Forces of all elements of the first ``active`` members."""
    columns = a.layer.shape[1]
    each = (height - 1) * columns
    n_layers = a.moduli.shape[0] // (a.layer.shape[0] // height)
    for e in range(cuda.grid(1), active * each, cuda.gridsize(1)):
        b = members[e // each]
        j = e % each // columns
        i = e % each - j * columns
        j += b * height
        n = b * n_layers + a.layer[j, i]
        forces, moduli = a.forces[j], a.moduli[n]
        r, c = uintp(j), uintp(i)
        element(r, c, a.X, a.Y, a.u, a.w, a.vx, a.vy, memory, terms, factors[n], moduli, forces)


@cuda.jit(device=True)
def _move(j, i, dt_velocity, dt, a):
    """Move one node freely. Below the first row of elements comes the last: the forces of either are zero."""
    below, above = a.forces[j - 1], a.forces[j]
    move(uintp(j), uintp(i), below, above, a.inverse_mass, dt_velocity, dt, a.u, a.w, a.vx, a.vy)


@cuda.jit(device=True)
def _inner_nodes(step, active, members, height, times, a):
    """Move all nodes but those at the edges; the first blocks, which have the edges, have the fewest of them."""
    columns = a.u.shape[1] - 2
    each = (height - 2) * columns
    for p in range(cuda.gridsize(1) - 1 - cuda.grid(1), active * each, cuda.gridsize(1)):
        k = p // each
        j = p % each // columns
        i = p % each - j * columns
        dt = times[k, DT]
        dt_before = times[k, LAST_DT] if step == 0 else dt
        _move(members[k] * height + 1 + j, 1 + i, 0.5 * (dt_before + dt), dt, a)


@cuda.jit(device=True)
def nodes_of(b, nodes):
    """Nodes of one member."""
    X, Y, inverse_mass = nodes.X[b], nodes.Y[b], nodes.inverse_mass[b]
    return Nodes(X, Y, nodes.u[b], nodes.w[b], nodes.vx[b], nodes.vy[b], inverse_mass)


@cuda.jit(device=True)
def boundary_of(b, of_all):
    """Edge conditions of one member."""
    return Boundary(
        of_all.left[b],
        of_all.right[b],
        of_all.top[b],
        of_all.bottom[b],
        of_all.wall[b],
        of_all.length[b],
        of_all.friction[b],
        of_all.motion[b],
        of_all.motion_across[b],
        of_all.old[b],
        of_all.bins[b],
        of_all.slipping[b],
    )


@cuda.jit(device=True)
def _move_edges(b, dt_velocity, dt, a, nodes, boundary):
    """Remember and move the edge nodes of a member, by one block."""
    own, edges = nodes_of(b, nodes), boundary_of(b, boundary)
    rows, columns = own.u.shape
    for n in range(cuda.threadIdx.x, n_edge_nodes(rows, columns), cuda.blockDim.x):
        j, i = edge_node(n, rows, columns)[2:]
        remember_node(n, own, edges)
        _move(b * rows + j, i, dt_velocity, dt, a)


@cuda.jit(device=True)
def _overhangs(nodes, row, thread, threads):
    for i in range(thread, nodes.u.shape[1] - 1, threads):
        if nodes.X[row, i + 1] + nodes.u[row, i + 1] < nodes.X[row, i] + nodes.u[row, i]:
            return 1
    return 0


@cuda.jit(device=True)
def folds(nodes, boundary, thread, threads):
    """How many free surfaces this thread sees fold; only then can they touch themselves."""
    count = 0
    if boundary.top == FREE:
        count += _overhangs(nodes, nodes.u.shape[0] - 1, thread, threads)
    if boundary.bottom == FREE:
        count += _overhangs(nodes, 0, thread, threads)
    return count


@cuda.jit(device=True)
def _hold_apart(b, dt, nodes, boundary, totals):
    """Contact of a member's free surfaces with themselves, by one thread of its block if there is any."""
    own, edges = nodes_of(b, nodes), boundary_of(b, boundary)
    folded = folds(own, edges, cuda.threadIdx.x, cuda.blockDim.x)
    if cuda.syncthreads_or(folded) and cuda.threadIdx.x == 0:
        for edge in range(BOTTOM, TOP + 1):
            hold_apart(edge, dt, own, edges, totals[b, 0 if edge == BOTTOM else own.u.shape[0] - 1])


@cuda.jit(device=True)
def _hold(b, t, dt, nodes, boundary, totals):
    """Conditions at the edges of a member at time ``t``, by one block."""
    own, edges = nodes_of(b, nodes), boundary_of(b, boundary)
    drive = drive_position(t, dt, edges)
    for n in range(cuda.threadIdx.x, totals.shape[1], cuda.blockDim.x):
        totals[b, n, FORCE] = 0.0
        hold_node(n, drive, dt, own, edges, totals[b, n])


@cuda.jit(device=True)
def _keep_straight(b, dt, nodes, boundary):
    own, edges = nodes_of(b, nodes), boundary_of(b, boundary)
    rate = straight_rate(own)
    cuda.syncthreads()
    for j in range(cuda.threadIdx.x, own.u.shape[0], cuda.blockDim.x):
        keep_straight(j, rate, dt, own, edges)


@cuda.jit(device=True)
def _edges(step, active, members, times, a, nodes, boundary, totals):
    """Move the edge nodes and see to their conditions, a block for each member.

    Each part finds the member's arrays anew: to keep them at hand from one to the next takes registers.
    """
    for k in range(cuda.blockIdx.x, active, cuda.gridDim.x):
        b, dt = members[k], times[k, DT]
        dt_before = times[k, LAST_DT] if step == 0 else dt
        _move_edges(b, 0.5 * (dt_before + dt), dt, a, nodes, boundary)
        if boundary.bins.shape[3] > 0:
            cuda.syncthreads()
            _hold_apart(b, dt, nodes, boundary, totals)
            cuda.syncthreads()
        _hold(b, times[k, START] + (step + 1) * dt, dt, nodes, boundary, totals)
        if boundary.left[b] == LEFT_STRAIGHT:
            cuda.syncthreads()
            _keep_straight(b, dt, nodes, boundary)


@cuda.jit(device=True)
def clear(members, totals, thread, threads):
    """What the edges of the members of a launch have gathered is nothing before its first step."""
    n_edge = totals.shape[1]
    for q in range(thread, members.shape[0] * n_edge, threads):
        for total in range(N_TOTALS):
            totals[members[q // n_edge], q % n_edge, total] = 0.0


@kernel
def steps(n, members, times, first_factors, a, memory, terms, nodes, boundary, totals):
    """Take ``n[k]`` steps with each member, those with the most coming first; ``times`` are [n_members, 3].

    The Prony coefficients of the first step, ``first_factors``, follow on a step of another length than the rest.
    ``nodes`` are those of ``a`` by member, [n_batch, height, n_columns + 1]; ``totals`` [n_batch, n_edge_nodes,
    N_TOTALS] are gathered node by node.
    """
    grid = cuda.cg.this_grid()
    height, active = nodes.u.shape[1], members.shape[0]
    clear(members, totals, cuda.grid(1), cuda.gridsize(1))
    for step in range(n[0]):
        while n[active - 1] <= step:
            active -= 1
        factors = first_factors if step == 0 else a.factors
        _elements(active, members, height, factors, a, memory, terms)
        grid.sync()
        _edges(step, active, members, times, a, nodes, boundary, totals)
        _inner_nodes(step, active, members, height, times, a)
        grid.sync()


@cuda.jit(device=True)
def _combined(column, x, y):
    """Two sums, or extremes, as one; NaN if either is."""
    if column < HOURGLASS_AMPLITUDE or column == KINETIC or x != x or y != y:
        return x + y
    return min(x, y) if column == J_LEAST else max(x, y)


@cuda.jit(device=True)
def _total(column, value, shared):
    """The block's values as one, in a fixed order; for all threads."""
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
def _sum_up_row(j, first_layer, dt, a, memory, terms, shared, sums):
    """Sums of row ``j`` of elements by one block, in an order that the size of the grid does not change.

    The contributions of the elements lie where their forces were: the next step computes those anew.
    """
    thread, threads, columns = cuda.threadIdx.x, cuda.blockDim.x, a.layer.shape[1]
    work = a.forces[j][:, 1:-1]
    for i in range(thread, columns, threads):
        survey_run(j, i, i + 1, first_layer + a.layer[j, i], dt, a, memory, terms, work)
    for column in range(N_COLUMNS):
        value = BEYOND if column == J_LEAST else 0.0
        for i in range(thread, columns, threads):
            value = _combined(column, value, work[column, i])
        sums[column] = _total(column, value, shared)


@kernel
def sample(members, times, a, memory, terms, totals, sums, edges):
    """The present state in numbers: ``sums`` [n_members, height, N_SUMS] by rows, and of the ``edges``
    [n_members, N_TOTALS + 2] what they have gathered, and the displacement of the struck end's top corner.
    """
    shared = cuda.shared.array(0, float64)  # as much as the launch asks for
    thread, threads = cuda.threadIdx.x, cuda.blockDim.x
    n_batch, n_edge, columns = totals.shape[0], totals.shape[1], a.layer.shape[1]
    height, n_layers = a.layer.shape[0] // n_batch, a.moduli.shape[0] // n_batch
    for q in range(cuda.blockIdx.x, members.shape[0] * height, cuda.gridDim.x):
        k = q // height
        r = q - k * height
        b = members[k]
        j = b * height + r
        value = 0.0
        for i in range(thread, columns + 1, threads):
            value += kinetic_energy(a.inverse_mass[j, i], a.vx[j, i], a.vy[j, i])
        sums[k, r, KINETIC] = _total(KINETIC, value, shared)
        if r < height - 1:
            _sum_up_row(j, b * n_layers, times[k, DT], a, memory, terms, shared, sums[k, r])
            continue
        for total in range(N_TOTALS):
            value = 0.0
            for n in range(thread, n_edge, threads):
                value += totals[b, n, total]
            edges[k, total] = _total(KINETIC, value, shared)
        edges[k, N_TOTALS], edges[k, N_TOTALS + 1] = a.u[j, 0], a.w[j, 0]


@kernel
def stable_steps(n_batch, members, a, out, least):
    """Largest stable step of each element [s], ``out`` [n_tall_rows, n_columns], and the ``least`` of each row
    [n_members, height - 1].
    """
    shared = cuda.shared.array(0, float64)  # as much as the launch asks for
    thread, threads, columns = cuda.threadIdx.x, cuda.blockDim.x, a.layer.shape[1]
    height, n_layers, rows = a.layer.shape[0] // n_batch, a.moduli.shape[0] // n_batch, least.shape[1]
    for q in range(cuda.blockIdx.x, members.shape[0] * rows, cuda.gridDim.x):
        k = q // rows
        r = q - k * rows
        b = members[k]
        j = b * height + r
        value = BEYOND
        for i in range(thread, columns, threads):
            stable_step_run(j, i, i + 1, b * n_layers + a.layer[j, i], a, a.density, out)
            value = _combined(J_LEAST, value, out[j, i])
        least[k, r] = _total(J_LEAST, value, shared)


@kernel
def snapshot(a, memory, terms, nodal, elements):
    """The present state of one member, whose rows alone all arguments have: ``nodal`` [4, ...] u, w, vx, vy, and the
    fields, ``elements`` [len(FIELDS), ...].
    """
    rows, columns = elements.shape[1:]
    for e in range(cuda.grid(1), rows * columns, cuda.gridsize(1)):
        j = e // columns
        i = e - j * columns
        fields_run(j, i, i + 1, a.layer[j, i], a, memory, terms, elements)
    rows, columns = a.u.shape
    for p in range(cuda.grid(1), rows * columns, cuda.gridsize(1)):
        j = p // columns
        i = p - j * columns
        nodal[0, j, i], nodal[1, j, i] = a.u[j, i], a.w[j, i]
        nodal[2, j, i], nodal[3, j, i] = a.vx[j, i], a.vy[j, i]
