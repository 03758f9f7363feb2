"""A block with a stiff film bonded to its upper surface."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.mesh.block import GridMesh, graded

if TYPE_CHECKING:
    from numpy.typing import NDArray

SUBSTRATE, FILM = 0, 1
"""Layers of a bilayer, in the order of its materials."""
ELEMENTS_PER_WAVELENGTH = 16
"""Along the film, and in size just below it; with fewer, wrinkles are visibly too stiff."""


def bilayer(
    *,
    length: float,
    bottom: float,
    top: float,
    thickness: float,
    columns: int,
    substrate_rows: int,
    film_rows: int,
    end_gap: float = 0.0,
    grading: tuple[float, float] = (1.0, 1.0),
) -> GridMesh:
    """A rectangular block 0 <= x <= length, bottom <= y <= top [m], its uppermost ``thickness`` [m] a film.

    Args:
        length, bottom, top, thickness: sizes [m].
        columns: elements along x.
        substrate_rows, film_rows: elements through substrate and film.
        end_gap: the film ends this far before x = length [m]; its place there is the substrate's.
        grading: ratio of last to first element size, along x and upwards through the substrate.
    """
    x = graded(0.0, length, columns, grading[0])
    substrate = graded(bottom, top - thickness, substrate_rows, grading[1])
    film = np.linspace(top - thickness, top, film_rows + 1)
    X, Y = np.meshgrid(x, np.concatenate([substrate, film[1:]]))
    layer = np.full((substrate_rows + film_rows, columns), SUBSTRATE)
    layer[substrate_rows:, 0.5 * (x[1:] + x[:-1]) < length - end_gap] = FILM
    return GridMesh(X=X, Y=Y, layer=layer)


def warn_if_coarse(mesh: GridMesh, wavelength: float) -> None:
    """Warn about elements that are too large for wrinkles of ``wavelength`` [m]."""
    along = float(np.diff(mesh.X[-1]).max())
    below = float(_substrate_sizes(mesh)[-1])
    for name, size in (("along the film", along), ("just below the film", below)):
        if size > wavelength / ELEMENTS_PER_WAVELENGTH * (1 + 1e-9):
            warnings.warn(
                f"elements {name} are {size * 1e3:.3g} mm, {wavelength / size:.1f} per wrinkle of "
                f"{wavelength * 1e3:.3g} mm: "
                f"expected at least {ELEMENTS_PER_WAVELENGTH} (mesh.elements, mesh.grading)",
                stacklevel=2,
            )


def _substrate_sizes(mesh: GridMesh) -> NDArray[np.float64]:
    """Heights of the substrate's element rows at the struck end [m], upwards."""
    return np.diff(mesh.Y[:, 0])[mesh.layer[:, 0] == SUBSTRATE]
