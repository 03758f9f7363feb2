"""Mixed precision: one source of formulas, compiled for either width; close to double, and as repeatable."""

from pathlib import Path

import numpy as np
import pytest

from support.backend_models import mixed, struck
from wrinklewave._jit import in_single_precision
from wrinklewave.config import load_case
from wrinklewave.dynamics.boundary import N_TOTALS, WORK
from wrinklewave.dynamics.elements.one_point import hourglass_stiffness
from wrinklewave.dynamics.model import build_model
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.dynamics.step import advance
from wrinklewave.materials.neo_hookean import inverse_cube_root

QUICK = Path(__file__).parents[2] / "examples" / "quick.toml"
SINGLE = float(np.finfo(np.float32).eps)


def test_constants_do_not_widen():
    narrow = in_single_precision(inverse_cube_root)
    J = np.float32(0.8)
    assert narrow.py_func(J).dtype == np.float32
    assert narrow(J) == pytest.approx(0.8 ** (-1 / 3), rel=4 * SINGLE)
    assert abs(narrow(J) - inverse_cube_root(0.8)) > 0.01 * SINGLE  # it is not double in disguise


def test_constants_of_the_module_are_narrowed_too():
    diagonals = np.array([1.0, 0.1, -0.1, 1.0, 0.5, 1.0], np.float32)
    assert in_single_precision(hourglass_stiffness).py_func(*diagonals).dtype == np.float32


def test_a_step_is_that_of_double_but_for_rounding():
    found = {}
    for make in (struck, mixed):
        model, totals = make(), np.zeros(N_TOTALS)
        advance(100, 0.0, 0.0, 4e-7, model.arrays, model.memory_rows, model.terms, model.boundary, totals)
        found[make] = model.arrays.u.astype(float), totals[WORK]
        assert model.arrays.u.dtype == (np.float32 if make is mixed else np.float64)
    (u, work), (narrow, narrow_work) = found[struck], found[mixed]
    largest = np.abs(u).max()
    assert 0 < np.abs(narrow - u).max() < 1000 * SINGLE * largest
    assert narrow_work == pytest.approx(work, rel=1000 * SINGLE)


def test_a_case_asks_for_it():
    imbalance = {}
    for precision in ("double", "mixed"):
        case = load_case(QUICK, ["mesh.elements=[24, 8]", f"solver.precision={precision}"])
        simulation = Simulation(build_model(case), np.array([0.0, 2e-4, 4e-4]), history_interval=1e-5)
        for _ in simulation.run():
            pass
        assert simulation.model.memory.dtype == (np.float32 if precision == "mixed" else np.float64)
        imbalance[precision] = simulation.imbalance
    assert imbalance["mixed"] == pytest.approx(imbalance["double"], abs=1e-5)
