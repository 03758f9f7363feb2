"""The estimated stable step against the exact one, 2/omega_max, omega_max² the largest eigenvalue of M⁻¹ K.

The stiffness K = d²E/du² of the deformed body is that of the independent energy, with the instantaneous moduli. The
estimate may not exceed the exact step, and should not waste more than a third of it on a body that is evenly strained.
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.sparse import diags_array
from scipy.sparse.linalg import eigsh

from support.ledger import Verified
from support.models import (
    ELEMENTS,
    K_0,
    K_I,
    MU_0,
    MU_1,
    Array,
    affine,
    build,
    distorted,
    elastic,
    rotation,
    stable_step,
)
from support.statics import ElasticBlock
from wrinklewave.mesh.block import GridMesh, block

MODULI = {"nu = 0.49": (MU_0, K_0), "K_0 and instantaneous mu": (MU_0 + MU_1, K_0), "K_i": (MU_0 + MU_1, K_I)}
STATES = {
    "at rest": np.eye(2),
    "compressed": np.diag([0.7, 1.1]),
    "sheared": np.array([[1.0, 0.5], [0.0, 1.0]]),
    "stretched and turned": rotation(1.0) @ np.diag([1.4, 0.8]),
}


def ratio(mesh: GridMesh, mu: float, K: float, u: Array, element: str) -> float:
    """Estimated over exact stable step."""
    model = build(mesh, elastic(mu, K), element)
    model.arrays.u[:], model.arrays.w[:] = u
    stiffness = ElasticBlock(mesh, mu, K, element).stiffness(u)
    scale = diags_array(np.sqrt(np.tile(model.arrays.inverse_mass.ravel(), 2)))
    omega2 = eigsh(scale @ stiffness @ scale, k=1, which="LA", return_eigenvectors=False)[0]
    return stable_step(model) / (2 / np.sqrt(omega2))


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("moduli", MODULI)
def test_estimate_against_the_exact_step(element: str, moduli: str, verified: Verified) -> None:
    meshes = {
        "squares": block(length=12e-3, bottom=0.0, top=12e-3, elements=(12, 12)),
        "3:1": block(length=36e-3, bottom=0.0, top=12e-3, elements=(12, 12)),
    }
    for state, F in STATES.items():
        found = [ratio(mesh, *MODULI[moduli], affine(mesh, F), element) for mesh in meshes.values()]
        verified.between(
            f"estimated over exact stable step, {state}, {moduli}, {element}", min(found), 0.6, 1.0
        )
        verified.between(
            f"the same, largest of squares and 3:1, {state}, {moduli}, {element}", max(found), 0.6, 1.0
        )


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("moduli", MODULI)
def test_estimate_is_safe_on_distorted_and_uneven_bodies(
    element: str, moduli: str, verified: Verified
) -> None:
    worst = 0.0
    for seed in range(6):
        mesh = distorted(8, 6, seed=seed)
        random = np.random.default_rng(seed)
        for F in STATES.values():
            u = affine(mesh, F) + random.normal(0.0, 0.03e-3, (2, *mesh.X.shape))
            worst = max(worst, ratio(mesh, *MODULI[moduli], u, element))
    verified.error(
        f"largest estimated over exact stable step, uneven bodies, {moduli}, {element}", worst, 1.0
    )


@settings(max_examples=60)
@given(st.floats(0.5, 1.6), st.floats(0.5, 1.6), st.floats(-0.5, 0.5), st.sampled_from(list(MODULI.values())))
def test_estimate_is_safe_in_any_even_deformation(
    along: float, across: float, shear: float, moduli: tuple[float, float]
) -> None:
    mesh = block(length=6e-3, bottom=0.0, top=6e-3, elements=(6, 6))
    u = affine(mesh, np.array([[along, shear], [0.0, across]]))
    for element in ELEMENTS:
        assert 0.5 < ratio(mesh, *moduli, u, element) < 1.0 + 1e-9
