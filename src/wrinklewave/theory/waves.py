"""Speeds of small waves in bars, plates and solids, elastic and viscoelastic.

E is Young's modulus, nu Poisson's ratio, mu the shear modulus, rho the density; SI units throughout.
"""

from __future__ import annotations

import math

from wrinklewave.materials.moduli import plane_strain_modulus, plane_wave_modulus


def bar_speed(E: float, rho: float) -> float:
    """Return c = sqrt(E/rho) [m/s], long waves in a thin bar."""
    return math.sqrt(E / rho)


def plate_speed(E: float, nu: float, rho: float) -> float:
    """Return c = sqrt(E/(rho (1 - nu^2))) [m/s], long waves in a bar in plane strain."""
    return math.sqrt(plane_strain_modulus(E, nu) / rho)


def shear_speed(mu: float, rho: float) -> float:
    """c_T = sqrt(mu/rho) [m/s]."""
    return math.sqrt(mu / rho)


def longitudinal_speed(mu: float, K: float, rho: float) -> float:
    """c_L = sqrt((K + 4 mu/3)/rho) [m/s], plane waves in an unbounded solid."""
    return math.sqrt(plane_wave_modulus(mu, K) / rho)


def rayleigh_speed(mu: float, K: float, rho: float) -> float:
    """Speed of waves along a free surface [m/s].

    The root 0 < x < 1 of x^3 - 8 x^2 + (24 - 16 r) x - 16 (1 - r) = 0 with x = (c_R/c_T)^2, r = (c_T/c_L)^2
    (Achenbach, Wave Propagation in Elastic Solids (1973), section 5.11).
    """
    import numpy as np

    r = mu / plane_wave_modulus(mu, K)
    roots = np.roots([1.0, -8.0, 24.0 - 16.0 * r, -16.0 * (1.0 - r)])
    x = min(root.real for root in roots if abs(root.imag) < 1e-9 and root.real > 0)
    return float(math.sqrt(x)) * shear_speed(mu, rho)


def viscoelastic_bar_speed(complex_modulus: complex, rho: float) -> float:
    """Phase speed of a sine wave in a viscoelastic bar, c* = sqrt(|E*|/rho) sec(delta/2) [m/s].

    Args:
        complex_modulus: E* at the wave's frequency [Pa]; tan(delta) = E''/E'.
        rho: density [kg/m^3].
    """
    delta = math.atan2(complex_modulus.imag, complex_modulus.real)
    return math.sqrt(abs(complex_modulus) / rho) / math.cos(delta / 2)


def attenuation_length(complex_modulus: complex, rho: float, omega: float) -> float:
    """Distance over which a sine wave in a viscoelastic bar falls to 1/e [m]; infinite without loss.

    1/(omega sqrt(rho/|E*|) sin(delta/2)), from the imaginary part of the wavenumber omega sqrt(rho/E*).

    Args:
        complex_modulus: E* at the wave's frequency [Pa].
        rho: density [kg/m^3].
        omega: angular frequency [rad/s].
    """
    delta = math.atan2(complex_modulus.imag, complex_modulus.real)
    decay = omega * math.sqrt(rho / abs(complex_modulus)) * math.sin(delta / 2)
    return 1 / decay if decay > 0 else math.inf


def love_frequency(c: float, nu: float, height: float) -> float:
    """Highest frequency of waves in a bar with lateral inertia, c sqrt(6)/(2 pi nu H) [Hz].

    Love's omega = c k / sqrt(1 + (nu kappa k)^2) tends to c/(nu kappa) for short waves; the polar radius of
    gyration of a square section of side H is kappa = H/sqrt(6) (Love, Treatise (1927), section 278).

    Args:
        c: bar speed [m/s].
        nu: Poisson's ratio; 0 raises ``ZeroDivisionError``, there is no limit then.
        height: side H of the square section [m].
    """
    return c * math.sqrt(6) / (2 * math.pi * abs(nu) * height)


def love_frequency_plane_strain(c: float, nu: float, height: float) -> float:
    """The same limit for a plate that cannot move across its width, c sqrt(12) (1 - nu)/(2 pi nu H) [Hz].

    There only the height moves: kappa = H/sqrt(12), and Poisson's ratio becomes nu/(1 - nu).

    Args:
        c: speed of long waves in plane strain, :func:`plate_speed` [m/s].
        nu: Poisson's ratio, not 0.
        height: H [m].
    """
    return c * math.sqrt(12) * (1 - nu) / (2 * math.pi * abs(nu) * height)
