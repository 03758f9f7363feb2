"""A block as small linear elements: what a film pushes against when it holds the block's surface back.

The block is linear, isotropic, in plane strain, 0 <= X <= length, on a plane of symmetry at its base, bonded at
X = length, with a free top and a struck end X = 0 that slips along its plate or is free. Rectangles with mean
dilatation, graded towards the surface; masses at the nodes.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from scipy.sparse import csr_array

Array = NDArray[np.float64]

LAYERS = 12
GRADING = 8.0
"""Ratio of the thickest to the thinnest layer of elements, at the surface."""
CORNERS = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])


@dataclass(frozen=True)
class BlockElements:
    """Matrices of a block, for its moving degrees of freedom (n of them).

    Args:
        nodes: undeformed positions along the top, the bonded one included [m], shape [n_cells + 1].
        shear, bulk: stiffness per shear and per bulk modulus, shape [n, n].
        mass: per density [m²], shape [n].
        end: which of them move the struck end along X, shape [n].
        shortening: compressive strain of the cells along the top per displacement [1/m], shape [n_cells, n].
    """

    nodes: Array
    shear: csr_array
    bulk: csr_array
    mass: Array
    end: NDArray[np.bool_]
    shortening: csr_array

    @property
    def centres(self) -> Array:
        """Undeformed positions of the cells' centres [m], shape [n_cells]."""
        return 0.5 * (self.nodes[1:] + self.nodes[:-1])

    @property
    def cell(self) -> float:
        """Length of a cell [m]."""
        return float(self.nodes[1] - self.nodes[0])


def block_elements(*, length: float, depth: float, n_cells: int) -> BlockElements:
    """Divide a block.

    Args:
        length, depth: of the block, from its surface to the plane of symmetry [m].
        n_cells: along the surface.
    """
    from scipy.sparse import csr_array

    layers = np.geomspace(GRADING, 1.0, LAYERS)
    layers *= depth / layers.sum()
    node = np.arange((n_cells + 1) * (LAYERS + 1)).reshape(n_cells + 1, -1)
    corners = np.stack([node[:-1, :-1], node[1:, :-1], node[1:, 1:], node[:-1, 1:]], axis=-1)
    dofs = (2 * corners[..., np.newaxis] + [0, 1]).reshape(n_cells, LAYERS, 8)
    rows, columns = np.repeat(dofs, 8, axis=-1).ravel(), np.tile(dofs, 8).ravel()
    cell, n = length / n_cells, 2 * node.size

    moving = np.ones(n, dtype=bool)
    moving[2 * node[-1]] = moving[2 * node[-1] + 1] = moving[2 * node[:, 0] + 1] = False

    def assembled(elements: list[Array]) -> csr_array:
        values = np.tile(np.stack(elements).ravel(), n_cells)
        return csr_array((values, (rows, columns)), shape=(n, n))[moving][:, moving]

    shear, bulk = (
        assembled([part(cell, height) for height in layers]) for part in (_shear_stiffness, _bulk_stiffness)
    )
    quarter = np.tile(np.repeat(layers * cell / 4, 8), n_cells)
    mass = np.bincount(dofs.ravel(), quarter, minlength=n).astype(np.float64)
    end = np.zeros(n, dtype=bool)
    end[2 * node[0]] = True
    mass[end] = 0.0  # it meets its plate without an impact of its own
    top, each = 2 * node[:, -1], np.arange(n_cells)
    place = (np.concatenate([each, each]), np.concatenate([top[:-1], top[1:]]))
    shortening = csr_array((np.repeat([1.0, -1.0], n_cells) / cell, place), shape=(n_cells, n))[:, moving]
    return BlockElements(
        np.linspace(0.0, length, n_cells + 1), shear, bulk, mass[moving], end[moving], shortening
    )


def _shear_stiffness(width: float, height: float) -> Array:
    """Stiffness of a rectangle of shear modulus 1, shape [8, 8]: its shape changes at 2 x 2 Gauss points."""
    deviatoric = np.array([[4 / 3, -2 / 3, 0], [-2 / 3, 4 / 3, 0], [0, 0, 1]])
    strains = [_strain(a, b, width, height) for a, b in CORNERS / np.sqrt(3)]
    return np.sum([width * height / 4 * B.T @ deviatoric @ B for B in strains], axis=0)


def _bulk_stiffness(width: float, height: float) -> Array:
    """Stiffness of a rectangle of bulk modulus 1, shape [8, 8]: its mean dilatation."""
    mean = _strain(0.0, 0.0, width, height)
    dilatation = mean[0] + mean[1]
    return width * height * np.outer(dilatation, dilatation)


def _strain(a: float, b: float, width: float, height: float) -> Array:
    """Strains 11, 22 and twice 12 at (a, b) in [-1, 1]^2 per displacement of the corners, shape [3, 8]."""
    along = CORNERS[:, 0] * (1 + CORNERS[:, 1] * b) / (2 * width)
    across = CORNERS[:, 1] * (1 + CORNERS[:, 0] * a) / (2 * height)
    B = np.zeros((3, 8))
    B[0, 0::2], B[1, 1::2], B[2, 0::2], B[2, 1::2] = along, across, across, along
    return B
