"""Nodal forces are the gradient of the stored energy, f = dE/du, hourglass energy included.

The energy is written a second time, in plain NumPy (tests/support/statics.py), and differentiated by the complex step,
Im E(u + i h d)/h, which is exact to rounding; the solver's own energy is differentiated by central differences.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.ledger import Verified, order
from support.models import (
    ELEMENTS,
    K_0,
    MU_0,
    Array,
    affine,
    build,
    distorted,
    elastic,
    forces,
    history,
    rotation,
    run,
)
from support.statics import COMPLEX_STEP, ElasticBlock
from wrinklewave.mesh.block import GridMesh

SIZE = 1e-3
MESH = distorted(4, 3, size=SIZE, seed=3)
F = rotation(0.6) @ np.array([[0.85, 0.2], [0.0, 1.1]])


def rough(seed: int, amount: float = 0.08) -> Array:
    """A finite deformation that varies from node to node, hourglass patterns in it."""
    return affine(MESH, F) + np.random.default_rng(seed).normal(0.0, amount * SIZE, (2, *MESH.X.shape))


def solver_energy(mesh: GridMesh, u: Array, element: str) -> float:
    """Elastic energy that a simulation reports [J/m], at rest; the hourglass energy is work to it."""
    model = build(mesh, elastic(), element)
    model.arrays.u[:], model.arrays.w[:] = u
    return float(history(run(model, np.array([0.0, 1e-15])))["elastic_J_per_m"][0])


@pytest.mark.parametrize("element", ELEMENTS)
@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1))
def test_forces_are_the_gradient_of_the_energy(element: str, seed: int) -> None:
    u, d = rough(seed), np.random.default_rng(seed + 1).normal(size=(2, *MESH.X.shape))
    slope = ElasticBlock(MESH, MU_0, K_0, element).energy(u + 1j * COMPLEX_STEP * d).imag / COMPLEX_STEP
    f = forces(build(MESH, elastic(), element), u)
    assert abs(np.sum(f * d) - slope) <= 1e-12 * np.sum(np.abs(f * d))


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("hourglass", [1.0, 0.1])
def test_every_nodal_force(element: str, hourglass: float, verified: Verified) -> None:
    u = rough(0)
    body = ElasticBlock(MESH, MU_0, K_0, element, hourglass)
    f = forces(build(MESH, elastic(), element, hourglass=hourglass), u)
    slope = np.zeros_like(u)
    for place in range(u.size):
        d = np.zeros(u.shape, dtype=complex)
        d.flat[place] = 1j * COMPLEX_STEP
        slope.flat[place] = body.energy(u + d).imag / COMPLEX_STEP
    error = float(np.abs(f - slope).max() / np.abs(f).max())
    verified.error(f"f - dE/du over max f, {element}, hourglass factor {hourglass}", error, 1e-12)


@pytest.mark.parametrize("element", ELEMENTS)
def test_reported_energy_is_the_integral_of_the_energy_density(element: str, verified: Verified) -> None:
    u = rough(1)
    body = ElasticBlock(MESH, MU_0, K_0, element)
    exact = float(body.energy(u) - body.hourglass_energy(u))
    verified.error(
        f"reported elastic energy, relative, {element}",
        abs(solver_energy(MESH, u, element) / exact - 1),
        1e-12,
    )


def test_forces_by_central_differences_of_the_reported_energy(verified: Verified) -> None:
    # (E(u + h d) - E(u - h d)) / 2h = f . d + O(h²)
    u, d = rough(2), np.random.default_rng(5).normal(size=(2, *MESH.X.shape))
    work = float(np.sum(forces(build(MESH, elastic(), "mean-dilatation"), u) * d))
    errors = []
    for h in (4e-5, 2e-5, 1e-5):
        up, down = (solver_energy(MESH, u + sign * h * d, "mean-dilatation") for sign in (1, -1))
        errors.append(abs((up - down) / (2 * h) / work - 1))
    verified.between("order of central differences of the energy", order(errors), 1.95, 2.05)
    verified.error("force against the finest difference, relative", errors[-1], 1e-3)


@pytest.mark.parametrize("element", ELEMENTS)
def test_tangent_stiffness_is_symmetric(element: str, verified: Verified) -> None:
    # K = d²E/du² = K^T: (f(u + h d) - f(u - h d)) . c = (f(u + h c) - f(u - h c)) . d
    u, h = rough(3), 1e-4 * SIZE
    c, d = np.random.default_rng(6).normal(size=(2, 2, *MESH.X.shape))

    def along(direction: Array) -> Array:
        up, down = (forces(build(MESH, elastic(), element), u + sign * h * direction) for sign in (1, -1))
        return (up - down) / (2 * h)

    one, other = float(np.sum(along(d) * c)), float(np.sum(along(c) * d))
    verified.error(f"asymmetry of the tangent stiffness, {element}", abs(one / other - 1), 1e-5)
