"""Rayleigh waves: the speed of a standing one, between frictionless guides half a wavelength apart.

With p² = k² - (c k/c_L)², s² = k² - (c k/c_T)² and y <= 0 below the surface, the displacements

    u_x = (-k e^(py) + 2 k p s/(s² + k²) e^(sy)) sin kx,   u_y = (p e^(py) - 2 k² p/(s² + k²) e^(sy)) cos kx

leave y = 0 free of traction if c = c_R, the guides' condition u_x = 0 holds at kx = 0 and pi, and the wave swings as
cos(c_R k t). The block is 4 wavelengths deep, where e^(sy) is below 1e-3 and its square, which is what matters, 1e-6.
"""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from support.ledger import Verified, order
from support.models import ELEMENTS, MU_0, RHO, Array, build, elastic
from support.references import reference
from wrinklewave.dynamics.boundary import LEFT_MOVED, ROLLER
from wrinklewave.dynamics.simulation import Simulation
from wrinklewave.materials.moduli import bulk_modulus, plane_wave_modulus
from wrinklewave.mesh.block import GridMesh, block

WAVELENGTH, DEPTH = 10e-3, 40e-3
AMPLITUDE = 1e-5 * WAVELENGTH  # strain 6e-5: its square does not show
K = 2 * np.pi / WAVELENGTH


def standing_wave(mesh: GridMesh, c: float, c_T: float, c_L: float) -> Array:
    """Displacements of the wave at their largest, 1 across the surface, shape [2, n_rows + 1, n_columns + 1]."""
    p, s = K * np.sqrt(1 - (c / c_L) ** 2), K * np.sqrt(1 - (c / c_T) ** 2)
    deep, shallow = np.exp(p * mesh.Y), 2 * K * p / (s**2 + K**2) * np.exp(s * mesh.Y)
    u = (-K * deep + s * shallow) * np.sin(K * mesh.X)
    w = (p * deep - K * shallow) * np.cos(K * mesh.X)
    return np.stack([u, w]) / np.abs(w).max()


def measured_speed(element: str, nu: float, expected: float, columns: int) -> float:
    """Speed of the wave over that of shear waves, from a cosine fitted to two periods of its swing."""
    material = elastic(MU_0, bulk_modulus(MU_0, nu))
    c_T, c_L = np.sqrt(MU_0 / RHO), np.sqrt(plane_wave_modulus(MU_0, material.K_inf) / RHO)
    mesh = block(
        length=WAVELENGTH / 2, bottom=-DEPTH, top=0.0, elements=(columns, 4 * columns), grading=(1.0, 0.25)
    )
    model = build(mesh, material, element, left=LEFT_MOVED, right=ROLLER, bottom=ROLLER)
    mode = standing_wave(mesh, expected * c_T, c_T, c_L)
    a = model.arrays
    a.u[:], a.w[:] = AMPLITUDE * mode
    t = np.linspace(0, 2 * WAVELENGTH / (expected * c_T), 81)
    swing = np.array(
        [
            np.sum((mode[0] * a.u + mode[1] * a.w) / a.inverse_mass)
            for _ in Simulation(model, t, history_interval=1.0).run()
        ]
    )
    fit = least_squares(
        lambda q: q[0] * np.cos(q[1] * c_T * K * t) - swing / swing[0],
        [1.0, expected],
        xtol=1e-12,
        ftol=1e-12,
    )
    return float(fit.x[1])


@pytest.mark.parametrize("element", ELEMENTS)
@pytest.mark.parametrize("nu", [0.3, 0.49])
def test_rayleigh_speed(element: str, nu: float, verified: Verified) -> None:
    # c_R: (2 - c²/c_T²)² = 4 sqrt(1 - c²/c_T²) sqrt(1 - c²/c_L²)
    (exact,) = (float(row["cR_over_cT"]) for row in reference("rayleigh_speed") if float(row["nu"]) == nu)
    meshes = (8, 16, 32)
    found = [measured_speed(element, nu, exact, columns) for columns in meshes]
    errors = [abs(speed / exact - 1) for speed in found]
    # a plane wave on a grid is slow by (k h)²/24; this one has components along both directions
    limit = (K * WAVELENGTH / 2 / meshes[-1]) ** 2 / 12
    verified.between(f"order in h of the Rayleigh speed, nu = {nu}, {element}", order(errors), 1.8, 2.2)
    verified.value(
        f"c_R/c_T, 64 elements per wavelength, nu = {nu}, {element}", found[-1], exact, relative=limit
    )
    extrapolated = found[-1] + (found[-1] - found[-2]) / 3
    verified.value(
        f"c_R/c_T, extrapolated to h = 0, nu = {nu}, {element}", extrapolated, exact, relative=limit / 10
    )
