"""One element under a prescribed history of strain, against closed forms of the hereditary integral.

S = S_long-term + J^(-2/3) DEV ∫ mu_1 exp(-(t - s)/tau) d/ds DEV[1] ds (+ the same of K_1 J C⁻¹), Cauchy stress from the
nodal forces. The recurrence takes the integrand as linear over a step: exact for a strain held, second-order else.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
import pytest

from support.ledger import Verified, order
from support.models import (
    ELEMENTS,
    K_I,
    MU_0,
    MU_1,
    RHO,
    TAU,
    Array,
    affine,
    build,
    forces,
    relaxing,
    traction_stress,
)
from support.neo_hookean import cauchy
from support.references import reference
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.mesh.block import block

SIZE = 1e-3


def cauchy_stress(
    element: str, material: Viscoelastic, F: Callable[[float], Array], dt: float, steps: int
) -> Iterator[tuple[int, Array]]:
    """Number of the step and Cauchy stress [Pa] of a square of material that follows F(t)."""
    mesh = block(length=SIZE, bottom=0.0, top=SIZE, elements=(1, 1))
    model = build(mesh, material, element)
    for n in range(steps + 1):
        f = forces(model, affine(mesh, F(n * dt)), dt_last=dt if n else 0.0, dt=dt)
        yield n, cauchy(F(n * dt), traction_stress(f, SIZE, SIZE))


def solid(*, bulk_relaxes: bool) -> Viscoelastic:
    """The paper's solid; K relaxes from K_i with the shear, or is K_i at all times."""
    if bulk_relaxes:
        return relaxing(bulk=True)
    return Viscoelastic(RHO, MU_0, K_I, np.array([MU_1]), np.array([0.0]), np.array([TAU]))


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("bulk_relaxes", [True, False])
def test_relaxation_after_a_step(element: str, bulk_relaxes: bool, verified: Verified) -> None:
    # F = diag(0.88, 1) from t = 0: H(t) = H(0) exp(-t/tau), which the recurrence keeps exactly
    rows = [
        row for row in reference("prony_step_uniaxial_strain") if row["bulk_relaxes"] == str(bulk_relaxes)
    ]
    dt, errors = 9e-6, []
    exact = {round(float(row["t_us"]) / 9): row for row in rows}
    assert len(exact) == len(rows)
    for n, sigma in cauchy_stress(
        element, solid(bulk_relaxes=bulk_relaxes), lambda t: np.diag([0.88, 1.0]), dt, 1000
    ):
        if n in exact:
            errors += [
                sigma[0, 0] / float(exact[n]["sigma11_Pa"]) - 1,
                sigma[1, 1] / float(exact[n]["sigma22_Pa"]) - 1,
            ]
    assert len(errors) == 2 * len(rows)
    what = "K relaxing" if bulk_relaxes else "K constant"
    verified.error(
        f"stress from 0 to 100 tau after a step, relative, {what}, {element}",
        float(np.abs(errors).max()),
        1e-11,
    )


@pytest.mark.parametrize("element", ELEMENTS)
def test_shear_at_a_constant_rate(element: str, verified: Verified) -> None:
    # F12 = rate t: sigma12 = mu_0 gamma + mu_1 rate tau (1 - exp(-t/tau)) + O(gamma³), sigma11 = O(gamma²)
    rows = reference("prony_shear_ramp")
    rate = float(rows[0]["rate_1_s"])
    errors = []
    for dt in (5e-6, 2.5e-6, 1.25e-6):
        exact = {round(float(row["t_us"]) * 1e-6 / dt): row for row in rows}
        error = 0.0
        motion = cauchy_stress(
            element, relaxing(bulk=False), lambda t: np.array([[1, rate * t], [0, 1]]), dt, max(exact)
        )
        for n, sigma in motion:
            if n in exact:
                shear = float(exact[n]["sigma12_Pa"])
                found = {"sigma11_Pa": sigma[0, 0], "sigma22_Pa": sigma[1, 1], "sigma12_Pa": sigma[0, 1]}
                error = max(error, *(abs(s - float(exact[n][name])) / shear for name, s in found.items()))
        errors.append(error)
    verified.between(f"order in dt of the stress in a shear ramp, {element}", order(errors), 1.9, 2.1)
    verified.error(f"stress in a shear ramp over shear stress, dt = tau/72, {element}", errors[-1], 1e-6)


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("frequency", [50, 400, 2000])
def test_sinusoidal_shear(element: str, frequency: int, verified: Verified) -> None:
    # F12 = a sin(omega t), steady: sigma12 = a (mu' sin + mu'' cos), mu' = mu_0 + mu_1 (w tau)²/(1 + (w tau)²),
    # mu'' = mu_1 w tau/(1 + (w tau)²), to O(a²)
    rows = [row for row in reference("prony_shear_sine") if float(row["f_Hz"]) == frequency]
    a = float(rows[0]["amplitude"])
    largest = max(abs(float(row["sigma12_steady_Pa"])) for row in rows)
    cycles = int(np.ceil(40 * TAU * frequency))  # what is left of the start has decayed to exp(-40)
    errors = []
    for steps_per_tau in (4, 8, 16):
        eighth = int(np.ceil(max(5, steps_per_tau / (8 * frequency * TAU))))
        dt = 1 / (8 * frequency * eighth)
        exact = {8 * eighth * cycles + round(8 * float(row["phase_of_cycle"]) * eighth): row for row in rows}
        motion = cauchy_stress(
            element,
            relaxing(bulk=False),
            lambda t: np.array([[1, a * np.sin(2 * np.pi * frequency * t)], [0, 1]]),
            dt,
            max(exact),
        )
        found = {n: sigma[0, 1] for n, sigma in motion if n in exact}
        errors.append(max(abs(s - float(exact[n]["sigma12_steady_Pa"])) for n, s in found.items()) / largest)
    # linear interpolation over a step: dt²/12 times the curvature of the shear and of the memory
    limit = ((2 * np.pi * frequency * dt) ** 2 + (dt / TAU) ** 2) / 12
    verified.between(f"order in dt of the stress at {frequency} Hz, {element}", order(errors), 1.9, 2.1)
    verified.error(
        f"stress at {frequency} Hz over its amplitude, dt = {dt * 1e6:.1f} µs, {element}", errors[-1], limit
    )
