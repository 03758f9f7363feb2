"""The package's own kernels, as a contender: its stepping as it is, and its element kernel alone."""

from __future__ import annotations

from dataclasses import dataclass

import numba
import numpy as np

from benchmarks.problem import Problem
from wrinklewave.dynamics.boundary import N_TOTALS
from wrinklewave.dynamics.step import advance, element_row, separate


@numba.njit(error_model="numpy", nogil=True, _nrt=False)
def _all_element_rows(n_steps, a, memory, terms):
    rows, columns = memory[0].shape
    factors, moduli = a.factors[0], a.moduli[0]
    for _ in range(n_steps):
        for j in range(rows):
            above = separate(a.forces[0, j % 2])
            element_row(j, 0, columns, a.x, a.y, a.u, a.w, a.vx, a.vy, memory, terms, factors, moduli, above)


@dataclass(eq=False)
class NumbaVersion:
    """A problem as the package steps it, in place."""

    problem: Problem
    threads: int = 1

    def __post_init__(self) -> None:
        self._arrays = self.problem.arrays(self.threads)
        self._totals = np.zeros(N_TOTALS)

    def kernel(self, n_steps: int) -> None:
        """Forces of all elements, ``n_steps`` times."""
        m = self.problem.model
        _all_element_rows(n_steps, self._arrays, m.memory_rows, m.terms)

    def advance(self, n_steps: int, t: float = 0.0) -> None:
        """Take whole steps from time ``t`` [s]."""
        p, m = self.problem, self.problem.model
        advance(n_steps, t, p.dt, p.dt, self._arrays, m.memory_rows, m.terms, p.boundary, self._totals)
