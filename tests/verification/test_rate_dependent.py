"""The rate-dependent model against its limits: linear growth, Eq. 1, an unloaded block, identities of its parts."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
import pytest

from support.layers import RATIO, THICKNESS, solid
from support.ledger import Verified
from support.references import reference
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.bifurcation import bifurcation
from wrinklewave.theory.growth import fastest_growth, growth_rate
from wrinklewave.theory.plane_strain_relaxation import plane_strain_relaxation
from wrinklewave.wrinkling.block_elements import block_elements
from wrinklewave.wrinkling.block_motion import (
    BlockMotion,
    answer,
    block_motion,
    displacements,
    motion_at_rest,
    motion_step,
    undriven,
)
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude as eq_1
from wrinklewave.wrinkling.rate_dependent import FilmLayer, wrinkle_amplitude
from wrinklewave.wrinkling.rate_dependent_block import Block, wrinkles_on_block

NEARLY_INCOMPRESSIBLE = 0.4999
IMPERFECTION = 1e-8
GROWTH = {
    "elastic film / elastic substrate": (False, False),
    "elastic film / SLS substrate": (False, True),
    "SLS film / SLS substrate (same g, tau)": (True, True),
}


def measured_growth(film: Viscoelastic, substrate: Viscoelastic, wavelength: float, rate: float) -> float:
    """Growth rate [1/s] of a small wrinkle over two of its e-foldings at 8 %, after everything else has died out.

    The compression to 8 % is slow for the material but leaves the wrinkle little time to grow: the last part, above
    the critical strain, is as long as it takes the overstress to relax.
    """
    relaxed = max([0.0, *(15 * substrate.tau_k)])
    hold = relaxed + 6 / rate
    time = np.linspace(0.0, hold, 801)
    ramp = np.clip(time / (0.2 * relaxed + 1 / rate), 0.0, 1.0)
    strain = 0.08 * ramp * ramp * (3 - 2 * ramp)
    amplitude = wrinkle_amplitude(
        time,
        strain[:, np.newaxis],
        film=FilmLayer(THICKNESS, film),
        substrate=substrate,
        wavelength=wavelength,
        imperfection=1e-14,
    )[:, 0]
    late = time > hold - 2 / rate
    return float(np.polyfit(time[late], np.log(amplitude[late]), 1)[0])


@pytest.mark.parametrize("row", reference("wrinkle_growth_rate"), ids=lambda row: row["case"])
def test_small_wrinkles_grow_at_the_exact_rate(row: dict[str, str], verified: Verified) -> None:
    """Linear limit: the rates of films on elastic and viscoelastic half-spaces. Two functions of the depth in place of
    all err by 0.5 % of the half-space's stiffness at 8 %, of which growth is a difference: 3 %."""
    film, substrate = GROWTH[row["case"]]
    exact, wavelength = float(row["growth_rate_1_s"]), 1e-3 * float(row["wavelength_mm"])
    found = measured_growth(
        solid(RATIO, nu=NEARLY_INCOMPRESSIBLE, relaxes=film),
        solid(nu=NEARLY_INCOMPRESSIBLE, relaxes=substrate),
        wavelength,
        exact,
    )
    verified.value(
        f"growth rate in the rate-dependent model, {row['case']}", found, exact, relative=0.03, unit="1/s"
    )


@pytest.mark.parametrize(("factor", "bulk_relaxes"), [(0.8, False), (1.3, True)])
def test_other_wavelengths_and_a_compressible_substrate(
    factor: float, bulk_relaxes: bool, verified: Verified
) -> None:
    film, substrate = solid(RATIO), solid(relaxes=True, bulk_relaxes=bulk_relaxes)
    k = factor * fastest_growth(film, substrate, 0.08, thickness=THICKNESS).wavenumber
    exact = growth_rate(film, substrate, 0.08, k, thickness=THICKNESS)
    found = measured_growth(film, substrate, 2 * np.pi / k, exact)
    bulk = "relaxing" if bulk_relaxes else "elastic"
    verified.value(
        f"growth rate at {factor} of the fastest k, bulk {bulk}", found, exact, relative=0.03, unit="1/s"
    )


@lru_cache
def slow_compression() -> tuple[np.ndarray, np.ndarray, float, float]:
    """Strain, amplitude, critical strain and wavelength of a nearly perfect film, compressed to 20 % in 100 s."""
    film, substrate = solid(RATIO), solid(relaxes=True)
    onset = bifurcation(film, substrate)
    wavelength = THICKNESS * onset.wavelength
    strain = np.linspace(0.0, 0.2, 401)
    amplitude = wrinkle_amplitude(
        500 * strain,
        strain[:, np.newaxis],
        film=FilmLayer(THICKNESS, film),
        substrate=substrate,
        wavelength=wavelength,
        imperfection=IMPERFECTION,
    )
    return strain, amplitude[:, 0], onset.critical_strain, wavelength


def test_slow_wrinkles_are_those_of_eq_1(verified: Verified) -> None:
    """Slow limit of a nearly perfect film: Eq. 1 at the exact critical strain. The substrate softens across itself by
    about its strain, which lets the film's strain fall by up to 2 % of itself: amplitudes above Eq. 1 by up to 1 %."""
    strain, amplitude, critical_strain, wavelength = slow_compression()
    for at in (0.06, 0.08, 0.10, 0.12, 0.16, 0.20):
        expected = float(eq_1(at, critical_strain=critical_strain, critical_wavelength=wavelength))
        found = float(np.interp(at, strain, amplitude))
        verified.value(f"slow amplitude over Eq. 1 at {at}", found / expected, 1.0, relative=0.01)
    assert amplitude[strain < 0.95 * critical_strain].max() < 20 * IMPERFECTION


@pytest.mark.parametrize("row", reference("wrinkle_amplitude"), ids=lambda row: row["strain"])
def test_slow_wrinkles_are_close_to_the_exact_ones(row: dict[str, str], verified: Verified) -> None:
    """Eq. 1 is 0.7 to 1.7 % below the exact static amplitude; the model stays within that."""
    strain, amplitude, _, _ = slow_compression()
    found = float(np.interp(float(row["strain"]), strain, amplitude)) / THICKNESS
    verified.value(f"A/h at {row['strain']}", found, float(row["amplitude_over_h"]), relative=0.017)


def test_imperfections_diverge_at_the_critical_strain(verified: Verified) -> None:
    """Static imperfection below onset: A/A_i -> c/(1 - strain/eps_c), so 1/A falls linearly to zero at eps_c."""
    strain, amplitude, critical_strain, _ = slow_compression()
    near = (strain > 0.85 * critical_strain) & (strain < 0.96 * critical_strain)
    slope, offset = np.polyfit(strain[near], 1 / amplitude[near], 1)
    verified.value(
        "strain at which a growing imperfection diverges", -offset / slope, critical_strain, relative=0.01
    )


def test_second_order_in_time(verified: Verified, monkeypatch: pytest.MonkeyPatch) -> None:
    import wrinklewave.wrinkling.rate_dependent as model

    time = np.linspace(0.0, 2e-3, 401)
    phase = np.clip(time / 0.5e-3, 0.0, 1.0)
    strain = 0.12 * (phase - np.sin(2 * np.pi * phase) / (2 * np.pi))
    ends = []
    for steps in (1, 2, 4, 16):
        monkeypatch.setattr(model, "STEPS_PER_TIME_SCALE", steps)
        monkeypatch.setattr(model, "LEAST_STEPS", 1)
        amplitude = wrinkle_amplitude(
            time,
            strain[:, np.newaxis],
            film=FilmLayer(THICKNESS, solid(RATIO)),
            substrate=solid(relaxes=True),
            wavelength=2e-3,
            imperfection=20e-6,
        )
        ends.append(amplitude[-1, 0])
    errors = [abs(end / ends[-1] - 1) for end in ends[:-1]]
    verified.between(
        "order in time of the rate-dependent model", float(np.log2(errors[0] / errors[1])), 1.7, 2.6
    )
    verified.error("error in time at the default step", errors[2], 1e-3)


def test_relaxing_plane_strain_modulus(verified: Verified) -> None:
    """E' = 4 mu (3 K + mu)/(3 K + 4 mu) with mu(s) and K(s), at every s (correspondence principle)."""
    solid_ = Viscoelastic(
        density=965.0,
        mu_inf=44e3,
        K_inf=2.2e6,
        mu_k=np.array([1e6, 2e5, 3e5]),
        K_k=np.array([3e6, 0.0, 1e5]),
        tau_k=np.array([9e-5, 1e-3, 9e-5]),
    )
    found = plane_strain_relaxation(solid_)
    worst = 0.0
    for s in (1.0, 1e2, 1e3, 1e4, 1e6):
        active = s * solid_.tau_k / (1 + s * solid_.tau_k)
        mu, K = solid_.mu_inf + solid_.mu_k @ active, solid_.K_inf + solid_.K_k @ active
        exact = 4 * mu * (3 * K + mu) / (3 * K + 4 * mu)
        series = found.long_term + found.shares @ (s * found.times / (1 + s * found.times))
        worst = max(worst, abs(series / exact - 1))
    verified.error("relaxing plane-strain modulus", worst, 1e-12)


def block_of(*, step: float, depth: float = 20e-3) -> BlockMotion:
    """A block of 50 mm length."""
    elements = block_elements(length=50e-3, depth=depth, n_cells=96)
    return block_motion(elements, solid(nu=0.49), step=step)


def plane_strain(motion: BlockMotion) -> float:
    mu, K = motion.moduli.mu, motion.moduli.K
    return 4 * mu * (3 * K + mu) / (3 * K + 4 * mu)


def test_surface_of_a_block_pushed_along_itself(verified: Verified) -> None:
    """Half-space under a traction sin kX along its surface: displacement 2/(k E') per traction (Johnson, Contact
    Mechanics). Steps of 1 s: no inertia. The struck end is a plane of mirror symmetry; the elements are of second
    order: 0.5 % at 24 cells per wavelength."""
    motion, k = block_of(step=1.0), 2 * np.pi / 12.5e-3
    elements, every = motion.elements, np.ones(int(motion.elements.end.sum()), dtype=bool)
    X = elements.nodes[:-1]
    on_top = np.array([np.flatnonzero(row > 0)[0] for row in elements.shortening.toarray()])
    pushed = np.zeros(elements.mass.size)
    pushed[on_top] = elements.cell * np.sin(k * X)
    within = answer(motion, motion.solve(pushed), every, gap=0.0)
    u, _ = displacements(motion, within, np.zeros(X.size))
    middle = (X > 12.5e-3) & (X < 37.5e-3)
    waves = np.stack([np.sin(k * X), np.cos(k * X), np.ones(X.size), X], axis=1)[middle]
    found = float(np.linalg.lstsq(waves, u[on_top][middle], rcond=None)[0][0])
    expected = 2 / (k * plane_strain(motion))
    verified.value("motion of a block's surface along itself", found, expected, relative=0.005)


def test_wave_in_a_thin_block(verified: Verified) -> None:
    """A third of the strain behind the front of a thin plate's longitudinal wave travels at sqrt(E'/rho): lateral
    inertia makes the front an integral of Airy's function, which has reached 1/3 where its argument is zero."""
    step, places = 4e-6, np.array([20, 70])
    motion = block_of(step=step, depth=1e-3)
    every = np.ones(int(motion.elements.end.sum()), dtype=bool)
    state, strains = motion_at_rest(motion), []
    for n in range(1, 1000):
        within = answer(motion, undriven(state, motion), every, gap=-0.01 * step * n)
        u, _ = displacements(motion, within, np.zeros(96))
        state = motion_step(state, u, motion)
        strains.append((motion.elements.shortening @ u)[places])
    speed = np.sqrt(plane_strain(motion) / motion.density)
    third = 0.01 / speed / 3
    passed = step * (1 + np.argmax(np.array(strains) > third, axis=0))
    found = float(np.diff(motion.elements.centres[places])[0] / np.diff(passed)[0])
    verified.value("speed of a wave in a thin block", found, float(speed), relative=0.01, unit="m/s")


def test_plate_pushes_the_end_and_never_pulls(verified: Verified) -> None:
    """Nodes of the end that touch are where the plate is; the forces on the others are zero."""
    motion = block_of(step=1e-5)
    force = np.linspace(1.0, 0.0, 96)
    touching = np.zeros(int(motion.elements.end.sum()), dtype=bool)
    touching[-5:] = True
    within = answer(motion, np.zeros(motion.elements.mass.size), touching, gap=1e-4)
    u, pressing = displacements(motion, within, force)
    verified.error(
        "end held by a plate", float(np.abs(u[motion.elements.end][touching] / -1e-4 - 1).max()), 1e-9
    )
    assert (pressing[~touching] == 0.0).all()
    strain = motion.elements.shortening @ u
    np.testing.assert_allclose(strain, within.strain - within.compliance @ force, atol=1e-12)


def test_uniform_strain_between_held_ends_stays_uniform(verified: Verified) -> None:
    """A film force that is the same everywhere does not move the surface: -dN/dX = 0. Block and points then agree."""
    time = np.linspace(0.0, 2e-3, 101)
    X = np.linspace(0.0, 50e-3, 41)
    strain = 0.1 * np.clip(time / 1e-3, 0, 1)[:, np.newaxis] * np.ones(X.size)
    film, substrate = FilmLayer(THICKNESS, solid(RATIO)), solid(relaxes=True)
    seeds = {"film": film, "substrate": substrate, "imperfection": 20e-6}
    on_block = wrinkles_on_block(
        time, X, strain, block=Block(50e-3, 20e-3, 50e-3), wavelengths=[2e-3], **seeds
    )
    at_points = wrinkle_amplitude(time, strain[:, :1], wavelength=2e-3, **seeds)
    verified.error("strain moved by a uniform film", float(np.abs(on_block.strain - strain).max()), 1e-6)
    deviation = float(np.abs(on_block.wrinkles.amplitude / at_points - 1).max())
    verified.error("amplitude on a uniformly strained block", deviation, 1e-4)


def test_film_at_a_free_end_relaxes_into_the_block(verified: Verified) -> None:
    """A stiff film whose end flies free carries no force there, and the block's strain returns far from the end: what
    the end gains, w(0), is what the surface strain has lost, integrated."""
    time = np.linspace(0.0, 20e-3, 201)
    X = np.linspace(0.0, 50e-3, 101)
    strain = 0.03 * np.clip(time / 1e-3, 0, 1)[:, np.newaxis] * np.ones(X.size)  # below onset
    result = wrinkles_on_block(
        time,
        X,
        strain,
        block=Block(50e-3, 20e-3, 50e-3),
        film=FilmLayer(THICKNESS, solid(RATIO)),
        substrate=solid(relaxes=True),
        wavelengths=[2e-3],
        imperfection=0.0,
        gap=1.0,
    )
    end = result.strain[-1]
    assert end[0] < 0.1 * strain[-1, 0]
    assert (np.diff(end[X < 30e-3]) > 0).all()
    assert np.interp(25e-3, X, end) < strain[-1, 0]
    assert np.abs(result.wrinkles.amplitude).max() == 0.0
