"""Symmetric positive definite equations with a band matrix: factors, solution, diagonal of the inverse.

All inner loops run over ``LANES`` neighbouring numbers, which makes each of them a single vector instruction or two;
for that the band is widened to a multiple of ``LANES``.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating, serial, uintp, vector
from wrinklewave.imaging.arrays import Floats

LANES = 8
_ONE, _LANES = uintp(1), uintp(LANES)


class Band(NamedTuple):
    """A symmetric band matrix of n rows, or its factors L D L'.

    Attributes:
        diagonal: shape [n + band]; of factors, D.
        beyond: entries [i, i + 1 + k], zeros beyond the matrix, shape [n + band, band]; of factors, those of L'.
    """

    diagonal: Floats
    beyond: Floats


@allocating
def normal_equations(weights: Floats, values: Floats, parts: Floats, band: int) -> tuple[Band, Floats]:
    """Matrix and right side of the least squares problem sum_i w_i (v_i - sum_j p_ji x_(i + j))^2.

    Args:
        weights, values: w and v, shape [m].
        parts: p, shape [width, m].
        band: widest that will be added to the matrix.

    Returns:
        a matrix of m + width - 1 rows; the right side, shape [m + width - 1].
    """
    width, m = parts.shape
    n, widened = m + width - 1, (max(band, width - 1) + LANES - 1) // LANES * LANES
    diagonals, right = np.zeros((width, n)), np.zeros(n)
    weighted = np.empty(m)
    for j in range(width):
        _multiply(weights, parts[j], weighted)
        add_product(weighted, values, right[j : j + m])
        for k in range(width - j):
            add_product(weighted, parts[j + k], diagonals[k, j : j + m])
    matrix = Band(np.zeros(n + widened), np.zeros((n + widened, widened)))
    matrix.diagonal[:n] = diagonals[0]
    _transpose(diagonals[1:], matrix.beyond)
    return matrix, right


@vector
def _multiply(a: Floats, b: Floats, product: Floats) -> None:
    for i in range(product.size):
        product[i] = a[i] * b[i]


@vector
def add_product(a: Floats, b: Floats, total: Floats) -> None:
    """Add a b, number by number."""
    for i in range(total.size):
        total[i] += a[i] * b[i]


@vector
def _transpose(rows: Floats, columns: Floats) -> None:
    for i in range(uintp(rows.shape[1])):
        for k in range(uintp(rows.shape[0])):
            columns[i, k] = rows[k, i]


@allocating
def factorise(matrix: Band) -> None:
    """The ``matrix`` becomes its factors L D L'."""
    _eliminate(matrix.diagonal, matrix.beyond, np.zeros(2 * matrix.beyond.shape[1]))


@allocating
def solve(factors: Band, right: Floats) -> Floats:
    """Solution, shape [n], for a right side [n]."""
    x = np.zeros(factors.diagonal.size)
    x[: right.size] = right
    _substitute_forwards(factors.beyond, x)
    x[: right.size] /= factors.diagonal[: right.size]
    _substitute_backwards(factors.beyond, x)
    return x[: right.size]


@allocating
def inverse_diagonal(factors: Band) -> Floats:
    """Diagonal of the inverse, shape [n]."""
    rows, band = factors.beyond.shape
    inverse = np.zeros((rows, 2 * band + 1))
    _invert(factors.diagonal, factors.beyond, inverse, np.empty(band))
    return inverse[: rows - band, band].copy()


@vector
def _eliminate(diagonal: Floats, beyond: Floats, row: Floats) -> None:
    """L D L' in place; ``row`` begins with a row of D L' and ends with zeros."""
    band = uintp(beyond.shape[1])
    for i in range(uintp(diagonal.size) - band):
        for k in range(band):
            row[k] = beyond[i, k]
        inverse = 1.0 / diagonal[i]
        for a in range(band):
            factor, r = row[a] * inverse, i + a + _ONE
            beyond[i, a] = factor
            diagonal[r] -= factor * row[a]
            for block in range(uintp(0), band - a, _LANES):
                for lane in range(_LANES):
                    beyond[r, block + lane] -= factor * row[a + _ONE + block + lane]


@serial
def _substitute_forwards(beyond: Floats, x: Floats) -> None:
    """x becomes L^-1 x; what was found last enters last, so that rows overlap in the processor."""
    band = uintp(beyond.shape[1])
    for i in range(uintp(1), uintp(beyond.shape[0]) - band):
        total = x[i]
        reach = min(i, band)
        for k in range(reach):
            r = i - reach + k
            total -= beyond[r, reach - _ONE - k] * x[r]
        x[i] = total


@serial
def _substitute_backwards(beyond: Floats, x: Floats) -> None:
    """x becomes L'^-1 x, likewise."""
    band = uintp(beyond.shape[1])
    n = uintp(beyond.shape[0]) - band
    for j in range(n):
        i = n - _ONE - j
        total = x[i]
        for b in range(band):
            total -= beyond[i, band - _ONE - b] * x[i + band - b]
        x[i] = total


@vector
def _invert(diagonal: Floats, beyond: Floats, inverse: Floats, row: Floats) -> None:
    """Takahashi's recurrence within the band: inverse[i, band + k] = Z[i, i + k], k from -band to band.

    Z[i, j] = delta_ij / D_i - sum_(m > i) L_mi Z[m, j] for j >= i.
    """
    band = uintp(beyond.shape[1])
    n = uintp(diagonal.size) - band
    for j in range(n):
        i = n - _ONE - j
        for k in range(band):
            row[k] = 0.0
        for m in range(band):
            for block in range(uintp(0), band, _LANES):
                for lane in range(_LANES):
                    row[block + lane] -= beyond[i, m] * inverse[i + m + _ONE, band - m + block + lane]
        total = 1.0 / diagonal[i]
        for k in range(band):
            total -= beyond[i, k] * row[k]
            inverse[i, band + _ONE + k] = row[k]
            inverse[i + _ONE + k, band - _ONE - k] = row[k]
        inverse[i, band] = total
