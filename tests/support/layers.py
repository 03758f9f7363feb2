"""Films and substrates of the wrinkling tests: the paper's material."""

from __future__ import annotations

import numpy as np

from wrinklewave.materials.moduli import Viscoelastic, bulk_modulus

MU_0, MU_1, TAU, DENSITY = 44e3, 3.35e6, 90e-6, 965.0
THICKNESS = 0.14e-3
RATIO = 42.06


def solid(
    ratio: float = 1.0, *, relaxes: bool = False, nu: float = 0.49, bulk_relaxes: bool = True
) -> Viscoelastic:
    """The paper's solid, ``ratio`` times as stiff; nu = 0.5 for an incompressible one."""
    K = np.inf if nu == 0.5 else bulk_modulus(ratio * MU_0, nu)
    K_1 = K * MU_1 / MU_0 if bulk_relaxes and nu < 0.5 else 0.0
    n = int(relaxes)
    return Viscoelastic(
        density=DENSITY,
        mu_inf=ratio * MU_0,
        K_inf=K,
        mu_k=np.full(n, ratio * MU_1),
        K_k=np.full(n, K_1),
        tau_k=np.full(n, TAU),
    )
