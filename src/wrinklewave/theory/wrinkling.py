"""Wrinkling of a stiff film on a soft substrate under compression: critical strain and wavelength.

A film of thickness h and plane-strain modulus E_f under compressive strain eps buckles into sinusoids of
wavenumber k against a substrate of plane-strain modulus E_s when eps E_f h = E_f h^3 k^2/12 + q(k)/k^2, where
q(k) is the stiffness of the substrate's surface. A half-space has q = E_s k/2; the smallest strain is then

    eps_c = (3 E_s/E_f)^(2/3) / 4    at    lambda_c = 2 pi h (E_f/(3 E_s))^(1/3)

(Allen, Analysis and Design of Structural Sandwich Panels (1969), chapter 8). All moduli in this module are
those of plane strain, E/(1 - nu^2); with equal Poisson's ratios their ratio is that of any modulus.
"""

from __future__ import annotations

import math
from typing import Literal

Base = Literal["roller", "bonded"]


def critical_strain(film_modulus: float, substrate_modulus: float) -> float:
    """eps_c = (3 E_s/E_f)^(2/3)/4 of a film on a half-space; moduli in plane strain [Pa]."""
    return (3 * substrate_modulus / film_modulus) ** (2 / 3) / 4


def critical_wavelength(film_modulus: float, substrate_modulus: float, thickness: float) -> float:
    """lambda_c = 2 pi h (E_f/(3 E_s))^(1/3) [m] of a film on a half-space; moduli in plane strain [Pa]."""
    return 2 * math.pi * thickness * (film_modulus / (3 * substrate_modulus)) ** (1 / 3)


def modulus_ratio_of_strain(critical_strain: float) -> float:
    """E_f/E_s = 3/(4 eps_c)^(3/2), the modulus ratio that a measured critical strain stands for."""
    return 3 / (4 * critical_strain) ** 1.5


def modulus_ratio_of_wavelength(critical_wavelength: float, thickness: float) -> float:
    """E_f/E_s = 3 (lambda_c/(2 pi h))^3, the modulus ratio that a measured wavelength stands for."""
    return 3 * (critical_wavelength / (2 * math.pi * thickness)) ** 3


def critical_strain_ratio(stiffening: float) -> float:
    """Factor on eps_c when the substrate's modulus grows by ``stiffening``: its 2/3 power."""
    return stiffening ** (2 / 3)


def depth_factor(depth_in_wavenumbers: float, nu: float, base: Base) -> float:
    """Surface stiffness of an elastic layer under a sinusoidal pressure, over that of the half-space.

    With w = k d: on a frictionless base, or a plane of symmetry ("roller"), (sinh 2w + 2w)/(cosh 2w - 1);
    bonded to a rigid base, with a = 3 - 4 nu, (a cosh 2w + 2 w^2 + (1 + a^2)/2) / (a sinh 2w - 2w). See
    Johnson, Contact Mechanics (1985), section 5.8.

    Args:
        depth_in_wavenumbers: w = k d, wavenumber times thickness of the layer.
        nu: Poisson's ratio of the layer.
        base: what it stands on.
    """
    w = depth_in_wavenumbers
    if w > 300:  # the correction is of the order of exp(-2w) w^2: nothing left, and cosh would overflow
        return 1.0
    if base == "roller":
        return (math.sinh(2 * w) + 2 * w) / (math.cosh(2 * w) - 1)
    a = 3 - 4 * nu
    return (a * math.cosh(2 * w) + 2 * w**2 + (1 + a**2) / 2) / (a * math.sinh(2 * w) - 2 * w)


def critical_state_on_layer(
    film_modulus: float, substrate_modulus: float, thickness: float, *, depth: float, nu: float, base: Base
) -> tuple[float, float]:
    """Critical strain and wavelength [m] of a film on a layer of finite depth.

    The smallest over k of (k h)^2/12 + E_s g(k d)/(2 E_f k h), with g the :func:`depth_factor`.

    Args:
        film_modulus: plane-strain modulus [Pa].
        substrate_modulus: plane-strain modulus [Pa].
        thickness: h of the film [m].
        depth: d of the substrate [m].
        nu: Poisson's ratio of the substrate.
        base: what the substrate stands on.
    """
    from scipy.optimize import minimize_scalar

    def strain(log_kh: float) -> float:
        kh = math.exp(log_kh)
        stiffness = substrate_modulus / 2 * depth_factor(kh * depth / thickness, nu, base)
        return kh**2 / 12 + stiffness / (film_modulus * kh)

    half_space = math.log((3 * substrate_modulus / film_modulus) ** (1 / 3))
    # a stiffer foundation shortens the waves: the half-space is the lower end of the bracket
    best = minimize_scalar(strain, bracket=(half_space, half_space + 0.1), options={"xtol": 1e-12})
    return float(best.fun), 2 * math.pi * thickness / math.exp(float(best.x))


def inextensible_amplitude(strain: float, critical_strain: float, critical_wavelength: float) -> float:
    """Amplitude [m] of a sinusoid in the material coordinate whose arc length is that of the film at onset.

    A = lambda_c q/(2 pi) with q from 2/pi E(q^2) = 1 - (eps - eps_c), E being the complete elliptic integral
    of the second kind of parameter q^2. Eq. 1 of "Wrinkles Riding Waves" is its series. Zero up to the
    critical strain; NaN where eps - eps_c > 1 - 2/pi and the film would fold over itself.
    """
    from scipy.optimize import brentq
    from scipy.special import ellipe

    excess = strain - critical_strain
    if excess <= 0:
        return 0.0
    if excess > 1 - 2 / math.pi:
        return math.nan
    q = brentq(lambda q: 2 / math.pi * ellipe(q**2) - (1 - excess), 0.0, 1.0, xtol=1e-15)
    return critical_wavelength * float(q) / (2 * math.pi)


def winkler_squared_frequency(
    wavenumber: float,
    strain: float,
    *,
    film_modulus: float,
    thickness: float,
    density: float,
    foundation: float,
) -> float:
    """omega^2 [1/s^2] of a compressed film as a beam on springs: negative where the flat state is unstable.

    rho h omega^2 = E_f h^3 k^4/12 - eps E_f h k^2 + K_w; zero at critical strain and wavenumber.

    Args:
        wavenumber: k [1/m].
        strain: compressive strain eps of the film.
        film_modulus: plane-strain modulus [Pa].
        thickness: h [m].
        density: of the film [kg/m^3].
        foundation: K_w, pressure per deflection [Pa/m]; for a half-space E_s k/2.
    """
    bending = film_modulus * thickness**3 * wavenumber**4 / 12
    compression = strain * film_modulus * thickness * wavenumber**2
    return (bending - compression + foundation) / (density * thickness)
