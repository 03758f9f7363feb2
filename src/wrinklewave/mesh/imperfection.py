"""The shape of a sample's surface before the test, and the mesh that follows it.

An imperfection is a height over the undeformed, flat surface. The stress-free film follows it at constant
thickness, as one with wrinkles left by earlier tests does, the substrate less and less with depth.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.config.history import read_profile
from wrinklewave.config.imperfections import (
    BumpImperfection,
    ProfileImperfection,
    RandomImperfection,
    SinusoidalImperfection,
)

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from wrinklewave.config.imperfections import Imperfection
    from wrinklewave.mesh.block import GridMesh

    Array = NDArray[np.float64]

RANDOM_COMPONENTS = 32
"""Sinusoids of a random imperfection, at equal distances in wavenumber."""
BUMP_REACH = 8.0
"""Standard deviations of a bump over which it dies out with depth."""


def imperfection_height(imperfection: Imperfection, X: Array) -> Array:
    """Height [m] of the surface over its flat shape at undeformed positions ``X`` [m], of the shape of ``X``.

    Raises:
        InputError: if the file of a measured profile cannot be read.
    """
    if isinstance(imperfection, SinusoidalImperfection):
        return imperfection.amplitude * np.cos(2 * np.pi * X / imperfection.wavelength)
    if isinstance(imperfection, RandomImperfection):
        return _random_height(imperfection, X)
    if isinstance(imperfection, BumpImperfection):
        return imperfection.amplitude * np.exp(-0.5 * ((X - imperfection.position) / imperfection.width) ** 2)
    return _measured_height(imperfection, X)


def _random_height(imperfection: RandomImperfection, X: Array) -> Array:
    """Sum of n cosines of amplitude a; its mean square n a^2/2 is that of the given amplitude."""
    shortest, longest = imperfection.wavelengths
    wavenumbers = 2 * np.pi * np.linspace(1 / longest, 1 / shortest, RANDOM_COMPONENTS)
    phases = np.random.default_rng(imperfection.seed).uniform(0, 2 * np.pi, RANDOM_COMPONENTS)
    a = imperfection.amplitude / np.sqrt(RANDOM_COMPONENTS)
    return a * np.cos(np.multiply.outer(X, wavenumbers) + phases).sum(axis=-1)


def _measured_height(imperfection: ProfileImperfection, X: Array) -> Array:
    from scipy.interpolate import PchipInterpolator

    profile = read_profile(imperfection.file)
    inside = np.clip(X, profile.x[0], profile.x[-1])  # beyond the profile the surface keeps its last height
    return imperfection.scale * PchipInterpolator(profile.x, profile.height)(inside)


def reach(imperfection: Imperfection, depth: float) -> float:
    """Depth [m] at which the material is flat again: the longest wavelength, at most ``depth``."""
    if isinstance(imperfection, SinusoidalImperfection):
        return min(imperfection.wavelength, depth)
    if isinstance(imperfection, RandomImperfection):
        return min(imperfection.wavelengths[1], depth)
    if isinstance(imperfection, BumpImperfection):
        return min(BUMP_REACH * imperfection.width, depth)
    return depth


def with_imperfection(
    mesh: GridMesh, imperfection: Imperfection, *, interface: float, depth: float
) -> GridMesh:
    """Shift a mesh upwards to follow an imperfection.

    Args:
        mesh: with a flat surface.
        imperfection: of the surface; the film above ``interface`` follows it as a whole.
        interface: height of the film's underside [m].
        depth: of the substrate below it [m]; the shift falls to zero within it, with a horizontal tangent.
    """
    below = np.clip((interface - mesh.Y) / reach(imperfection, depth), 0.0, 1.0)
    return replace(mesh, Y=mesh.Y + imperfection_height(imperfection, mesh.X) * (1.0 - below) ** 2)
