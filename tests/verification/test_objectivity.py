"""A superposed rotation rotates the forces, at every moment of a history that the material remembers.

x*(X, t) = R(t) x(X, t) leaves C, and so S and its memory, unchanged; the forces become f* = R f (Simo 1987: the
hereditary integral acts in the reference configuration).
"""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.ledger import Verified
from support.models import ELEMENTS, TAU, Array, affine, build, distorted, forces, relaxing, rotated, rotation

SIZE, STEPS, DT = 1e-3, 6, TAU / 3
MESH = distorted(4, 3, size=SIZE, seed=4)
X = np.stack([MESH.X, MESH.Y])


def history_of_forces(element: str, motion: list[Array]) -> list[Array]:
    """Forces along a motion, given as positions x at equal intervals of time."""
    model = build(MESH, relaxing(bulk=True), element)
    lengths = [0.0] + [DT] * (len(motion) - 1)
    return [forces(model, x - X, dt_last=last, dt=DT) for x, last in zip(motion, lengths, strict=True)]


def moving(seed: int, roughness: float) -> list[Array]:
    """A motion that shears and compresses more and more, uneven by ``roughness`` element sizes."""
    random = np.random.default_rng(seed)
    end = np.array([[1.0, 0.0], [0.0, 1.0]]) + random.uniform(-0.2, 0.2, (2, 2))
    noise = roughness * SIZE * random.normal(size=X.shape)
    return [X + s * (affine(MESH, end) + noise) for s in np.linspace(0.2, 1.0, STEPS)]


def deviation(element: str, motion: list[Array], angles: list[float]) -> float:
    """Largest |f* - R f| over the largest force."""
    turned = [rotated(rotation(angle), x) for angle, x in zip(angles, motion, strict=True)]
    plain, superposed = history_of_forces(element, motion), history_of_forces(element, turned)
    differences = [
        np.abs(g - rotated(rotation(angle), f)).max()
        for angle, f, g in zip(angles, plain, superposed, strict=True)
    ]
    return float(max(differences) / max(np.abs(f).max() for f in plain))


@pytest.mark.parametrize("element", ELEMENTS)
@settings(max_examples=30)
@given(st.integers(0, 2**32 - 1), st.lists(st.floats(-np.pi, np.pi), min_size=STEPS, max_size=STEPS))
def test_rotations_that_change_from_step_to_step_rotate_the_forces(
    element: str, seed: int, angles: list[float]
) -> None:
    assert deviation(element, moving(seed, 0.05), angles) <= 1e-11


@pytest.mark.parametrize("element", ELEMENTS)
def test_objectivity(element: str, verified: Verified) -> None:
    angles = list(np.linspace(0.3, 2.8, STEPS))
    uneven, uniform = (deviation(element, moving(0, roughness), angles) for roughness in (0.05, 0.0))
    verified.error(f"uniform strain: f* - R f over max f, {element}", uniform, 1e-11)
    verified.error(f"uneven strain: f* - R f over max f, {element}", uneven, 1e-11)
