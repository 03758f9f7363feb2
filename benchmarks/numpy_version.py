"""The same step as plain NumPy does it, whole arrays at a time: the formulas of the package uncompiled."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from benchmarks.problem import Problem
from wrinklewave.dynamics.boundary import N_TOTALS, Nodes, hold_rows, n_edge_nodes, remember_rows
from wrinklewave.dynamics.elements import one_point, quadrilateral
from wrinklewave.materials import neo_hookean, prony


def _uncompiled(*functions: Any) -> tuple[Any, ...]:
    return tuple(function.py_func for function in functions)


differences, twice_area, twice_area_rate, gradient = _uncompiled(
    quadrilateral.opposite_differences,
    quadrilateral.twice_area,
    quadrilateral.twice_area_rate,
    quadrilateral.centre_gradient,
)
right_cauchy_green, isochoric_shape, first_piola_kirchhoff = _uncompiled(
    neo_hookean.right_cauchy_green, neo_hookean.isochoric_shape, neo_hookean.first_piola_kirchhoff
)
hourglass_stiffness, nodal_forces = _uncompiled(one_point.hourglass_stiffness, one_point.nodal_forces)
overstress, next_memory = _uncompiled(prony.overstress, prony.memory)


def corners(field: np.ndarray) -> tuple[np.ndarray, ...]:
    """Values at the corners 1 to 4 of every element."""
    return field[:-1, :-1], field[:-1, 1:], field[1:, 1:], field[1:, :-1]


@dataclass(eq=False)
class NumpyVersion:
    """A problem as NumPy steps it, in place: one material with one Prony term whose bulk does not relax."""

    problem: Problem

    def kernel(self, n_steps: int) -> None:
        """Forces of all elements, ``n_steps`` times."""
        for _ in range(n_steps):
            self._forces()

    def advance(self, n_steps: int, t: float = 0.0) -> None:
        """Take whole steps from time ``t`` [s]."""
        a, boundary, dt = self.problem.model.arrays, self.problem.boundary, self.problem.dt
        nodes = Nodes(a.X, a.Y, a.u, a.w, a.vx, a.vy, a.inverse_mass)
        rows, columns = a.u.shape
        totals = np.zeros((n_edge_nodes(rows, columns), N_TOTALS))
        for n in range(n_steps):
            remember_rows(0, rows, nodes, boundary)
            for v, x, force in zip((a.vx, a.vy), (a.u, a.w), self._forces(), strict=True):
                gathered = np.zeros((rows, columns))
                for at_node, of_element in zip(corners(gathered), force, strict=True):
                    at_node += of_element
                v -= dt * a.inverse_mass * gathered
                x += dt * v
            hold_rows(0, rows, t + (n + 1) * dt, dt, nodes, boundary, totals, n == n_steps - 1)

    def _forces(self) -> tuple[tuple[np.ndarray, ...], tuple[np.ndarray, ...]]:
        """Forces along x and across on the corners of every element; the memory goes to the next step."""
        a = self.problem.model.arrays
        mu, K, linear, quadratic, hourglass = a.moduli[0]
        x13, x24, hX = differences(*corners(a.X))
        y13, y24, hY = differences(*corners(a.Y))
        u13, u24, qx = differences(*corners(a.u))
        w13, w24, qy = differences(*corners(a.w))
        vx13, vx24, _ = differences(*corners(a.vx))
        vy13, vy24, _ = differences(*corners(a.vy))
        A2 = twice_area(x13, y13, x24, y24)
        inverse = 1.0 / A2
        rate = twice_area_rate(x13 + u13, y13 + w13, x24 + u24, y24 + w24, vx13, vy13, vx24, vy24)
        G11, G12 = gradient(x13, y13, x24, y24, inverse, u13, u24)
        G21, G22 = gradient(x13, y13, x24, y24, inverse, w13, w24)
        qx, qy = qx - (hX * G11 + hY * G12), qy - (hX * G21 + hY * G22)
        F11, F22 = 1.0 + G11, 1.0 + G22
        e = G11 + G22 + G11 * G22 - G12 * G21
        root = 1.0 / np.cbrt(1.0 + e)
        J23 = root * root
        Ji = J23 * root
        C11, C22, C12 = right_cauchy_green(F11, G12, G21, F22)
        shapes = (*isochoric_shape(C11, C22, C12, Ji * Ji), F11 * qx + G21 * qy, G12 * qx + F22 * qy)
        H11, H22, H12, H33, Q1, Q2 = self._remember(shapes)
        A11, A22, A12, A33 = (mu * s + H for s, H in zip(shapes[:4], (H11, H22, H12, H33), strict=True))
        d13, d24 = x13 * x13 + y13 * y13, x24 * x24 + y24 * y24
        L2 = 0.5 * A2 * A2 / np.maximum(d13, d24)
        rate = rate * inverse * Ji
        p = K * e + linear * np.sqrt(L2) * rate - quadratic * L2 * np.minimum(rate, 0.0) ** 2
        P11, P12, P21, P22 = first_piola_kirchhoff(
            F11, G12, G21, F22, A11, A22, A12, A33, C11, C22, C12, 0.5 * J23, Ji, 0.5 * p
        )
        k = hourglass_stiffness(x13, y13, x24, y24, inverse, hourglass)
        Qx = k * (mu * qx + Ji * (F22 * Q1 - G21 * Q2))
        Qy = k * (mu * qy + Ji * (F11 * Q2 - G12 * Q1))
        diagonals = x13, y13, x24, y24, inverse
        return nodal_forces(*diagonals, P11, P12, hX, hY, Qx), nodal_forces(*diagonals, P21, P22, hX, hY, Qy)

    def _remember(self, shapes: tuple[np.ndarray, ...]) -> list[np.ndarray]:
        """Overstress of every component."""
        b, decay, b_next = self.problem.model.arrays.factors[0, 0, :3]
        found = []
        for Z, shape in zip(self.problem.model.memory, shapes, strict=True):
            H = overstress(Z, b, shape)
            Z[:] = next_memory(H, decay, b_next, shape)
            found.append(H)
        return found
