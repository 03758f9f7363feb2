"""Sub-cycling: each row of elements has a step of its own, so that a stiff film does not set that of its substrate.

An asynchronous variational integrator (Lew, Marsden, Ortiz & West 2003): a row of elements exerts its forces on its
nodes as impulses, one in each of its own steps, and between two impulses nodes move at constant velocity. Whole number
ratios bring all rows together after every large step. Steps shrink upwards only, so a row of nodes moves with the step
of the elements above it, and the rows that are due at a time are the uppermost ones.

Threads take contiguous rows, as in :mod:`wrinklewave.dynamics.step`; a thread waits for its neighbour only when the
last row of the lower share is due. That row is computed first, so that the upper share can go on.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import serial, strict
from wrinklewave.dynamics.barrier import LINE, store, wait_for
from wrinklewave.dynamics.boundary import (
    Boundary,
    Nodes,
    hold_rows,
    remember_rows,
)
from wrinklewave.dynamics.step import (
    BORDER,
    KNOWN,
    MOVED,
    Arrays,
    border_of,
    forces_of_row,
    move_row,
    share_out_steps,
    update_factors,
)

SCALED = 2
"""Buffer of forces that come from a row with another step; 0 and 1 take turns."""
MOST = 16
"""Steps of the fastest row during one of the slowest."""


class RowSteps(NamedTuple):
    """What is known of a state whose rows have steps of their own, beside the :class:`Arrays`.

    ``last`` [n_rows] are the steps that led to it [s]; ``vx, vy`` [n_rows + 1, n_columns + 1] the mean velocities of
    the last large step [m/s]: those in the arrays are of the middle of each row's own step, just before the next
    impulse, and so not their mean.
    """

    last: np.ndarray
    vx: np.ndarray
    vy: np.ndarray

    @classmethod
    def at_rest(cls, a: Arrays) -> RowSteps:
        """Before the first step."""
        return cls(np.zeros(a.u.shape[0] - 1), np.zeros_like(a.vx), np.zeros_like(a.vy))


def with_layers_of_rows(a: Arrays) -> Arrays:
    """The same, with the layers once for every row, whose Prony coefficients follow its step."""
    n_rows, n_layers = a.first_run.size - 1, a.moduli.shape[0]
    runs = a.runs.copy()
    runs[:, 2] += n_layers * np.repeat(np.arange(n_rows), np.diff(a.first_run))
    by_layer = {name: np.concatenate([getattr(a, name)] * n_rows) for name in ("moduli", "terms", "factors")}
    return a._replace(runs=runs, **by_layer)


def seen_over(step: float, a: Arrays) -> Arrays:
    """The same, with Prony coefficients that lead back by a large ``step`` [s], as a survey of it needs them.

    H = Z + b s is that of each row's own step; it began as (Z + b s)/a with the decay a over the large one, to the
    second order in it.
    """
    factors = a.factors.copy()
    factors[:, :, 1] = np.exp(-step / a.terms[:, :, 2])
    return a._replace(factors=factors)


class Plan(NamedTuple):
    """``step`` [s] of the slowest row, and how many steps each row takes in the meantime, ``counts`` [n_rows]."""

    step: float
    counts: np.ndarray


def plan(stable: np.ndarray) -> Plan:
    """The steps that cost least, from the largest that are stable for each row, ``stable`` [n_rows] [s].

    Steps are powers of two times the smallest, shrink upwards, and at most by half from row to row: forces that come
    at long intervals stir the nodes that take short steps, and the rows between keep that from the film.
    """
    bounds = np.minimum.accumulate(stable)
    halved = bounds[:, None] / 2.0 ** np.arange(np.log2(MOST) + 1)
    smallest = bounds[-1]
    candidates = np.unique(halved[(halved <= smallest) & (halved > 0.5 * smallest)])
    plans = [_with_smallest(step, bounds) for step in candidates]
    return min(plans, key=lambda p: p.counts.sum() / p.step)


def _with_smallest(step: float, bounds: np.ndarray) -> Plan:
    ratios = 2 ** np.minimum(np.log2(bounds / step * (1 + 1e-12)), np.log2(MOST)).astype(np.int64)
    for j in range(bounds.size - 2, -1, -1):
        ratios[j] = min(ratios[j], 2 * ratios[j + 1])
    return Plan(step * ratios[0], ratios[0] // ratios)


@serial
def _scale(forces, ratio, out):
    for k in range(forces.shape[0]):
        for i in range(forces.shape[1]):
            out[k, i] = ratio * forces[k, i]


@serial
def _gather(first, stop, weight, v, mean):
    for j in range(first, stop):
        for i in range(v.shape[1]):
            mean[j, i] += weight * v[j, i]


@strict
def _move_row(j, below, above, a, interval, dt):
    move_row(j, below, above, a.inverse_mass, interval, dt, a.u, a.w, a.vx, a.vy)


@strict
def is_due(j, tick, period):
    """Whether element row ``j`` takes a step at a ``tick``, a step of the fastest row."""
    return tick % period[j] == 0


@strict
def impulse_time(j, tick, dt, period, last):
    """Time that an impulse of element row ``j`` stands for: half of its last step and half of the next."""
    step = dt * period[j]
    return 0.5 * ((last[j] if tick == 0 else step) + step)


@strict
def _update_factors(j, tick, dt, period, last, a):
    """Prony coefficients of row ``j``, whose layers are its own."""
    step, n_layers = dt * period[j], a.terms.shape[0] // period.size
    own, end = j * n_layers, (j + 1) * n_layers
    update_factors(a.terms[own:end], last[j] if tick == 0 else step, step, a.factors[own:end])


@serial
def update_factors_of_rows(step, n_ticks, dt, period, last, a):
    """Prony coefficients of each row for its own ``step`` of a march: 0 is the first, 1 stands for all others.

    A row that takes one step only keeps those of its first.
    """
    for j in range(period.size):
        tick = step * period[j]
        if tick < n_ticks:
            _update_factors(j, tick, dt, period, last, a)


@strict
def _buffer(j, part, a):
    """Buffer of element row j of a share."""
    return BORDER if j == border_of(part, a) else j % 2


@strict
def _move_due_row(j, part, start, tick, dt, period, last, a):
    """Move the row of nodes below element row j, of which rows from ``start`` on are due."""
    interval = impulse_time(j, tick, dt, period, last)
    below, before = a.nothing, interval
    if j > start:
        below, before = a.forces[part, (j - 1) % 2], impulse_time(j - 1, tick, dt, period, last)
    elif j == a.shares[part] and part > 0 and is_due(j - 1, tick, period):
        wait_for(a.counts[KNOWN], part - 1, tick + 1)
        below, before = a.forces[part - 1, BORDER], impulse_time(j - 1, tick, dt, period, last)
    if before != interval:
        _scale(below, before / interval, a.forces[part, SCALED])
        below = a.forces[part, SCALED]
    _move_row(j, below, a.forces[part, _buffer(j, part, a)], a, interval, dt * period[j])


@serial
def _advance_share(part, start, tick, dt, period, last, a, memory, terms):
    """Rows of a share that are due at ``tick``, from ``start`` on: forces, and the nodes below each moved.

    The border comes first. Forces are called for in one place: a second one could be compiled to other roundings.
    """
    stop, n_rows, border = a.shares[part + 1], period.size, border_of(part, a)
    if border >= 0:
        wait_for(a.counts[MOVED], part + 1, tick)
    for n in range(start, stop):
        j = n if border < 0 else border if n == start else n - 1
        forces_of_row(j, a, memory, terms, a.forces[part, _buffer(j, part, a)])
        if j == border:
            store(a.counts[KNOWN], part * LINE, tick + 1)
        else:
            _move_due_row(j, part, start, tick, dt, period, last, a)
    if border >= 0:
        _move_due_row(border, part, start, tick, dt, period, last, a)
    if stop == n_rows:
        interval = impulse_time(stop - 1, tick, dt, period, last)
        _move_row(n_rows, a.forces[part, (stop - 1) % 2], a.nothing, a, interval, dt * period[stop - 1])


@serial
def _hold_share(start, stop, t, tick, last_tick, dt, period, nodes, boundary, totals):
    """Conditions at the edges of the rows of nodes that have moved; rows of one step together."""
    j, n_rows = start, period.size
    while j < stop:
        k = j + 1
        while k < stop and period[k] == period[j]:
            k += 1
        step, then, end = dt * period[j], tick + period[j], k + 1 if k == n_rows else k
        hold_rows(j, end, t + then * dt, step, nodes, boundary, totals, then == last_tick)
        j = k


@serial
def march(part, n_steps, t, dt, period, last, a, memory, terms, boundary, mean_vx, mean_vy, totals):
    """Take all steps of one share. ``dt`` is the smallest; row j of elements is due every ``period[j]`` of them."""
    n_rows, most = period.size, period[0]
    first, stop = a.shares[part], a.shares[part + 1]
    stop_nodes = stop + 1 if stop == n_rows else stop
    nodes = Nodes(a.X, a.Y, a.u, a.w, a.vx, a.vy, a.inverse_mass)
    for tick in range(n_steps * most):
        start = first
        while start < stop and not is_due(start, tick, period):
            start += 1
        if start == stop:
            continue
        for j in range(start, stop):
            if tick < 2 * period[j]:
                _update_factors(j, tick, dt, period, last, a)
        remember_rows(start, stop_nodes, nodes, boundary)
        _advance_share(part, start, tick, dt, period, last, a, memory, terms)
        _hold_share(start, stop, t, tick, n_steps * most, dt, period, nodes, boundary, totals)
        if tick >= (n_steps - 1) * most:
            for j in range(start, stop_nodes):
                weight = period[min(j, n_rows - 1)] / most
                _gather(j, j + 1, weight, a.vx, mean_vx)
                _gather(j, j + 1, weight, a.vy, mean_vy)
        if start == first:
            store(a.counts[MOVED], part * LINE, tick + period[first])


def advance(
    n_steps: int,
    t: float,
    plan: Plan,
    state: RowSteps,
    a: Arrays,
    memory: tuple[np.ndarray, ...],
    terms: tuple[float, ...],
    boundary: Boundary,
    totals: np.ndarray,
) -> None:
    """Take ``n_steps`` large steps from time ``t`` [s], in place, a thread for each share.

    As :func:`wrinklewave.dynamics.step.advance`, for arrays whose rows have layers of their own.
    """
    most = int(plan.counts[-1])
    dt, period = plan.step / most, most // plan.counts
    if n_steps > 0:
        state.vx[:], state.vy[:] = 0.0, 0.0
    numbers = (n_steps, t, dt, period, state.last)
    share_out_steps(march, a, totals, *numbers, a, memory, terms, boundary, state.vx, state.vy)
    if n_steps > 0:
        state.last[:] = dt * period
