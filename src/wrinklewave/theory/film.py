"""The film of a case: its modulus, and when it wrinkles, from what the case file gives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.errors import InputError
from wrinklewave.materials.moduli import (
    Viscoelastic,
    film_moduli,
    long_term_poisson_ratio,
    plane_strain_modulus,
    youngs_modulus,
)
from wrinklewave.theory import wrinkling

if TYPE_CHECKING:
    from wrinklewave.config.solids import Film, Substrate


def film_shear_modulus(film: Film, substrate: Substrate) -> float:
    """Long-term shear modulus of the film [Pa]: as given, or derived from measured wrinkles.

    The derived one makes the film on a half-space of the long-term substrate wrinkle at the measured critical
    strain, or wavelength. The two disagree for the paper's sample: 42 and 35 times the substrate's modulus.

    Raises:
        InputError: if the case gives neither a modulus nor says what to derive it from.
    """
    if film.shear_modulus is not None:
        return film.shear_modulus
    if film.modulus_from is None:
        raise InputError(
            "the film has no modulus",
            key="film",
            expected="shear_modulus or modulus_from",
            cure='add modulus_from = "critical_strain" or "critical_wavelength"',
        )
    if film.modulus_from == "critical_strain":
        assert film.critical_strain is not None  # the case has been checked for it
        ratio = wrinkling.modulus_ratio_of_strain(film.critical_strain)
    else:
        assert film.critical_wavelength is not None
        ratio = wrinkling.modulus_ratio_of_wavelength(film.critical_wavelength, film.thickness)
    # in plane strain E/(1 - nu^2) = 2 mu/(1 - nu)
    return ratio * substrate_plane_strain_modulus(substrate) * (1 - film.poisson_ratio) / 2


def film_material(film: Film, substrate: Substrate) -> Viscoelastic:
    """Return the relaxing moduli of the film.

    Raises:
        InputError: as :func:`film_shear_modulus`.
    """
    return film_moduli(film, film_shear_modulus(film, substrate))


def critical_values(film: Film, substrate: Substrate) -> tuple[float, float]:
    """Critical strain and wavelength [m]: each as measured, or else from the moduli.

    Raises:
        InputError: as :func:`film_shear_modulus`, where a value was not measured.
    """
    if film.critical_strain is not None and film.critical_wavelength is not None:
        return film.critical_strain, film.critical_wavelength
    film_modulus = film_plane_strain_modulus(film, substrate)
    substrate_modulus = substrate_plane_strain_modulus(substrate)
    strain = wrinkling.critical_strain(film_modulus, substrate_modulus)
    wavelength = wrinkling.critical_wavelength(film_modulus, substrate_modulus, film.thickness)
    return film.critical_strain or strain, film.critical_wavelength or wavelength


def substrate_plane_strain_modulus(substrate: Substrate) -> float:
    """Long-term E/(1 - nu^2) of the substrate [Pa]."""
    nu = long_term_poisson_ratio(substrate)
    return plane_strain_modulus(youngs_modulus(substrate.shear_modulus, nu), nu)


def film_plane_strain_modulus(film: Film, substrate: Substrate) -> float:
    """Long-term E/(1 - nu^2) of the film [Pa].

    Raises:
        InputError: as :func:`film_shear_modulus`.
    """
    mu = film_shear_modulus(film, substrate)
    return plane_strain_modulus(youngs_modulus(mu, film.poisson_ratio), film.poisson_ratio)
