"""Slow compression against the static answer: the minimum of the stored energy, found by an independent Newton method.

The block is compressed between a frictionless and a bonded plate and held. A Prony term damps the motion; it does not
change where it ends, because only the long-term stress is left there.
"""

from __future__ import annotations

import numpy as np
import pytest

from support.ledger import Verified
from support.models import ELEMENTS, K_0, MU_0, RHO, Array, build, history, run
from support.statics import ElasticBlock
from wrinklewave.dynamics.boundary import FIXED, LEFT_MOVED, ROLLER
from wrinklewave.dynamics.drives import compression
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.mesh.block import GridMesh, block

LENGTH, HEIGHT, STRAIN = 50.4e-3, 18.5e-3, 0.15
DAMPED = Viscoelastic(RHO, MU_0, K_0, np.array([5 * MU_0]), np.array([0.0]), np.array([1e-3]))
END = 0.15


def sample() -> GridMesh:
    return block(length=LENGTH, bottom=0.0, top=HEIGHT, elements=(20, 8))


def static_answer(mesh: GridMesh, element: str) -> Array:
    """Equilibrium after load steps of 3 % each, every one starting from the last with a uniform strain added."""
    body = ElasticBlock(mesh, MU_0, K_0, element)
    held = np.zeros((2, *mesh.X.shape), dtype=bool)
    held[0, :, 0] = held[:, :, -1] = held[1, 0, :] = True
    u = np.zeros(held.shape)
    steps = 5
    for _ in range(steps):
        u[0] += STRAIN / steps * (LENGTH - mesh.X)
        u = body.equilibrium(u, held.ravel())
    return u


@pytest.mark.parametrize("element", ELEMENTS)
def test_slow_compression_ends_at_the_static_answer(element: str, verified: Verified) -> None:
    # dE/du = 0 at every free node
    mesh = sample()
    static = static_answer(mesh, element)
    motion = compression(STRAIN * LENGTH, 50e-3, unload=False)
    model = build(mesh, DAMPED, element, left=LEFT_MOVED, right=FIXED, bottom=ROLLER, motion=motion)
    simulation = run(model, np.array([0.0, END]), history_interval=1e-3)
    u = np.stack([model.arrays.u, model.arrays.w])
    error = float(np.abs(u - static).max() / (STRAIN * LENGTH))
    verified.error(f"displacement against the static answer, over the end's, {element}", error, 1e-8)
    body = ElasticBlock(mesh, MU_0, K_0, element)
    exact = float(body.energy(static) - body.hourglass_energy(static))
    stored = float(history(simulation)["elastic_J_per_m"][-1])
    verified.error(
        f"stored energy against the static answer, relative, {element}", abs(stored / exact - 1), 1e-8
    )
    force, reaction = history(simulation)["contact_force_N_per_m"][-1], body.gradient(static)[0, :, 0].sum()
    verified.error(
        f"force of the plate against the static answer, relative, {element}", abs(force / reaction - 1), 1e-6
    )
