"""Waves in one-dimensional strain: a row of elements between frictionless guides.

A velocity step on a viscoelastic half-space, small, against the inverse Laplace transform of the exact solution; a
finite one on an elastic half-space, against the jump conditions of the shock.
"""

from __future__ import annotations

import numpy as np
import pytest

from support.ledger import Verified, order
from support.models import ELEMENTS, K_I, MU_0, MU_1, RHO, Array, build, elastic, relaxing, run
from support.references import reference
from wrinklewave.config.drives import VelocityStepDrive
from wrinklewave.dynamics.boundary import LEFT_MOVED, ROLLER
from wrinklewave.dynamics.drives import velocity_step
from wrinklewave.dynamics.fields import STRAIN, XX
from wrinklewave.dynamics.model import Model
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.materials.moduli import Viscoelastic, bulk_modulus, plane_wave_modulus
from wrinklewave.mesh.block import block


def half_space(
    element: str,
    material: Viscoelastic,
    *,
    length: float,
    size: float,
    velocity: float,
    rise_time: float,
    bulk_viscosity: tuple[float, float] = (0.0, 0.0),
) -> Model:
    """A row of square elements whose end moves off at ``velocity`` and never stops."""
    drive = VelocityStepDrive(kind="velocity-step", velocity=f"{velocity} m/s", rise_time=f"{rise_time} s")
    return build(
        block(length=length, bottom=0.0, top=size, elements=(round(length / size), 1)),
        material,
        element,
        left=LEFT_MOVED,
        right=ROLLER,
        top=ROLLER,
        bottom=ROLLER,
        motion=velocity_step(drive),
        bulk_viscosity=bulk_viscosity,
    )


def to_nodes(values: Array) -> Array:
    """Mean of the adjacent elements of a row; the end node's by linear extrapolation."""
    inner = 0.5 * (values[1:] + values[:-1])
    return np.concatenate([[1.5 * values[0] - 0.5 * values[1]], inner, [values[-1]]])


V_SMALL = 1e-3  # strain 3e-6: the finite-strain terms are as small
BEHIND_THE_FRONT = 6e-3
C_INSTANTANEOUS = float(np.sqrt(plane_wave_modulus(MU_0 + MU_1, K_I) / RHO))


def viscoelastic_wave_errors(element: str, size: float, t_us: float) -> dict[str, Array]:
    """Errors of velocity, strain and stress at the table's places behind the front, over their values at the end.

    A rise along half a cosine of T = 48 h/c keeps the grid from ringing. The wave is that of the step, T/2 later,
    convolved with a symmetric pulse of width T: an error of O(T²) = O(h²).
    """
    rise, spread = 48 * size / C_INSTANTANEOUS, 2 * size / C_INSTANTANEOUS
    model = half_space(
        element, relaxing(bulk=True), length=48e-3, size=size, velocity=V_SMALL, rise_time=rise
    )
    t = t_us * 1e-6 + rise / 2
    simulation = Simulation(model, np.array([0.0, t - spread, t, t + spread]))
    u = []
    for event in simulation.run():
        u.append(model.arrays.u[0].copy())
        if event.time == t:
            fields = simulation.fields()
    found = {
        "v_over_V0": (u[3] - u[1]) / (2 * spread) / V_SMALL,
        "strain_per_V0_s_per_m": to_nodes(fields[STRAIN, 0]) / V_SMALL,
        "stress_per_V0_Pa_s_per_m": to_nodes(-fields[XX, 0]) / V_SMALL,
    }
    front = C_INSTANTANEOUS * t_us * 1e-6
    rows = [row for row in reference("plane_viscoelastic_wave") if float(row["t_us"]) == t_us]
    behind = [row for row in rows if float(row["x_mm"]) * 1e-3 < front - BEHIND_THE_FRONT]
    nodes = np.array([round(float(row["x_mm"]) * 1e-3 / size) for row in behind])
    exact = {name: np.array([float(row[name]) for row in behind]) for name in found}
    return {name: np.abs(found[name][nodes] - exact[name]) / exact[name][0] for name in found}


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("t_us", [50.0, 100.0])
def test_viscoelastic_wave(element: str, t_us: float, verified: Verified) -> None:
    # rho v_t = -sigma_x, eps_t = -v_x, sigma = ∫ M(t - s) eps_s ds, v(0, t) = V H(t); front at sqrt(M_i/rho) t
    sizes = (1e-3 / 8, 1e-3 / 16, 1e-3 / 32)
    errors = [viscoelastic_wave_errors(element, size, t_us) for size in sizes]
    for name, finest in errors[-1].items():
        assert finest.size >= 10
        quantity = name.split("_")[0].replace("v", "velocity")
        what = f"{quantity} behind a viscoelastic front, {t_us:g} µs, h = 1/32 mm, {element}"
        verified.error(what, float(finest.max()), 1e-4)
    # the order shows where the little ringing that is left near the front has not been
    stress = [float(error["stress_per_V0_Pa_s_per_m"][:6].max()) for error in errors]
    verified.between(f"order in h of the viscoelastic wave, {t_us:g} µs, {element}", order(stress), 1.8, 2.2)


@pytest.mark.parametrize("element", ELEMENTS)
def test_finite_shock(element: str, verified: Verified) -> None:
    # Jump conditions: V = U (1 - stretch), -P = rho U V, P(stretch) of the neo-Hookean solid in uniaxial strain
    (row,) = reference("shock_neo_hookean")
    V, exact_stretch, exact_speed = float(row["V"]), float(row["stretch"]), float(row["front_or_head_speed"])
    nu = 0.30
    material = elastic(MU_0, bulk_modulus(MU_0, nu))
    assert np.sqrt(plane_wave_modulus(MU_0, material.K_inf) / RHO) == pytest.approx(
        float(row["c_linear"]), rel=1e-12
    )
    length, n = 50e-3, 400
    size = length / n
    model = half_space(
        element,
        material,
        length=length,
        size=size,
        velocity=V,
        rise_time=8 * size / exact_speed,
        bulk_viscosity=(0.06, 1.2),
    )
    early, late = 0.3 * length / exact_speed, 0.8 * length / exact_speed
    simulation = run(model, [0.0, early])
    middle = 0.5 * (1 - exact_stretch)

    def front() -> float:
        strain = simulation.fields()[STRAIN, 0]
        k = int(np.flatnonzero(strain > middle)[-1])
        return size * (k + 0.5 + (strain[k] - middle) / (strain[k] - strain[k + 1]))

    start = front()
    simulation.events = np.append(simulation.events, late)
    for _ in simulation.run():
        pass
    speed = (front() - start) / (late - early)
    strain = simulation.fields()[STRAIN, 0]
    plateau = strain[round(0.2 * n) : round(0.7 * n)]
    stress = simulation.fields()[XX, 0][round(0.2 * n) : round(0.7 * n)]
    # the front is located to a tenth of an element over 200 elements: 0.05 %
    verified.value(f"shock front speed, {element}", speed, exact_speed, relative=5e-4, unit="m/s")
    verified.value(
        f"stretch behind the shock, {element}", 1 - float(plateau.mean()), exact_stretch, relative=1e-4
    )
    verified.error(f"unevenness of the stretch behind the shock, {element}", float(np.ptp(plateau)), 1e-3)
    verified.value(
        f"stress behind the shock, {element}",
        float(stress.mean()),
        float(row["nominal_stress_Pa"]),
        relative=5e-4,
        unit="Pa",
    )
