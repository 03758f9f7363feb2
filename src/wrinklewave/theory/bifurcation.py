"""When and how finely a bonded film wrinkles: the exact plane-strain bifurcation of film and substrate.

Film and substrate are neo-Hookean, bonded, at the same axial stretch, each free to expand across it. The flat state
bifurcates where an increment exists that leaves the top free of traction:

    det Z(strain, k h) = 0,

Z the stiffness of the whole surface from :mod:`wrinklewave.theory.incremental`. No thin-film or small-strain
approximation is made. The critical strain is the smallest over all wavenumbers.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.incremental import (
    Matrix,
    bilayer_stiffness,
    block_stiffness,
    film_transfer,
    half_space_stiffness,
    prestressed_layer,
    stroh_matrix,
)

LARGEST_STRAIN = 0.45
"""The bare surface of an incompressible half-space is unstable at 0.456 (Biot): no film is needed beyond it."""
STRAIN_STEP = 0.005
WAVENUMBER_STEP = 0.01


@dataclass(frozen=True)
class Bifurcation:
    """Onset of wrinkling in slow compression.

    ``wavenumber`` is k h of the undeformed state; the wavelengths are in units of the film's thickness h, in the
    undeformed material and in the compressed state at onset.
    """

    critical_strain: float
    wavenumber: float

    @property
    def wavelength(self) -> float:
        return 2 * np.pi / self.wavenumber

    @property
    def compressed_wavelength(self) -> float:
        return self.wavelength * (1 - self.critical_strain)


def surface_stiffness(
    film: Viscoelastic,
    substrate: Viscoelastic,
    strain: float,
    wavenumber: float,
    *,
    thickness: float = 1.0,
    depth: float = np.inf,
    rate: float = 0.0,
) -> Matrix:
    """Stiffness Z of the film's top, T = mu k Z U with mu the substrate's long-term shear modulus, shape [2, 2].

    Args:
        film, substrate: K_inf = inf stands for an incompressible solid.
        strain: nominal compressive strain of both.
        wavenumber: k of the undeformed state [1/m].
        thickness: of the film [m].
        depth: of the substrate, on a base that slips without rising [m].
        rate: s of increments that grow as exp(s t) [1/s].
    """
    unit = substrate.mu_inf
    upper, lower = (
        stroh_matrix(prestressed_layer(solid, 1 - strain, rate=rate, unit=unit), wavenumber)
        for solid in (film, substrate)
    )
    below = half_space_stiffness(lower) if np.isinf(depth) else block_stiffness(lower, wavenumber * depth)
    return bilayer_stiffness(film_transfer(upper, wavenumber * thickness), below)


def critical_strain(
    film: Viscoelastic, substrate: Viscoelastic, wavenumber: float, *, depth: float = np.inf
) -> float:
    """Smallest strain at which the flat state bifurcates into wrinkles of one wavenumber; NaN if below none to 0.45.

    Args:
        film, substrate: of their long-term moduli.
        wavenumber: k h, undeformed.
        depth: of the substrate, in film thicknesses.
    """
    from scipy.optimize import brentq

    def determinant(strain: float) -> float:
        return float(np.linalg.det(surface_stiffness(film, substrate, strain, wavenumber, depth=depth)))

    below = 0.0
    while below < LARGEST_STRAIN:
        above = below + STRAIN_STEP
        if determinant(above) < 0:
            return float(brentq(determinant, below, above, xtol=1e-15, rtol=1e-14))
        below = above
    return np.nan


def bifurcation(film: Viscoelastic, substrate: Viscoelastic, *, depth: float = np.inf) -> Bifurcation:
    """Critical strain and wavenumber of the pair in slow compression.

    Args:
        film, substrate: of their long-term moduli; K_inf = inf stands for an incompressible solid.
        depth: of the substrate, in film thicknesses, on a base that slips without rising.

    Raises:
        InputError: if the film is so soft that the surface folds before it wrinkles.
    """
    from scipy.optimize import brentq

    def strain_at(wavenumber: float) -> float:
        return critical_strain(film, substrate, wavenumber, depth=depth)

    def slope(wavenumber: float) -> float:
        """d det/dk at the critical strain of k, of the sign of d strain/dk: fourth-order central difference."""
        h, strain = WAVENUMBER_STEP * wavenumber, strain_at(wavenumber)

        def rise(distance: float) -> float:
            above, below = (
                float(np.linalg.det(surface_stiffness(film, substrate, strain, k, depth=depth)))
                for k in (wavenumber + distance, wavenumber - distance)
            )
            return above - below

        return (8 * rise(h) - rise(2 * h)) / (12 * h)

    classical = (3 * substrate.mu_inf / film.mu_inf) ** (1 / 3)
    trial = classical * np.geomspace(0.4, 1.6, 13)
    strains = np.array([strain_at(wavenumber) for wavenumber in trial])
    lowest = int(np.argmin(np.where(np.isnan(strains), np.inf, strains)))
    if not 0 < lowest < len(trial) - 1 or np.isnan(strains[lowest - 1 : lowest + 2]).any():
        ratio = film.mu_inf / substrate.mu_inf
        raise InputError(
            f"a film {ratio:.3g} times as stiff as the substrate does not wrinkle below a strain of {LARGEST_STRAIN}",
            expected="a film at least a few times as stiff as the substrate",
        )
    wavenumber = float(brentq(slope, trial[lowest - 1], trial[lowest + 1], xtol=1e-12))
    return Bifurcation(critical_strain=strain_at(wavenumber), wavenumber=wavenumber)


def matching_film(
    film: Viscoelastic, substrate: Viscoelastic, *, critical_strain: float, wavenumber: float
) -> Viscoelastic:
    """Scale a film's moduli until its exact critical strain at one wavenumber is the measured one.

    Args:
        film: gives Poisson's ratio, density and the relative shares of its Prony terms.
        substrate: of its long-term moduli.
        critical_strain: measured eps_c.
        wavenumber: k h of the measured wrinkles, undeformed.

    Raises:
        InputError: if no modulus between 1 and 10^6 times the substrate's does it.
    """
    from scipy.optimize import brentq

    def determinant(log_ratio: float) -> float:
        scaled = _scaled(film, np.exp(log_ratio) * substrate.mu_inf / film.mu_inf)
        return float(np.linalg.det(surface_stiffness(scaled, substrate, critical_strain, wavenumber)))

    trial = np.linspace(0.0, np.log(1e6), 41)
    sign = np.sign([determinant(log_ratio) for log_ratio in trial])
    crossings = np.flatnonzero(sign[:-1] > sign[1:])
    if not crossings.size:
        raise InputError(
            f"no film wrinkles at k h = {wavenumber:.3g} and a strain of {critical_strain:.3g}",
            expected=f"more than (k h)^2/12 = {wavenumber**2 / 12:.3g}, the strain that bends the bare film",
            cure="check the measured critical strain, critical wavelength and thickness of the film",
        )
    first = crossings[0]
    log_ratio = float(brentq(determinant, trial[first], trial[first + 1], xtol=1e-13))
    return _scaled(film, np.exp(log_ratio) * substrate.mu_inf / film.mu_inf)


def _scaled(solid: Viscoelastic, factor: float) -> Viscoelastic:
    return replace(
        solid,
        mu_inf=factor * solid.mu_inf,
        K_inf=factor * solid.K_inf,
        mu_k=factor * solid.mu_k,
        K_k=factor * solid.K_k,
    )
