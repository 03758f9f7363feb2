"""Small models to put the solver to the test with, and its forces under displacements that a test prescribes."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import NDArray

from wrinklewave.dynamics.boundary import FREE, LEFT_FREE, N_TOTALS, Boundary
from wrinklewave.dynamics.model import AT_REST, Model, assemble
from wrinklewave.dynamics.simulation import HISTORY, Simulation
from wrinklewave.dynamics.step import advance
from wrinklewave.materials.moduli import Viscoelastic, bulk_modulus
from wrinklewave.mesh.block import GridMesh, block

Array = NDArray[np.float64]

ELEMENTS = ("one-point", "mean-dilatation")

# The material of the paper.
RHO, MU_0, MU_1, TAU, NU = 965.0, 44e3, 3.35e6, 90e-6, 0.49
K_0 = bulk_modulus(MU_0, NU)
K_I = bulk_modulus(MU_0 + MU_1, NU)


def elastic(mu: float = MU_0, K: float = K_0) -> Viscoelastic:
    """A neo-Hookean solid without memory."""
    none = np.empty(0)
    return Viscoelastic(RHO, mu, K, none, none, none)


def relaxing(*, bulk: bool) -> Viscoelastic:
    """The paper's solid; the bulk modulus relaxes from K_i to K_0 with the shear, or is K_0 at all times."""
    K_1 = K_I - K_0 if bulk else 0.0
    return Viscoelastic(RHO, MU_0, K_0, np.array([MU_1]), np.array([K_1]), np.array([TAU]))


def build(
    mesh: GridMesh,
    material: Viscoelastic,
    element: str,
    *,
    left: int = LEFT_FREE,
    right: int = FREE,
    top: int = FREE,
    bottom: int = FREE,
    wall: bool = False,
    friction: float = 0.0,
    motion: Array = AT_REST,
    hourglass: float = 1.0,
    bulk_viscosity: tuple[float, float] = (0.0, 0.0),
    threads: int = 1,
    precision: str = "double",
) -> Model:
    """A model of one material; free edges and no bulk viscosity unless asked for."""
    boundary = Boundary(
        left=left,
        right=right,
        top=top,
        bottom=bottom,
        wall=wall,
        length=float(mesh.X.max()),
        friction=friction,
        motion=motion,
        motion_across=AT_REST,
        old=np.zeros((3, 4, max(mesh.X.shape))),
    )
    return assemble(
        mesh,
        [material],
        boundary,
        one_point=element == "one-point",
        hourglass=hourglass,
        bulk_viscosity=bulk_viscosity,
        threads=threads,
        precision=precision,
    )


def distorted(
    columns: int, rows: int, *, size: float = 1e-3, seed: int = 0, amount: float = 0.25
) -> GridMesh:
    """A block of squares whose interior nodes are displaced at random by up to ``amount`` of their size."""
    mesh = block(length=columns * size, bottom=0.0, top=rows * size, elements=(columns, rows))
    shift = np.random.default_rng(seed).uniform(-amount * size, amount * size, (2, *mesh.X.shape))
    shift[:, [0, -1], :] = 0.0
    shift[:, :, [0, -1]] = 0.0
    return GridMesh(mesh.X + shift[0], mesh.Y + shift[1], mesh.layer)


def forces(
    model: Model, u: Array, *, v: Array | float = 0.0, dt_last: float = 0.0, dt: float = 1e-6
) -> Array:
    """Internal forces on the nodes [N/m] at prescribed displacements; the memory goes on to the next step.

    A free body is put where the test wants it, with the velocity ``v``, and one step is taken: the force is
    what the velocity changed by, f = -m dv / ((dt_last + dt)/2).

    Args:
        model: with free edges.
        u: displacements [m], shape [2, n_rows + 1, n_columns + 1].
        v: velocities [m/s], of the same shape.
        dt_last: length of the step that led to ``u`` [s]; 0 at the start, when there is no memory yet.
        dt: length of the step to come [s].
    """
    a = model.arrays
    v = np.broadcast_to(v, u.shape)
    a.u[:], a.w[:], a.vx[:], a.vy[:] = *u, *v
    advance(1, 0.0, dt_last, dt, a, model.memory_rows, model.terms, model.boundary, np.zeros(N_TOTALS))
    return (v - np.stack([a.vx, a.vy])) / (0.5 * (dt_last + dt) * a.inverse_mass)


def affine(mesh: GridMesh, F: Array) -> Array:
    """Displacements of the uniform deformation x = F X."""
    X = np.stack([mesh.X, mesh.Y])
    return np.einsum("ij,jnm->inm", F, X) - X


def rotation(angle: float) -> Array:
    """Matrix of the rotation by ``angle`` [rad]."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, -s], [s, c]])


def rotated(R: Array, f: Array) -> Array:
    """A nodal vector field, turned."""
    return np.einsum("ij,jnm->inm", R, f)


def traction_stress(f: Array, length: float, height: float) -> Array:
    """First Piola-Kirchhoff stress [Pa] of a uniformly deformed block, from the forces on its right and top edges.

    The edge nodes carry P N times the edge's length: P11, P21 on the right, P12, P22 on top.
    """
    right = f[:, :, -1].sum(axis=1) / height
    top = f[:, -1, :].sum(axis=1) / length
    return np.column_stack([right, top])


def march(model: Model, dt: float, n: int) -> Iterator[Array]:
    """Take ``n`` steps of ``dt`` [s] from rest; yields the totals after each (places in dynamics.boundary)."""
    totals = np.zeros(N_TOTALS)
    for step in range(n):
        advance(
            1,
            step * dt,
            dt if step else 0.0,
            dt,
            model.arrays,
            model.memory_rows,
            model.terms,
            model.boundary,
            totals,
        )
        yield totals


def stable_step(model: Model) -> float:
    """The solver's own estimate of the largest stable step of the present state [s]."""
    return Simulation(model, np.zeros(1)).stable_step()


def run(model: Model, events: Array, **options: float) -> Simulation:
    """A simulation that has run to its last event."""
    simulation = Simulation(model, np.asarray(events, dtype=float), **options)
    for _ in simulation.run():
        pass
    return simulation


def history(simulation: Simulation) -> dict[str, Array]:
    """Energies and motion of the struck end against time, columns by name."""
    return dict(zip(HISTORY, np.array(simulation.history).T, strict=True))
