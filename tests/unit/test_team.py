"""Steps shared out to threads: as if one had done them all; and nobody waits for a share that does not come."""

from dataclasses import replace

import numpy as np
import pytest

from support.backend_runs import MODELS
from support.models import ELEMENTS, build, relaxing
from wrinklewave.dynamics.boundary import FIXED, N_TOTALS, WORK
from wrinklewave.dynamics.model import Model
from wrinklewave.dynamics.shares import shared_out
from wrinklewave.dynamics.step import advance
from wrinklewave.dynamics.team import share_out
from wrinklewave.mesh.block import block

STATE = ("u", "w", "vx", "vy")


def marched(name: str, parts: int, steps: int = 120, dt: float = 4e-7) -> dict[str, np.ndarray]:
    model, totals = MODELS[name](), np.zeros(N_TOTALS)
    arrays = model.arrays._replace(**shared_out(model.arrays.u, parts))
    advance(steps, 0.0, 0.0, dt, arrays, model.memory_rows, model.terms, model.boundary, totals)
    return {field: getattr(arrays, field) for field in STATE} | {"memory": model.memory, "totals": totals}


@pytest.mark.parametrize("name", MODELS)
@pytest.mark.parametrize("parts", [2, 3])
def test_the_number_of_threads_changes_no_bit(name, parts):
    one, many = marched(name, 1), marched(name, parts)
    assert one["totals"][WORK] != 0
    assert all(np.array_equal(one[key], many[key]) for key in one)


def moving(element: str, even: str = "xy") -> Model:
    """A graded block, its nodes at rest at random places; ``even``: which undeformed coordinates do not vary across."""
    mesh = block(length=12e-3, bottom=0.0, top=5e-3, elements=(11, 5), grading=(0.5, 1.3))
    uneven = 1e-4 * np.random.default_rng(5).standard_normal((2, *mesh.X.shape))
    X = mesh.X if "x" in even else mesh.X + uneven[0]
    mesh = replace(mesh, X=X, Y=mesh.Y if "y" in even else mesh.Y + uneven[1])
    model = build(mesh, relaxing(bulk=True), element, right=FIXED, bulk_viscosity=(0.06, 1.2))
    model.arrays.u[:], model.arrays.w[:] = 5e-5 * np.random.default_rng(3).standard_normal((2, 6, 12))
    return model


@pytest.mark.parametrize("even", ["xy", "x", "y"])
@pytest.mark.parametrize("element", ELEMENTS)
def test_coordinates_by_row_and_column_are_those_of_the_nodes(element, even):
    states = []
    for model, by_node in ((moving(element, even), False), (moving(element, even), True)):
        a = model.arrays
        assert a.x.shape == ((12,) if "x" in even else (6, 12))
        assert a.y.shape == ((6,) if "y" in even else (6, 12))
        a = a._replace(x=a.X, y=a.Y) if by_node else a
        advance(100, 0.0, 0.0, 2e-7, a, model.memory_rows, model.terms, model.boundary, np.zeros(N_TOTALS))
        states.append([*(getattr(a, field) for field in STATE), model.memory])
    for by_row, by_node in zip(*states, strict=True):
        np.testing.assert_allclose(by_row, by_node, rtol=0, atol=1e-12 * np.abs(by_node).max())


def test_a_failure_in_a_share_is_told():
    def kernel(part):
        if part == 1:
            raise RuntimeError("of part 1")

    with pytest.raises(RuntimeError, match="of part 1"):
        share_out(kernel, 2)


def test_more_parts_than_threads_is_an_error():
    with pytest.raises(ValueError, match="10000 parts"):
        share_out(lambda part: None, 10_000)
