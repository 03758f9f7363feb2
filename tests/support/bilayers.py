"""Small blocks with a stiff film, whose rows of elements have steps of their own."""

from __future__ import annotations

import numpy as np

from support.models import RHO, TAU, Array, elastic
from wrinklewave.dynamics.boundary import FIXED, FREE, LEFT_FREE, LEFT_STRUCK, ROLLER, Boundary
from wrinklewave.dynamics.drives import cubic_segments
from wrinklewave.dynamics.model import AT_REST, Model, assemble, subcycled
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.mesh.bilayer import bilayer
from wrinklewave.mesh.block import GridMesh

MU, K, RATIO = 44e3, 2.2e6, 42.0
COLUMNS, SUBSTRATE_ROWS, FILM_ROWS = 24, 8, 2
SIZE = 70e-6
KNOTS = np.linspace(0.0, 1e-3, 9)
STRIKE = cubic_segments(KNOTS, lambda t: 3e3 * t**2, lambda t: 6e3 * t)


def film_on_block(
    *, columns: int = COLUMNS, rows: int = SUBSTRATE_ROWS, size: float = SIZE, thickness: float = 0.5
) -> GridMesh:
    """Squares with a film in two rows, half a square thick; the interior nodes of the substrate displaced at random."""
    mesh = bilayer(
        length=columns * size,
        bottom=0.0,
        top=(rows + thickness) * size,
        thickness=thickness * size,
        columns=columns,
        substrate_rows=rows,
        film_rows=FILM_ROWS,
    )
    shift = np.random.default_rng(2).uniform(-0.1 * size, 0.1 * size, (2, *mesh.X.shape))
    shift[:, [0, *range(rows, rows + FILM_ROWS + 1)]] = 0.0
    shift[:, :, [0, -1]] = 0.0
    return GridMesh(mesh.X + shift[0], mesh.Y + shift[1], mesh.layer)


def struck_bilayer(
    *,
    mesh: GridMesh | None = None,
    ratio: float = RATIO,
    own_steps: bool = True,
    threads: int = 1,
    precision: str = "double",
    one_point: bool = True,
    left: int = LEFT_STRUCK,
    motion: Array = STRIKE,
    bulk_viscosity: tuple[float, float] = (0.06, 1.2),
) -> Model:
    """A plate strikes the upper half of a block with a film, which stands on a wall; or it is glued to it."""
    mesh = mesh or film_on_block()
    edges = (left, FIXED, FREE, ROLLER, True, float(mesh.X.max()), 0.1, motion, AT_REST)
    boundary = Boundary(
        *edges,
        old=np.zeros((3, 4, mesh.X.shape[1])),
        bins=np.zeros((3, 2, mesh.X.shape[1]), dtype=np.int64),
    )
    soft = Viscoelastic(RHO, MU, K, np.array([20 * MU]), np.zeros(1), np.array([TAU]))
    solids = [soft, elastic(mu=ratio * MU, K=ratio * K)]
    model = assemble(
        mesh,
        solids,
        boundary,
        one_point=one_point,
        bulk_viscosity=bulk_viscosity,
        threads=threads,
        precision=precision,
    )
    return subcycled(model) if own_steps else model


def free_bilayer() -> Model:
    """An elastic block with a film that flies, turns and shakes."""
    mesh = film_on_block()
    edges = (LEFT_FREE, FREE, FREE, FREE, False, float(mesh.X.max()), 0.0, AT_REST, AT_REST)
    boundary = Boundary(*edges, old=np.zeros((3, 4, mesh.X.shape[1])))
    solids = [elastic(mu=10 * MU, K=K), elastic(mu=RATIO * MU, K=RATIO * K)]
    model = subcycled(assemble(mesh, solids, boundary, bulk_viscosity=(0.0, 0.0)))
    a, random = model.arrays, np.random.default_rng(0)
    for field, scale in ((a.u, 0.01 * SIZE), (a.w, 0.01 * SIZE), (a.vx, 0.2), (a.vy, 0.2)):
        field[:] = scale * random.normal(size=field.shape)
    a.vx[:] += 10 - 2e3 * a.Y
    a.vy[:] += 5 + 2e3 * a.X
    return model
