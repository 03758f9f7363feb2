"""Band matrices against the same equations written in full."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray

from wrinklewave.imaging.edges.banded import Band, factorise, inverse_diagonal, normal_equations, solve

M = 60
RNG = np.random.default_rng(7)
WEIGHTS, VALUES = 0.5 + RNG.random(M), RNG.normal(size=M)


def in_full(matrix: Band, n: int) -> NDArray[np.float64]:
    full = np.diag(matrix.diagonal[:n])
    for k in range(min(matrix.beyond.shape[1], n - 1)):
        full += np.diag(matrix.beyond[: n - k - 1, k], k + 1) + np.diag(matrix.beyond[: n - k - 1, k], -k - 1)
    return full


@pytest.mark.parametrize("width", [1, 5, 9, 21])
def test_least_squares_are_those_of_full_matrices(width: int) -> None:
    parts = RNG.random((width, M))
    n = M + width - 1
    operator = np.zeros((M, n))
    for i in range(M):
        operator[i, i : i + width] = parts[:, i]
    matrix, right = normal_equations(WEIGHTS, VALUES, parts, 8)
    matrix.diagonal[:n] += 0.1  # n unknowns, M equations
    full = operator.T @ (WEIGHTS[:, None] * operator) + 0.1 * np.eye(n)
    np.testing.assert_allclose(in_full(matrix, n), full, atol=1e-13)
    np.testing.assert_allclose(right, operator.T @ (WEIGHTS * VALUES), atol=1e-13)
    factorise(matrix)
    np.testing.assert_allclose(solve(matrix, right), np.linalg.solve(full, right), atol=1e-10)
    np.testing.assert_allclose(inverse_diagonal(matrix), np.diag(np.linalg.inv(full)), rtol=1e-10)
