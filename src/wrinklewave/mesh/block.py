"""Grid meshes of a block: rows and columns of quadrilaterals, graded, in layers of different materials."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class GridMesh:
    """A mapped grid of quadrilaterals; rows run along x, row 0 at the bottom.

    Args:
        X: undeformed node positions along the film [m], shape [n_rows + 1, n_columns + 1].
        Y: undeformed node positions across it [m], same shape.
        layer: index of each element's material, shape [n_rows, n_columns].
    """

    X: NDArray[np.float64]
    Y: NDArray[np.float64]
    layer: NDArray[np.int64]

    @property
    def shape(self) -> tuple[int, int]:
        """Rows and columns of elements."""
        return self.X.shape[0] - 1, self.X.shape[1] - 1

    @property
    def n_elements(self) -> int:
        return self.shape[0] * self.shape[1]

    def areas(self) -> NDArray[np.float64]:
        """Undeformed element areas [m²], shape [n_rows, n_columns]; not positive where an element is inverted."""
        X, Y = self.X, self.Y
        x13, y13 = X[1:, 1:] - X[:-1, :-1], Y[1:, 1:] - Y[:-1, :-1]
        x24, y24 = X[1:, :-1] - X[:-1, 1:], Y[1:, :-1] - Y[:-1, 1:]
        return 0.5 * (x13 * y24 - x24 * y13)


def graded(start: float, stop: float, n: int, ratio: float = 1.0) -> NDArray[np.float64]:
    """``n + 1`` points from ``start`` to ``stop``: geometric intervals, the last ``ratio`` times the first."""
    if n == 1 or ratio == 1.0:
        return np.linspace(start, stop, n + 1)
    intervals = ratio ** (np.arange(n) / (n - 1))
    points = np.concatenate([[0.0], np.cumsum(intervals)]) / intervals.sum()
    return start + (stop - start) * points


def block(
    *,
    length: float,
    bottom: float,
    top: float,
    elements: tuple[int, int],
    grading: tuple[float, float] = (1.0, 1.0),
) -> GridMesh:
    """A rectangular block 0 <= x <= length, bottom <= y <= top [m] of one material."""
    x = graded(0.0, length, elements[0], grading[0])
    y = graded(bottom, top, elements[1], grading[1])
    X, Y = np.meshgrid(x, y)
    return GridMesh(X=X, Y=Y, layer=np.zeros(elements[::-1], dtype=np.int64))
