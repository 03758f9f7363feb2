"""The problem that every contender steps: the paper's impact on a mesh of any size, moving everywhere."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from wrinklewave.config import load_case
from wrinklewave.dynamics.boundary import Boundary
from wrinklewave.dynamics.model import Model, build_model
from wrinklewave.dynamics.shares import shared_out
from wrinklewave.dynamics.stable_step import stable_steps_share
from wrinklewave.dynamics.step import Arrays, update_factors

REPOSITORY = Path(__file__).parents[1]
PAPER_CASE = REPOSITORY / "examples" / "paper_impact.toml"
PLATE_SPEED = 10.0  # m/s
DISTURBANCE = 1e-3  # of the element's size
STATE = ("u", "w", "vx", "vy")


@dataclass(frozen=True, eq=False)
class Problem:
    """A model in motion.

    Args:
        model: with arrays for the largest number of threads.
        boundary: struck at a constant speed.
        dt: half the stable step [s].
    """

    model: Model
    boundary: Boundary
    dt: float

    @property
    def n_elements(self) -> int:
        """Elements of the mesh."""
        return self.model.mesh.n_elements

    def arrays(self, threads: int) -> Arrays:
        """The same state, shared out to ``threads``."""
        a = self.model.arrays
        return a._replace(**shared_out(a.u, threads))

    def copy(self) -> Problem:
        """The same problem with a state of its own."""
        a = self.model.arrays
        arrays = a._replace(**{name: getattr(a, name).copy() for name in STATE})
        boundary = self.boundary._replace(old=self.boundary.old.copy())
        model = Model(
            self.model.mesh,
            self.model.materials,
            arrays,
            self.model.memory.copy(),
            self.model.terms,
            boundary,
            self.model.density,
        )
        return Problem(model, boundary, self.dt)


def shape(n_elements: int) -> tuple[int, int]:
    """Columns and rows of about ``n_elements`` squares in the paper's block."""
    columns = round((n_elements * 50.4 / 18.5) ** 0.5)
    return columns, round(n_elements / columns)


def problem(n_elements: int, precision: str = "double") -> Problem:
    """About ``n_elements`` elements, every one of them deformed (seeded random displacements)."""
    columns, rows = shape(n_elements)
    case = load_case(PAPER_CASE, [f"mesh.elements=[{columns}, {rows}]", f"solver.precision={precision}"])
    model = build_model(case)
    motion = np.array([[0.0, 1.0, 0.0, PLATE_SPEED, PLATE_SPEED, PLATE_SPEED]])
    boundary = model.boundary._replace(motion=motion)
    a = model.arrays
    random = np.random.default_rng(1)
    size = DISTURBANCE * model.mesh.X[0, 1]
    a.u[:, 1:-1] = size * random.standard_normal((rows + 1, columns - 1))
    a.w[1:, :-1] = size * random.standard_normal((rows, columns))
    steps = np.zeros(model.mesh.shape)
    stable_steps_share(0, a, model.density, steps)
    dt = 0.5 * float(steps.min())
    update_factors(a.terms, dt, dt, a.factors)
    return Problem(model, boundary, dt)
