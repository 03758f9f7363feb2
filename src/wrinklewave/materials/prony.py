"""Finite-strain linear viscoelasticity with a Prony series, as a recurrence that keeps one number per component.

The overstress of a term with modulus m and relaxation time tau is the hereditary integral

    H(t) = ∫ m exp(-(t - s)/tau) d/ds[shape(s)] ds

of the isochoric stress shape in the reference configuration (Simo 1987). For a shape that is linear over a step dt

    H_{n+1} = a H_n + b (shape_{n+1} - shape_n),   a = exp(-dt/tau),   b = m (1 - a) tau/dt

which is second-order accurate and exact for linear ramps. What is stored is Z_n = a H_n - b shape_n, so that the next
step needs neither the old shape nor the old deformation: H_{n+1} = Z_n + b shape_{n+1}.
"""

from __future__ import annotations

import math

from wrinklewave._jit import scalar, serial


@scalar
def overstress(Z, b, shape):
    """H now, from what the last step left (b belongs to the step just taken)."""
    return Z + b * shape


@scalar
def memory(H, a, b, shape):
    """What the next step needs (a and b belong to the step to come)."""
    return a * H - b * shape


@serial
def step_factors(dt, tau):
    """a and b/m for a step dt [s]; the limit for dt → 0 is 1 and 1."""
    x = dt / tau
    if x < 1e-12:
        return 1.0, 1.0
    return math.exp(-x), -math.expm1(-x) / x
