"""Onset and growth of wrinkles: the exact incremental problem against closed forms and independent numbers."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import brentq

from support.layers import MU_0, RATIO, THICKNESS, solid
from support.ledger import Verified
from support.references import reference
from wrinklewave.errors import InputError
from wrinklewave.theory.bifurcation import bifurcation, critical_strain, matching_film, surface_stiffness
from wrinklewave.theory.growth import fastest_growth, growth_rate
from wrinklewave.theory.incremental import (
    block_stiffness,
    half_space_stiffness,
    prestressed_layer,
    stroh_matrix,
)
from wrinklewave.theory.wrinkling import depth_factor


@pytest.mark.parametrize("row", reference("bilayer_bifurcation"), ids=lambda row: row["ratio"])
def test_critical_strain_and_wavelength(row: dict[str, str], verified: Verified) -> None:
    """Against independent numbers of two methods each, accurate to 1e-7."""
    ratio = float(row["ratio"])
    found = bifurcation(solid(ratio, nu=0.5), solid(nu=0.5))
    nearly = bifurcation(solid(ratio), solid())
    name = f"film {row['ratio']} times as stiff"
    for what, value, key in (
        ("critical strain, incompressible", found.critical_strain, "eps_c_incompressible"),
        ("k h, incompressible", found.wavenumber, "kh_c_incompressible"),
        ("wavelength over h, undeformed", found.wavelength, "wavelength_over_h_reference"),
        ("wavelength over h, compressed", found.compressed_wavelength, "wavelength_over_h_current"),
        ("critical strain, nu = 0.49", nearly.critical_strain, "eps_c_nu049"),
        ("k h, nu = 0.49", nearly.wavenumber, "kh_c_nu049"),
    ):
        verified.value(f"{name}: {what}", value, float(row[key]), relative=1e-6)


def test_bare_surface_folds_at_biots_strain(verified: Verified) -> None:
    """Incompressible neo-Hookean half-space: x^3 + x^2 + 3 x - 1 = 0 with x = l1^2 (Biot 1963, plane strain)."""

    def determinant(stretch: float) -> float:
        return float(
            np.linalg.det(
                half_space_stiffness(stroh_matrix(prestressed_layer(solid(nu=0.5), stretch, unit=MU_0), 1.0))
            )
        )

    x = np.roots([1.0, 1.0, 3.0, -1.0])
    exact = float(np.sqrt(x[np.isreal(x)].real[0]))
    verified.value(
        "stretch at which a bare surface folds", brentq(determinant, 0.5, 0.6), exact, relative=1e-8
    )


@pytest.mark.parametrize("nu", [0.3, 0.49])
def test_unstrained_surface_is_that_of_an_elastic_half_space(nu: float, verified: Verified) -> None:
    """Z^-1 of an elastic half-space under sinusoidal tractions in plane strain: 2/(k E') for each along itself, and
    (1 - 2 nu)/(2 mu (1 - nu)) (1 - nu)/k = (1 - 2 nu)/(2 mu k) across (Johnson, Contact Mechanics, section 2.5)."""
    layer = prestressed_layer(solid(nu=nu), 1.0, unit=MU_0)
    compliance = np.linalg.inv(half_space_stiffness(stroh_matrix(layer, 1.0)))
    along = (1 - nu) / 1.0  # 2/E' with E' = 2 mu/(1 - nu)
    verified.value(f"compliance along itself, nu = {nu}", compliance[0, 0], along, relative=1e-7)
    verified.value(f"compliance across itself, nu = {nu}", compliance[1, 1], along, relative=1e-7)
    verified.value(f"coupling, nu = {nu}", abs(compliance[0, 1]), (1 - 2 * nu) / 2, relative=1e-6)


@pytest.mark.parametrize("depth", [0.5, 1.0, 3.0])
def test_block_on_a_slipping_base(depth: float, verified: Verified) -> None:
    """Normal stiffness over that of the half-space: (sinh 2w + 2w)/(cosh 2w - 1), w = k d."""
    layer = stroh_matrix(prestressed_layer(solid(), 1.0 - 1e-9, unit=MU_0), 1.0)
    block, half_space = (
        np.linalg.inv(Z)[1, 1] for Z in (block_stiffness(layer, depth), half_space_stiffness(layer))
    )
    verified.value(
        f"depth factor at k d = {depth}",
        half_space / block,
        depth_factor(depth, 0.49, "roller"),
        relative=1e-6,
    )


@pytest.mark.parametrize("depth", [np.inf, 3e-3])
def test_a_film_like_its_substrate_only_makes_it_deeper(depth: float) -> None:
    """Of the same material, on depth d, film and substrate are a block of the depth d + h."""
    strain, k = 0.2, 700.0
    below = stroh_matrix(prestressed_layer(solid(), 1 - strain, unit=MU_0), k)
    whole = (
        half_space_stiffness(below) if np.isinf(depth) else block_stiffness(below, k * (depth + THICKNESS))
    )
    found = surface_stiffness(solid(), solid(), strain, k, thickness=THICKNESS, depth=depth)
    np.testing.assert_allclose(found, whole, rtol=1e-9)


def test_stiff_films_wrinkle_as_the_classical_formula_says(verified: Verified) -> None:
    """eps_c -> (3 E_s/E_f)^(2/3)/4 and k h -> (3 E_s/E_f)^(1/3) as E_f/E_s grows; the next term is of order eps_c."""
    ratio = 1e5
    found = bifurcation(solid(ratio, nu=0.5), solid(nu=0.5))
    strain = (3 / ratio) ** (2 / 3) / 4
    verified.value(
        "critical strain of a film 1e5 times as stiff", found.critical_strain, strain, relative=3 * strain
    )
    verified.value(
        "k h of a film 1e5 times as stiff", found.wavenumber, (3 / ratio) ** (1 / 3), relative=3 * strain
    )


def test_the_matching_film_has_the_measured_critical_strain(verified: Verified) -> None:
    film = matching_film(solid(), solid(), critical_strain=0.043, wavenumber=0.44)
    verified.value(
        "critical strain of the matching film", critical_strain(film, solid(), 0.44), 0.043, relative=1e-10
    )


def test_the_matching_film_relaxes_in_the_same_proportion() -> None:
    given_film = solid(3.0, relaxes=True)
    film = matching_film(given_film, solid(), critical_strain=0.043, wavenumber=0.44)
    assert film.mu_inf > 2 * given_film.mu_inf
    for scaled, first in (
        (film.K_inf, given_film.K_inf), (film.mu_k, given_film.mu_k), (film.K_k, given_film.K_k)
    ):  # fmt: skip
        np.testing.assert_allclose(scaled / film.mu_inf, first / given_film.mu_inf, rtol=1e-12)


CASES = {
    "elastic film / elastic substrate": (False, False),
    "elastic film / SLS substrate": (False, True),
    "SLS film / SLS substrate (same g, tau)": (True, True),
}


@pytest.mark.parametrize("row", reference("wrinkle_growth_rate"), ids=lambda row: row["case"])
def test_fastest_growth(row: dict[str, str], verified: Verified) -> None:
    """Against independent numbers of two methods each, both layers incompressible."""
    film, substrate = CASES[row["case"]]
    found = fastest_growth(
        solid(RATIO, nu=0.5, relaxes=film),
        solid(nu=0.5, relaxes=substrate),
        float(row["strain"]),
        thickness=THICKNESS,
    )
    verified.value(
        f"growth rate, {row['case']}", found.rate, float(row["growth_rate_1_s"]), relative=1e-6, unit="1/s"
    )
    # the rate is stationary there: an error of 1e-6 in it leaves 1e-3 in the wavenumber, the reference's own is 1e-5
    verified.value(
        f"k h of it, {row['case']}", found.wavenumber * THICKNESS, float(row["kh_fastest"]), relative=5e-5
    )


def test_nothing_grows_below_the_critical_strain() -> None:
    film, substrate = solid(RATIO), solid(relaxes=True)
    onset = bifurcation(film, substrate)
    k = onset.wavenumber / THICKNESS
    assert growth_rate(film, substrate, 0.999 * onset.critical_strain, k, thickness=THICKNESS) == 0.0
    assert growth_rate(film, substrate, 1.001 * onset.critical_strain, k, thickness=THICKNESS) > 0.0
    with pytest.raises(InputError, match="no wrinkle grows"):
        fastest_growth(film, substrate, 0.9 * onset.critical_strain, thickness=THICKNESS)


def test_a_soft_film_does_not_wrinkle() -> None:
    with pytest.raises(InputError, match="does not wrinkle"):
        bifurcation(solid(1.1, nu=0.5), solid(nu=0.5))
    with pytest.raises(InputError, match="no film wrinkles"):
        matching_film(solid(), solid(), critical_strain=0.01, wavenumber=0.44)
