"""A fixed end whose uppermost part slips along its plate."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wrinklewave.config import load_case
from wrinklewave.dynamics.model import build_model
from wrinklewave.dynamics.simulation import Simulation

CASE = Path(__file__).parents[2] / "examples" / "quick.toml"


@pytest.mark.parametrize("symmetry", [True, False])
def test_only_the_part_below_the_surface_slips(symmetry: bool) -> None:
    case = load_case(
        CASE, ["boundaries.slip=5 mm", f"block.symmetry={str(symmetry).lower()}", "mesh.elements=[50, 20]"]
    )
    model = build_model(case)
    for _ in Simulation(model, np.array([0.0, 2e-3])).run():
        pass
    slipped = np.abs(model.arrays.w[:, -1]) > 0.0
    surfaces = [1.0] if symmetry else [1.0, -1.0]
    near = np.any([side * model.mesh.Y[:, -1] > case.block.height / 2 - 5e-3 for side in surfaces], axis=0)
    np.testing.assert_array_equal(slipped, near)
    assert (model.arrays.u[:, -1] == 0.0).all()
    assert model.arrays.w[-1, -1] > 0.0
