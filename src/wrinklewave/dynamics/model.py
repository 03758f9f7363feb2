"""From a case to the arrays that the kernels take."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.dynamics import drives
from wrinklewave.dynamics.boundary import (
    FIXED,
    FREE,
    LEFT_HELD,
    LEFT_LINEAR,
    LEFT_MOVED,
    LEFT_STRAIGHT,
    LEFT_STRUCK,
    ROLLER,
    Boundary,
)
from wrinklewave.dynamics.points import MEAN_DILATATION_COMPONENTS, ONE_POINT_COMPONENTS
from wrinklewave.dynamics.row_steps import RowSteps, with_layers_of_rows
from wrinklewave.dynamics.shares import shared_out
from wrinklewave.dynamics.step import Arrays
from wrinklewave.errors import InputError
from wrinklewave.materials.moduli import plane_wave_modulus, substrate_moduli
from wrinklewave.mesh.bilayer import bilayer, warn_if_coarse
from wrinklewave.mesh.block import GridMesh, block
from wrinklewave.theory.film import critical_values, film_material

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from wrinklewave.config import Case
    from wrinklewave.materials.moduli import Viscoelastic

EDGES = {"free": FREE, "fixed": FIXED, "roller": ROLLER}
TRANSVERSE = {"free": LEFT_MOVED, "held": LEFT_HELD, "linear": LEFT_STRAIGHT}
NUMBERS = {"double": np.float64, "mixed": np.float32}
"""Of the state and of the elements' and nodes' arithmetic; edges, energies and time are double always."""
AT_REST = np.array([[0.0, 1.0, 0.0, 0.0, 0.0, 0.0]])


@dataclass(frozen=True, eq=False)
class Model:
    """A mesh with its materials, edges and state, ready to be stepped.

    Args:
        mesh: the undeformed mesh.
        materials: one per layer of the mesh.
        arrays: state and coefficients, see :class:`wrinklewave.dynamics.step.Arrays`.
        memory: what the Prony terms remember, shape [n_terms * components, n_rows, n_columns].
        terms: one entry per Prony term.
        boundary: conditions at the edges.
        density: of each layer, mass scaling included [kg/m³].
        row_steps: of a model whose rows have steps of their own, and each row layers of its own in ``arrays`` and
            ``density``; else None.
    """

    mesh: GridMesh
    materials: Sequence[Viscoelastic]
    arrays: Arrays
    memory: NDArray[np.float64]
    terms: tuple[float, ...]
    boundary: Boundary
    density: NDArray[np.float64]
    row_steps: RowSteps | None = None

    @property
    def memory_rows(self) -> tuple[NDArray[np.float64], ...]:
        """The memory as the kernels take it: one array per component."""
        return tuple(self.memory)


def build_model(case: Case, *, threads: int = 1) -> Model:
    """Mesh, materials and edges of a case, at rest."""
    mesh, materials = layers(case)
    left, motion, across = _drive(case)
    boundary = Boundary(
        left=left,
        right=EDGES[case.boundaries.right],
        top=EDGES[case.boundaries.top],
        bottom=ROLLER if case.block.symmetry else EDGES[case.boundaries.top],
        wall=case.boundaries.wall,
        length=case.block.length,
        friction=getattr(case.drive, "friction", 0.0),
        motion=motion,
        motion_across=across,
        old=np.zeros((3, 4, max(mesh.X.shape))),
        bins=np.zeros((3, 2, mesh.X.shape[1]), dtype=np.int64),
        slipping=int((mesh.Y[:, -1] > mesh.Y[-1, -1] - case.boundaries.slip).sum()),
    )
    model = assemble(
        mesh,
        materials,
        boundary,
        one_point=case.mesh.element == "one-point",
        hourglass=case.mesh.hourglass.stiffness,
        bulk_viscosity=case.solver.bulk_viscosity,
        mass_scaling=case.solver.mass_scaling,
        threads=threads,
        precision=case.solver.precision,
    )
    can_subcycle = len(materials) > 1 and left != LEFT_STRAIGHT
    return subcycled(model) if can_subcycle and case.solver.subcycling else model


def subcycled(model: Model) -> Model:
    """A model at rest whose rows of elements have steps of their own; a straight left end would need one for all."""
    a = with_layers_of_rows(model.arrays)
    density = np.tile(model.density, model.mesh.shape[0])
    return replace(model, arrays=a, density=density, row_steps=RowSteps.at_rest(a))


def layers(case: Case) -> tuple[GridMesh, list[Viscoelastic]]:
    """Undeformed mesh of a case and the material of each of its layers; a film to be resolved is one of them.

    Raises:
        InputError: if there are too few elements across the block for a film.
    """
    half = case.block.height / 2
    bottom = 0.0 if case.block.symmetry else -half
    substrate, (columns, rows), grading = (
        substrate_moduli(case.substrate),
        case.mesh.elements,
        case.mesh.grading,
    )
    film = case.film
    if film is None or case.wrinkles.model != "resolved":
        flat = block(
            length=case.block.length, bottom=bottom, top=half, elements=(columns, rows), grading=grading
        )
        return flat, [substrate]
    film_rows, interface = film.elements_through_thickness, half - film.thickness
    if rows <= film_rows:
        raise InputError(
            f"{rows} elements across the block, {film_rows} of them in the film",
            key="mesh.elements",
            expected="some for the substrate as well",
        )
    mesh = bilayer(
        length=case.block.length,
        bottom=bottom,
        top=half,
        thickness=film.thickness,
        columns=columns,
        substrate_rows=rows - film_rows,
        film_rows=film_rows,
        end_gap=film.end_gap,
        grading=grading,
    )
    warn_if_coarse(mesh, critical_values(film, case.substrate)[1])
    if film.imperfection is not None:
        from wrinklewave.mesh.imperfection import with_imperfection  # knows case files, as _drive does

        mesh = with_imperfection(mesh, film.imperfection, interface=interface, depth=interface - bottom)
    return mesh, [substrate, film_material(film, case.substrate)]


def assemble(
    mesh: GridMesh,
    materials: Sequence[Viscoelastic],
    boundary: Boundary,
    *,
    one_point: bool = True,
    hourglass: float = 1.0,
    bulk_viscosity: tuple[float, float] = (0.06, 1.2),
    mass_scaling: float = 1.0,
    threads: int = 1,
    precision: str = "double",
) -> Model:
    """A model at rest from its parts; one material per layer of the mesh."""
    number = NUMBERS[precision]
    density = np.array([m.density * mass_scaling for m in materials])
    terms = _prony_terms(materials)
    bulk_relaxes = bool(np.any(terms[:, :, 1] > 0))
    components = (ONE_POINT_COMPONENTS if one_point else MEAN_DILATATION_COMPONENTS)[bulk_relaxes]
    n_terms = terms.shape[1]
    rows, columns = mesh.shape
    runs, first_run = material_runs(mesh.layer)
    nodes = mesh.X.shape
    X, Y = np.ascontiguousarray(mesh.X, number), np.ascontiguousarray(mesh.Y, number)
    straight, level = not np.ptp(X, axis=0).any(), not np.ptp(Y, axis=1).any()
    arrays = Arrays(
        X=X,
        Y=Y,
        x=X[0] if straight else X,
        y=np.ascontiguousarray(Y[:, 0]) if level else Y,
        u=np.zeros(nodes, number),
        w=np.zeros(nodes, number),
        vx=np.zeros(nodes, number),
        vy=np.zeros(nodes, number),
        inverse_mass=(1.0 / lumped_mass(mesh, density)).astype(number),
        runs=runs,
        first_run=first_run,
        moduli=np.array(
            [_moduli(m, rho, bulk_viscosity, hourglass) for m, rho in zip(materials, density, strict=True)],
            number,
        ),
        terms=terms,
        factors=np.ones((len(materials), n_terms, 5), number),
        nothing=np.zeros((8, columns + 2), number),
        **shared_out(X, threads),
    )
    memory = np.zeros((n_terms * components, rows, columns), number)
    return Model(mesh, materials, arrays, memory, (0.0,) * n_terms, boundary, density)


def material_runs(layer: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """Neighbours of one material in each row, as :class:`wrinklewave.dynamics.step.Arrays` has them."""
    starts = np.ones(layer.shape, dtype=bool)
    starts[:, 1:] = layer[:, 1:] != layer[:, :-1]
    row, start = np.nonzero(starts)
    stop = np.where(np.append(row[1:] == row[:-1], False), np.append(start[1:], 0), layer.shape[1])
    first = np.searchsorted(row, np.arange(layer.shape[0] + 1))
    return np.column_stack([start, stop, layer[row, start]]).astype(np.int64), first.astype(np.int64)


def lumped_mass(mesh: GridMesh, density: NDArray[np.float64]) -> NDArray[np.float64]:
    """Nodal masses [kg/m]: a quarter of each adjacent element's."""
    quarter = 0.25 * density[mesh.layer] * mesh.areas()
    mass = np.zeros(mesh.X.shape)
    for corner in (mass[:-1, :-1], mass[:-1, 1:], mass[1:, 1:], mass[1:, :-1]):
        corner += quarter
    return mass


def _moduli(
    material: Viscoelastic, density: float, viscosity: tuple[float, float], hourglass: float
) -> list[float]:
    M = plane_wave_modulus(material.mu_instantaneous, material.K_instantaneous)
    linear = viscosity[0] * np.sqrt(M * density)
    return [material.mu_inf, material.K_inf, linear, density * viscosity[1] ** 2, hourglass]


def _prony_terms(materials: Sequence[Viscoelastic]) -> NDArray[np.float64]:
    """Terms of every layer, padded with terms of no modulus to one number for all (at least one)."""
    n = max(1, *(m.tau_k.size for m in materials))
    terms = np.zeros((len(materials), n, 3))
    terms[:, :, 2] = 1.0
    for layer, m in enumerate(materials):
        terms[layer, : m.tau_k.size] = np.column_stack([m.mu_k, m.K_k, m.tau_k])
    return terms


def _drive(case: Case) -> tuple[int, NDArray[np.float64], NDArray[np.float64]]:
    """Kind of the left edge, and the histories of the plate or end along x and across."""
    drive = case.drive
    if drive.kind == "striker":
        return LEFT_STRUCK, drives.striker(drive), AT_REST
    if drive.kind == "end-motion":
        return TRANSVERSE[drive.transverse], drives.end_motion(drive), AT_REST
    if drive.kind == "compression":
        ramp = drives.compression(drive.strain * case.block.length, drive.duration, drive.unload)
        return LEFT_MOVED, ramp, AT_REST
    if drive.kind == "velocity-step":
        return LEFT_MOVED, drives.velocity_step(drive), AT_REST
    from wrinklewave.config.history import read_history  # a model from parts needs no case files

    history = read_history(Path(drive.file))
    motion = drives.measured(history.time, history.u_x, drive.smoothing)
    if history.u_y is None:
        return LEFT_MOVED, motion, AT_REST
    return LEFT_LINEAR, motion, drives.measured(history.time, history.u_y, drive.smoothing)
