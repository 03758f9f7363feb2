"""A film in the mesh against exact solutions: beams, onset of wrinkling, growth of wrinkles, symmetry, energy.

A cell half a wrinkle wide between frictionless guides holds one mode of wrinkling, cos(pi X / width), and everything
that is known in closed form about a compressed film on a half-space applies to it.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from scipy.linalg import eigvals
from scipy.optimize import brentq

from support.ledger import Verified, order
from wrinklewave.dynamics.boundary import FREE, LEFT_MOVED, ROLLER, Boundary
from wrinklewave.dynamics.model import Model, assemble
from wrinklewave.dynamics.step import advance
from wrinklewave.experiments.simulate import simulate
from wrinklewave.materials.moduli import (
    Viscoelastic,
    bulk_modulus,
    plane_strain_modulus,
    youngs_modulus,
)
from wrinklewave.mesh.bilayer import FILM, SUBSTRATE, bilayer
from wrinklewave.mesh.block import GridMesh
from wrinklewave.theory.bifurcation import critical_strain
from wrinklewave.theory.growth import growth_rate
from wrinklewave.theory.incremental import (
    film_transfer,
    prestressed_layer,
    stroh_matrix,
    transverse_stretch,
)

NU, H = 0.49, 0.14e-3
RATIO = 42.06


def solid(mu: float, *, relaxing: float = 0.0) -> Viscoelastic:
    """Neo-Hookean of long-term shear modulus ``mu``, with one Prony term of ``relaxing`` if it is not zero."""
    shares = np.array([relaxing] if relaxing else [])
    return Viscoelastic(965.0, mu, bulk_modulus(mu, NU), shares, 0 * shares, 0 * shares + 90e-6)


SUBSTRATE_ELASTIC, FILM_ELASTIC = solid(44e3), solid(RATIO * 44e3)
SUBSTRATE_SLS = solid(44e3, relaxing=3.35e6)
FILM_SLS = solid(RATIO * 44e3, relaxing=RATIO * 3.35e6)


def cell(
    film: Viscoelastic,
    substrate: Viscoelastic,
    *,
    width: float,
    depth: float,
    strain: float,
    columns: int = 16,
    film_rows: int = 4,
    substrate_rows: int = 20,
    grading: float = 0.05,
    bottom: int = ROLLER,
) -> Model:
    """A cell held at a uniform compression, flat, in equilibrium and fully relaxed."""
    mesh = bilayer(
        length=width,
        bottom=-depth,
        top=H,
        thickness=H,
        columns=columns,
        substrate_rows=substrate_rows,
        film_rows=film_rows,
        grading=(1.0, grading),
    )
    held = strain * width
    boundary = Boundary(
        left=LEFT_MOVED,
        right=ROLLER,
        top=FREE,
        bottom=bottom,
        wall=False,
        length=width,
        friction=0.0,
        motion=np.array([[0.0, 1.0, held, held, 0.0, 0.0]]),
        motion_across=np.zeros((1, 6)),
        old=np.zeros((3, 4, max(mesh.X.shape))),
    )
    model = assemble(mesh, [substrate, film], boundary, bulk_viscosity=(0.0, 0.0))
    compress(model, strain)
    return model


def compress(model: Model, strain: float) -> None:
    """Put a flat, relaxed compression into the state: uniform stretches (l1, l2), l2 such that S22 = 0."""
    a, l1 = model.arrays, 1.0 - strain
    stretches = [transverse_stretch(l1, m.mu_inf, m.K_inf) for m in model.materials]
    a.u[:] = strain * (model.boundary.length - a.X)
    l2 = np.where(model.mesh.Y[:, 0] > 0, stretches[FILM], stretches[SUBSTRATE])
    base = np.where(model.mesh.Y[:, 0] > 0, 0.0, model.mesh.Y[0, 0])
    a.w[:] = ((l2 - 1) * (model.mesh.Y[:, 0] - base))[:, None]
    a.w[model.mesh.Y > 0] += (stretches[SUBSTRATE] - 1) * -model.mesh.Y[0, 0]
    relax(model)


def relax(model: Model) -> None:
    """Make the present state one without overstress: H = Z + mu_k shape = 0 in every component of the memory.

    mu_k is b for the step of length zero that led here; the shapes are DEV[1] and the hourglass displacements.
    """
    a = model.arrays

    def corners(field: np.ndarray) -> list[np.ndarray]:
        return [field[:-1, :-1], field[:-1, 1:], field[1:, 1:], field[1:, :-1]]

    (x1, x2, x3, x4), (y1, y2, y3, y4) = corners(a.X), corners(a.Y)
    double_area = (x1 - x3) * (y2 - y4) - (x2 - x4) * (y1 - y3)

    def gradient(field: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Both derivatives at the centre, and what is left in the hourglass pattern."""
        f1, f2, f3, f4 = corners(field)
        along = ((y2 - y4) * (f1 - f3) - (y1 - y3) * (f2 - f4)) / double_area
        across = ((x1 - x3) * (f2 - f4) - (x2 - x4) * (f1 - f3)) / double_area
        return along, across, f1 - f2 + f3 - f4 - (x1 - x2 + x3 - x4) * along - (y1 - y2 + y3 - y4) * across

    (F11, F12, qx), (F21, F22, qy) = gradient(a.u), gradient(a.w)
    F11, F22 = 1 + F11, 1 + F22
    C11, C22, C12 = F11**2 + F21**2, F12**2 + F22**2, F11 * F12 + F21 * F22
    third, J2 = (C11 + C22 + 1) / 3, C11 * C22 - C12**2
    shapes = (1 - third * C22 / J2, 1 - third * C11 / J2, third * C12 / J2, 1 - third, qx, qy)
    for layer, material in enumerate(model.materials):
        inside = model.mesh.layer == layer
        for m, mu in enumerate(material.mu_k):
            for component, shape in enumerate(shapes):
                model.memory[len(shapes) * m + component][inside] = -mu * shape[inside]


def softest_squared_frequency(model: Model) -> float:
    """Lowest eigenvalue [1/s²] of the mesh about its state, among motions u = U(Y) sin kX, w = V(Y) cos kX.

    The columns are alike, so the mesh has exactly such modes. Accelerations are differenced by U and V row by row.
    """
    a, mesh = model.arrays, model.mesh
    state, memory = (a.u.copy(), a.w.copy()), model.memory.copy()
    kX, middle = np.pi / model.boundary.length * mesh.X[0], mesh.shape[1] // 2
    shapes = (np.sin(kX), np.cos(kX))
    dt, step = 1e-9, 1e-6 * H
    first = 1 if model.boundary.bottom == ROLLER else 0

    def acceleration(row: int, direction: int, sign: float) -> np.ndarray:
        a.u[:], a.w[:] = state
        model.memory[:] = memory
        a.vx[:], a.vy[:] = 0.0, 0.0
        (a.u, a.w)[direction][row] += sign * step * shapes[direction]
        advance(1, 0.0, 0.0, dt, a, model.memory_rows, model.terms, model.boundary, np.zeros(7))
        return np.concatenate([a.vx[:, middle], a.vy[first:, 0]]) / (0.5 * dt)

    rows = mesh.X.shape[0]
    motions = [(row, 0) for row in range(rows)] + [(row, 1) for row in range(first, rows)]
    A = [(acceleration(*motion, -1.0) - acceleration(*motion, 1.0)) / (2 * step) for motion in motions]
    return float(eigvals(np.column_stack(A)).real.min())


def measured_growth(model: Model, *, time: float, dt: float) -> float:
    """Rate [1/s] at which a small wrinkle grows, from the last third of ``time`` [s]."""
    a, mesh = model.arrays, model.mesh
    k = np.pi / model.boundary.length
    mode = np.cos(k * mesh.X[-1])
    a.w[:] += 1e-7 * H * np.cos(k * mesh.X) * np.exp(k * np.minimum(mesh.Y, 0.0))
    relax(model)
    flat, n, heights = a.w[-1].mean(), int(time / dt / 60), []
    last = 0.0
    for group in range(60):
        advance(n, group * n * dt, last, dt, a, model.memory_rows, model.terms, model.boundary, np.zeros(7))
        last = dt
        heights.append(np.average((a.w[-1] - flat) * mode, weights=np.r_[0.5, np.ones(mode.size - 2), 0.5]))
    late = np.arange(40, 60)
    return float(np.polyfit(late * n * dt, np.log(np.abs(np.array(heights)[late])), 1)[0])


def test_film_and_layer_bend_as_a_composite_beam(verified: Verified) -> None:
    """B k^4 = rho h omega^2 (1 + shear and rotary terms of order (k h)^2, here 2 %), with B of two bonded layers
    of plane strain moduli E_i: B = sum E_i [h_i^3/12 + h_i (y_i - y_n)^2], y_n the neutral axis. Four one-point
    elements through each layer are too soft by 1/16 at most without hourglass control."""
    width, depth = 6e-3, H
    film, layer = solid(RATIO / 4 * 44e3), SUBSTRATE_ELASTIC
    beam = cell(
        film,
        layer,
        width=width,
        depth=depth,
        strain=0.0,
        columns=96,
        substrate_rows=4,
        grading=1.0,
        bottom=FREE,
    )
    E = np.array([plane_strain_modulus(youngs_modulus(m.mu_inf, NU), NU) for m in (layer, film)])
    y, h = np.array([-depth / 2, H / 2]), np.array([depth, H])
    axis = (E * h * y).sum() / (E * h).sum()
    B = (E * (h**3 / 12 + h * (y - axis) ** 2)).sum()
    expected = B * (np.pi / width) ** 4 / (965.0 * h.sum())
    found = softest_squared_frequency(beam)
    verified.value("squared frequency of a bending bilayer", found, expected, relative=0.06, unit="1/s²")


def test_film_alone_buckles(verified: Verified) -> None:
    """A strip free above and below buckles where the tractions on its underside vanish for some (U, V): det E_21 = 0
    of the exact transfer matrix; near (k h)^2/12. Eight elements through the strip err by 1/64 in bending."""
    width = 10e-3
    k, alike = np.pi / width, solid(RATIO * 44e3)

    def lowest(strain: float) -> float:
        size = {"columns": 192, "substrate_rows": 4, "grading": 1.0, "bottom": FREE}
        return softest_squared_frequency(cell(alike, alike, width=width, depth=H, strain=strain, **size))

    def underside(strain: float) -> float:
        layer = prestressed_layer(alike, 1 - strain, unit=alike.mu_inf)
        return float(np.linalg.det(film_transfer(stroh_matrix(layer, k), 2 * k * H)[2:, :2]))

    classical = (2 * k * H) ** 2 / 12
    exact = brentq(underside, 0.5 * classical, 1.5 * classical, xtol=1e-9)
    assert exact == pytest.approx(classical, rel=0.02)
    measured = brentq(lowest, 0.9 * exact, 1.1 * exact, xtol=1e-3 * exact)
    verified.value("buckling strain of a film alone", measured, exact, relative=0.02)


def test_onset_converges_with_elements_along_the_film(verified: Verified) -> None:
    """A wrinkle's curvature is followed in straight pieces: the error falls as the square of their length. Sixteen
    elements through the film, so that they do not matter beside it."""
    kh = 0.3844666307822207
    width = np.pi * H / kh
    exact = critical_strain(FILM_ELASTIC, SUBSTRATE_ELASTIC, kh)
    errors = {}
    for per_wavelength in (16, 32):
        size = {"film_rows": 16, "columns": per_wavelength // 2, "substrate_rows": 40}

        def lowest(strain: float, size: dict[str, int] = size) -> float:
            model = cell(FILM_ELASTIC, SUBSTRATE_ELASTIC, width=width, depth=2 * width, strain=strain, **size)
            return softest_squared_frequency(model)

        errors[per_wavelength] = brentq(lowest, 0.85 * exact, 1.2 * exact, xtol=1e-4 * exact) / exact - 1
        verified.between(
            f"onset over exact, {per_wavelength} elements per wavelength",
            1 + errors[per_wavelength],
            1.0,
            1.12,
        )
    verified.between(
        "order of the onset in the elements along the film", order(list(errors.values())), 1.7, 2.5
    )


@pytest.mark.parametrize("wavelengths", [0.25, 0.5])
def test_onset_on_a_shallow_block(wavelengths: float, verified: Verified) -> None:
    """det Z = 0 of a film on a block whose base slips without rising. The mesh is that of four elements per film."""
    kh = 0.3844666307822207
    width = np.pi * H / kh
    depth = 2 * wavelengths * width

    def lowest(strain: float) -> float:
        return softest_squared_frequency(
            cell(FILM_ELASTIC, SUBSTRATE_ELASTIC, width=width, depth=depth, strain=strain, grading=0.2)
        )

    exact = critical_strain(FILM_ELASTIC, SUBSTRATE_ELASTIC, kh, depth=depth / H)
    measured = brentq(lowest, 0.9 * exact, 1.1 * exact, xtol=1e-3 * exact)
    verified.value(f"onset on a block of {wavelengths:g} wavelengths", measured, exact, relative=0.02)


@pytest.mark.parametrize(("film_rows", "tolerance"), [(4, 0.02), (8, 0.005)])
def test_wrinkles_begin_at_the_exact_bifurcation(
    film_rows: int, tolerance: float, verified: Verified
) -> None:
    """The lowest squared frequency of the compressed cell passes zero where det Z(strain, k h) = 0, at the critical
    wavenumber k h = 0.3845. The film's bending stiffness errs by 1/n^2 at most, the strain by a third of it."""
    kh = 0.3844666307822207
    width = np.pi * H / kh

    def lowest(strain: float) -> float:
        size = {"film_rows": film_rows, "columns": 4 * film_rows, "substrate_rows": 5 * film_rows}
        model = cell(FILM_ELASTIC, SUBSTRATE_ELASTIC, width=width, depth=2 * width, strain=strain, **size)
        return softest_squared_frequency(model)

    exact = critical_strain(FILM_ELASTIC, SUBSTRATE_ELASTIC, kh)
    assert exact == pytest.approx(0.04186353336666758, rel=1e-6)
    measured = brentq(lowest, 0.9 * exact, 1.1 * exact, xtol=1e-3 * exact)
    what = f"onset of wrinkling, {film_rows} elements through the film"
    verified.value(what, measured, exact, relative=tolerance)


@pytest.mark.parametrize(
    ("film", "substrate", "kh", "time"),
    [
        (FILM_ELASTIC, SUBSTRATE_ELASTIC, 0.6528, 0.15e-3),
        (FILM_ELASTIC, SUBSTRATE_SLS, 0.5073, 4e-3),
        (FILM_SLS, SUBSTRATE_SLS, 0.35395, 6e-3),
    ],
    ids=["elastic on elastic", "elastic on SLS", "SLS on SLS"],
)
def test_wrinkles_grow_at_the_exact_rate(
    film: Viscoelastic, substrate: Viscoelastic, kh: float, time: float, verified: Verified
) -> None:
    """exp(s t) with s the root of det Z(strain, k h, s) = 0, inertia and relaxing moduli included, at 8 %
    compression and the wavenumber that grows fastest. On the paper case's mesh the onset errs by 1 %, and the
    rate by as much times eps_c / (eps - eps_c)."""
    strain, width = 0.08, np.pi * H / kh
    size = {"columns": 2 * round(width / 110e-6), "substrate_rows": 24}
    model = cell(film, substrate, width=width, depth=2.5 * width, strain=strain, **size)
    exact = growth_rate(film, substrate, strain, kh / H, thickness=H)
    dt = 35e-9 if film.mu_k.size else 70e-9
    rate = measured_growth(model, time=time, dt=dt)
    verified.value("growth rate of wrinkles at 8 % compression", rate, exact, relative=0.03, unit="1/s")


def test_upper_half_is_the_full_block_with_a_film_on_both_sides(verified: Verified) -> None:
    """u_y = 0 at mid-height of a symmetric block, by symmetry; the same arithmetic, so to rounding."""
    size = {"columns": 12, "substrate_rows": 6, "film_rows": 2, "thickness": H, "length": 2e-3}
    half = bilayer(bottom=0.0, top=1e-3, **size)
    full = GridMesh(
        X=np.vstack([half.X[:0:-1], half.X]),
        Y=np.vstack([-half.Y[:0:-1], half.Y]),
        layer=np.vstack([half.layer[::-1], half.layer]),
    )
    ramp = np.array([[0.0, 20e-6, 0.0, 1e-4, 0.0, 10.0]])
    boundary = Boundary(
        LEFT_MOVED, 1, FREE, ROLLER, True, 2e-3, 0.0, ramp, np.zeros((1, 6)), np.zeros((3, 4, 20))
    )
    models = [
        assemble(half, [SUBSTRATE_SLS, FILM_ELASTIC], boundary),
        assemble(
            full, [SUBSTRATE_SLS, FILM_ELASTIC], boundary._replace(bottom=FREE, old=np.zeros((3, 4, 20)))
        ),
    ]
    for m in models:
        advance(1500, 0.0, 0.0, 20e-9, m.arrays, m.memory_rows, m.terms, m.boundary, np.zeros(7))
    rows = half.X.shape[0]
    upper, whole = (m.arrays for m in models)
    assert np.abs(upper.w).max() > 1e-5  # it bulges
    largest = max(np.abs(getattr(whole, name)[-rows:] - getattr(upper, name)).max() for name in "uw")
    verified.error("upper half beside the full block, with film [m]", float(largest), 1e-12)


def test_gap_before_the_held_end_is_of_substrate() -> None:
    """Film area = thickness times (length - gap)."""
    mesh = bilayer(
        length=10e-3,
        bottom=0.0,
        top=2e-3,
        thickness=H,
        columns=100,
        substrate_rows=5,
        film_rows=3,
        end_gap=1e-3,
    )
    assert mesh.areas()[mesh.layer == FILM].sum() == pytest.approx(H * 9e-3)


def test_energy_balance_of_an_impact_with_a_film(verified: Verified) -> None:
    """External work = what is stored, moving and lost, within 0.5 %, in the paper's impact on a coarse mesh."""
    case = Path(__file__).parents[2] / "examples" / "paper_resolved.toml"
    coarse = ("mesh.elements=[200, 16]", "solver.end_time=0.4 ms", "analysis.times=[]", "film.end_gap=1 mm")
    with pytest.warns(UserWarning, match="elements along the film"):
        run = simulate(case, overrides=coarse, threads=1)
    verified.error("energy imbalance of an impact with a film", run.summary["energy_imbalance_max"], 0.005)
    assert run.surface is not None
    assert float(run.surface["amplitude"].isel(time=0).max()) == pytest.approx(30e-6, rel=0.2)
