"""The paper's cases from plain numbers: for machines that have no room for case files (no pydantic, no pint).

``tests/unit/test_benchmark_parts.py`` holds them against the case files.
"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np

from wrinklewave.dynamics import drives
from wrinklewave.dynamics.boundary import FIXED, FREE, LEFT_STRUCK, ROLLER, Boundary
from wrinklewave.dynamics.model import AT_REST, Model, assemble
from wrinklewave.materials.moduli import Viscoelastic, bulk_modulus
from wrinklewave.mesh.bilayer import bilayer
from wrinklewave.mesh.block import GridMesh, block

LENGTH, HALF, THICKNESS = 50.4e-3, 18.5e-3, 140e-6
RHO, MU_0, MU_1, TAU, NU = 965.0, 44e3, 3.35e6, 90e-6, 0.49
K_0, K_I = bulk_modulus(MU_0, NU), bulk_modulus(MU_0 + MU_1, NU)
FILM_MU = 1850466.6432120465
"""Makes the film wrinkle at a strain of 0.043."""
DRIVE = SimpleNamespace(velocity=10.0, rise_time=0.5e-3, stop_distance=6.3e-3)
END_TIME = 5e-3


def substrate(K: float = K_0) -> Viscoelastic:
    """The paper's block, its bulk modulus the same at all times."""
    return Viscoelastic(RHO, MU_0, K, np.array([MU_1]), np.zeros(1), np.array([TAU]))


def struck(mesh: GridMesh, materials: list[Viscoelastic], threads: int = 1) -> Model:
    """A mesh of the upper half of the block, struck as in the paper."""
    boundary = Boundary(
        *(LEFT_STRUCK, FIXED, FREE, ROLLER, True, LENGTH, 0.0, drives.striker(DRIVE), AT_REST),
        old=np.zeros((3, 4, max(mesh.X.shape))),
        bins=np.zeros((3, 2, mesh.X.shape[1]), dtype=np.int64),
    )
    return assemble(mesh, materials, boundary, threads=threads)


def paper(columns: int = 202, rows: int = 74, *, K: float = K_0, threads: int = 1) -> Model:
    """``examples/paper_impact.toml`` on any mesh."""
    mesh = block(length=LENGTH, bottom=0.0, top=HALF, elements=(columns, rows), grading=(1.0, 1.0))
    return struck(mesh, [substrate(K)], threads)


def resolved(columns: int = 720, rows: int = 51, *, threads: int = 1) -> Model:
    """``examples/paper_resolved.toml`` with a flat film, on any mesh of its substrate."""
    mesh = bilayer(
        **{"length": LENGTH, "bottom": 0.0, "top": HALF, "thickness": THICKNESS, "columns": columns},
        **{"substrate_rows": rows, "film_rows": 4, "grading": (1.0, 0.065)},
    )
    none = np.empty(0)
    film = Viscoelastic(RHO, FILM_MU, bulk_modulus(FILM_MU, NU), none, none, none)
    return struck(mesh, [substrate(), film], threads)


def shape(n_elements: float) -> tuple[int, int]:
    """Columns and rows of about ``n_elements`` squares in the paper's block."""
    columns = round((n_elements * LENGTH / HALF) ** 0.5)
    return columns, round(n_elements / columns)
