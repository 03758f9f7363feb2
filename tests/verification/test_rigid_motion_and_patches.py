"""Rigid motion and uniform deformation: what every element must get right on every mesh, to rounding.

Forces are measured against M h, instantaneous plane-wave modulus times element size; rounding of displacements that
are n times an element's size leaves n times 1e-16 of that.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.ledger import Verified
from support.models import (
    ELEMENTS,
    K_I,
    MU_0,
    MU_1,
    Array,
    affine,
    build,
    distorted,
    forces,
    relaxing,
    rotated,
    rotation,
    traction_stress,
)
from support.neo_hookean import first_piola_kirchhoff
from wrinklewave.dynamics.model import Model
from wrinklewave.materials.moduli import plane_wave_modulus

SIZE, COLUMNS, ROWS = 1e-3, 5, 4
SCALE = plane_wave_modulus(MU_0 + MU_1, K_I) * SIZE
ROUNDING = 1e-13

stretches = st.floats(0.7, 1.4)
shears = st.floats(-0.4, 0.4)
angles = st.floats(-np.pi, np.pi)


def sample(element: str, *, viscous: bool = False) -> Model:
    """A distorted patch that relaxes in shear and bulk."""
    mesh = distorted(COLUMNS, ROWS, size=SIZE)
    return build(mesh, relaxing(bulk=True), element, bulk_viscosity=(0.06, 1.2) if viscous else (0.0, 0.0))


def largest(f: Array) -> float:
    return float(np.abs(f).max() / SCALE)


@pytest.mark.parametrize("element", ELEMENTS)
def test_translation_makes_no_force(element: str, verified: Verified) -> None:
    # x = X + c: F = 1, so P = 0
    model = sample(element)
    u = np.ones((2, *model.mesh.X.shape)) * np.array([0.3, -0.7])[:, None, None]
    verified.error(
        f"force after a translation by 760 element sizes, {element}",
        largest(forces(model, u)),
        1e3 * ROUNDING,
    )


@pytest.mark.parametrize("element", ELEMENTS)
def test_finite_rotation_makes_no_force(element: str, verified: Verified) -> None:
    # x = R X: C = 1, so S = 0, whatever the angle
    worst = 0.0
    for angle in np.linspace(-np.pi, np.pi, 13):
        model = sample(element)
        worst = max(worst, largest(forces(model, affine(model.mesh, rotation(angle)))))
    verified.error(f"force after rotations up to 180°, {element}", worst, ROUNDING)


@pytest.mark.parametrize("element", ELEMENTS)
def test_rigid_spin_wakes_no_bulk_viscosity(element: str, verified: Verified) -> None:
    # v = omega e_z x x: div v = 0, so the viscous pressure is zero; it would be rho c h omega otherwise
    model = sample(element, viscous=True)
    u = affine(model.mesh, rotation(1.0))
    x = u + np.stack([model.mesh.X, model.mesh.Y])
    spin = 1e4 * np.stack([-x[1], x[0]])
    verified.error(
        f"force of bulk viscosity in a spin at 1e4 rad/s, {element}",
        largest(forces(model, u, v=spin)),
        ROUNDING,
    )


@pytest.mark.parametrize("element", ELEMENTS)
@settings(max_examples=50)
@given(stretches, stretches, shears, angles)
def test_interior_nodes_feel_no_force_in_any_uniform_deformation(
    element: str, a: float, b: float, shear: float, angle: float
) -> None:
    # x = F X: P is uniform, so Div P = 0 inside, on distorted elements as well
    model = sample(element)
    f = forces(model, affine(model.mesh, rotation(angle) @ np.array([[a, shear], [0.0, b]])))
    assert largest(f[:, 1:-1, 1:-1]) <= ROUNDING


@pytest.mark.parametrize("element", ELEMENTS)
def test_patch(element: str, verified: Verified) -> None:
    # x = F X: interior nodes feel nothing, and the edges carry P N with the instantaneous P(F)
    model = sample(element)
    F = rotation(0.8) @ np.array([[0.8, 0.3], [0.0, 1.15]])
    f = forces(model, affine(model.mesh, F))
    P = first_piola_kirchhoff(F, MU_0 + MU_1, K_I)
    verified.error(
        f"force on interior nodes of a distorted patch, {element}", largest(f[:, 1:-1, 1:-1]), ROUNDING
    )
    found = traction_stress(f, COLUMNS * SIZE, ROWS * SIZE)
    verified.error(f"traction on its edges, relative, {element}", float(np.abs(found / P - 1).max()), 1e-12)


@pytest.mark.parametrize("element", ELEMENTS)
@settings(max_examples=20)
@given(stretches, stretches, shears, angles)
def test_forces_and_moments_balance(element: str, a: float, b: float, shear: float, angle: float) -> None:
    # sum f = 0 and sum x cross f = 0: internal forces move and turn nothing, hourglass forces included
    model = sample(element)
    rough = np.random.default_rng(1).normal(0.0, 0.05 * SIZE, (2, *model.mesh.X.shape))
    u = affine(model.mesh, rotation(angle) @ np.array([[a, shear], [0.0, b]])) + rough
    f = forces(model, u)
    x = u + np.stack([model.mesh.X, model.mesh.Y])
    assert np.abs(f.sum(axis=(1, 2))).max() <= 10 * ROUNDING * SCALE
    assert abs(np.sum(x[0] * f[1] - x[1] * f[0])) <= 100 * ROUNDING * SCALE * SIZE


@pytest.mark.parametrize("element", ELEMENTS)
def test_mirrored_deformation_makes_mirrored_forces(element: str, verified: Verified) -> None:
    # with M = diag(1, -1): u*(X) = M u(M X) gives f*(X) = M f(M X) on a mesh that is its own mirror image
    mesh = distorted(COLUMNS, ROWS, amount=0.0)
    u = np.random.default_rng(2).normal(0.0, 0.05 * SIZE, (2, *mesh.X.shape))
    f = forces(build(mesh, relaxing(bulk=True), element), u)
    mirror = np.diag([1.0, -1.0])
    g = forces(build(mesh, relaxing(bulk=True), element), rotated(mirror, u)[:, ::-1, :])
    verified.error(
        f"forces of the mirrored deformation, {element}",
        largest(g - rotated(mirror, f)[:, ::-1, :]),
        ROUNDING,
    )
