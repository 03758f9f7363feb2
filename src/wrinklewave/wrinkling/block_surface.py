"""How stiff a block's surface is along itself: what a film on it has to push against.

The block is linear, isotropic, in plane strain, 0 <= X <= length, on a plane of symmetry at its base, bonded at
X = length, with a free top and a struck end X = 0 that slips along its plate or is free. Small elements of it give
the stiffness; everything but the motion along X of the top and of the struck end is eliminated.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

LAYERS = 20
GRADING = 8.0
"""Ratio of the thickest to the thinnest layer of elements, at the surface."""
CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


@dataclass(frozen=True)
class BlockSurface:
    """Stiffness of a block's surface to motions along X, in units of its plane-strain modulus.

    Args:
        nodes: undeformed positions along the top, the bonded one included [m], shape [n_cells + 1].
        stiffness: forces per width on the moving nodes of the top, corner first, then of the struck end below it,
            per displacement of them and per modulus, shape [n_moving, n_moving].
        end: which of the moving nodes are on the struck end, shape [n_moving].
        shortening: compressive strain of the cells per displacement of the moving nodes [1/m], shape
            [n_cells, n_moving].
    """

    nodes: Array
    stiffness: Array
    end: NDArray[np.bool_]
    shortening: Array

    @property
    def centres(self) -> Array:
        """Undeformed positions of the cells' centres [m], shape [n_cells]."""
        return 0.5 * (self.nodes[1:] + self.nodes[:-1])

    @property
    def cell(self) -> float:
        """Length of a cell [m]."""
        return float(self.nodes[1] - self.nodes[0])


def block_surface(*, length: float, depth: float, nu: float, n_cells: int) -> BlockSurface:
    """Condense the stiffness of a block to its surface.

    Args:
        length, depth: of the block, from its surface to the plane of symmetry [m].
        nu: Poisson's ratio.
        n_cells: along the surface.
    """
    from scipy.sparse.linalg import splu

    K, node = _assembled(length, depth, nu, n_cells)
    moving = 2 * np.concatenate([node[:-1, -1], node[0, :-1]])
    held = np.concatenate([2 * node[-1], 2 * node[-1] + 1, 2 * node[:, 0] + 1])
    inner = np.setdiff1d(np.arange(K.shape[0]), np.concatenate([moving, held]))
    coupling = K[inner][:, moving].toarray()
    condensed = K[moving][:, moving].toarray() - coupling.T @ splu(K[inner][:, inner]).solve(coupling)

    cell, each = length / n_cells, np.arange(n_cells)
    shortening = np.zeros((n_cells, moving.size))
    shortening[each, each] = 1.0 / cell
    shortening[each[:-1], each[1:]] = -1.0 / cell
    end = np.zeros(moving.size, dtype=bool)
    end[0], end[n_cells:] = True, True
    return BlockSurface(
        np.linspace(0.0, length, n_cells + 1), 0.5 * (condensed + condensed.T), end, shortening
    )


def _assembled(length: float, depth: float, nu: float, n_cells: int):  # type: ignore[no-untyped-def]
    """Stiffness matrix (sparse), and the numbers of its nodes, shape [n_cells + 1, LAYERS + 1], the base first."""
    from scipy.sparse import csc_matrix

    layers = np.geomspace(GRADING, 1.0, LAYERS)
    layers *= depth / layers.sum()
    node = np.arange((n_cells + 1) * (LAYERS + 1)).reshape(n_cells + 1, -1)
    rows, columns, values = [], [], []
    for j, height in enumerate(layers):
        corners = np.stack([node[:-1, j], node[1:, j], node[1:, j + 1], node[:-1, j + 1]], axis=1)
        dofs = (2 * corners[..., np.newaxis] + [0, 1]).reshape(n_cells, 8)
        rows.append(np.repeat(dofs, 8, axis=1).ravel())
        columns.append(np.tile(dofs, 8).ravel())
        values.append(np.tile(_element(length / n_cells, height, nu).ravel(), n_cells))
    place = (np.concatenate(rows), np.concatenate(columns))
    return csc_matrix((np.concatenate(values), place)), node


def _element(width: float, height: float, nu: float) -> Array:
    """Stiffness of a rectangle of plane-strain modulus 1 with mean dilatation, shape [8, 8]."""
    E = 1.0 - nu**2
    mu, K = E / (2 * (1 + nu)), E / (3 * (1 - 2 * nu))
    deviatoric = mu * np.array([[4 / 3, -2 / 3, 0], [-2 / 3, 4 / 3, 0], [0, 0, 1]])
    gauss = CORNERS / np.sqrt(3)
    area, mean = width * height, _strain(0.0, 0.0, width, height)
    dilatation = mean[0] + mean[1]
    stiffness = K * area * np.outer(dilatation, dilatation)
    for a, b in gauss:
        B = _strain(a, b, width, height)
        stiffness += area / 4 * B.T @ deviatoric @ B
    return stiffness


def _strain(a: float, b: float, width: float, height: float) -> Array:
    """Strains 11, 22 and twice 12 at (a, b) in [-1, 1]^2 per displacement of the corners, shape [3, 8]."""
    along = CORNERS[:, 0] * (1 + CORNERS[:, 1] * b) / (2 * width)
    across = CORNERS[:, 1] * (1 + CORNERS[:, 0] * a) / (2 * height)
    B = np.zeros((3, 8))
    B[0, 0::2], B[1, 1::2], B[2, 0::2], B[2, 1::2] = along, across, across, along
    return B
