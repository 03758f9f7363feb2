"""Wrinkles that ride on a moving surface: Eq. 2 of "Wrinkles Riding Waves in Soft Layered Materials".

    x(X, t) = x_p(X, t) - A(X, t) cos(2 pi X / lambda_c) sin alpha(X, t)
    y(X, t) = y_p(X, t) + A(X, t) cos(2 pi X / lambda_c) cos alpha(X, t)

with X the undeformed position, alpha the angle of the surface tangent from the x-axis. The phase is tied to
the material, largest at the struck end X = 0. The amplitude A comes from any wrinkling model.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.laboratory_frame import Array, SurfaceCurve, surface_curve, visible_height

SAMPLES_PER_WAVELENGTH = 64
"""Chords between samples cut a crest by at most A (1 - cos(pi/64)) = 0.12 % of the amplitude."""


class SurfaceHeights(NamedTuple):
    """Heights [m] on the laboratory grid, each of shape [n_times, n_x], NaN where nothing is seen."""

    wrinkled: Array
    smooth: Array


def wrinkled_surface(
    X: ArrayLike,
    x_p: ArrayLike,
    y_p: ArrayLike,
    amplitude: ArrayLike,
    *,
    wavelength: float,
    x: ArrayLike,
    x_boundary: ArrayLike,
) -> SurfaceHeights:
    """What a camera sees of a moving surface, with and without wrinkles on it.

    Args:
        X: undeformed positions of the material points [m], shape [n_points], increasing.
        x_p, y_p: their positions [m], shape [n_times, n_points].
        amplitude: their wrinkle amplitude [m], same shape; complex where the phase is not that of the cosine.
        wavelength: of the wrinkles in the undeformed material [m].
        x: laboratory grid [m], shape [n_x], increasing.
        x_boundary: position of the struck end [m], shape [n_times].
    """
    x = np.asarray(x, dtype=float)
    spacing = min(wavelength / SAMPLES_PER_WAVELENGTH, float(np.diff(x).min()))
    curve = surface_curve(X, x_p, y_p, spacing=spacing)
    wrinkled_x, wrinkled_y = wrinkled_curve(curve, X, amplitude, wavelength=wavelength)
    return SurfaceHeights(
        visible_height(wrinkled_x, wrinkled_y, x, x_boundary), visible_height(curve.x, curve.y, x, x_boundary)
    )


def smooth_surface(
    X: ArrayLike, x_p: ArrayLike, y_p: ArrayLike, *, x: ArrayLike, x_boundary: ArrayLike
) -> Array:
    """What a camera sees of a moving surface without wrinkles; arguments as in ``wrinkled_surface``."""
    x = np.asarray(x, dtype=float)
    curve = surface_curve(X, x_p, y_p, spacing=float(np.diff(x).min()))
    return visible_height(curve.x, curve.y, x, x_boundary)


def wrinkled_curve(
    curve: SurfaceCurve, X: ArrayLike, amplitude: ArrayLike, *, wavelength: float
) -> tuple[Array, Array]:
    """Displace a surface along its normal by wrinkles of the given amplitude (Eq. 2).

    Args:
        curve: the smooth surface, sampled at least ``SAMPLES_PER_WAVELENGTH`` times per wavelength.
        X: undeformed positions [m] at which the amplitude is known, shape [n_points], increasing.
        amplitude: wrinkle amplitude [m], shape [n_times, n_points], real or complex: the wrinkle is the real part of
            amplitude * exp(2 pi i X / wavelength).
        wavelength: of the wrinkles in the undeformed material [m].

    Returns:
        Positions x and y [m] along the wrinkled curve, each of shape [n_times, n_samples].
    """
    from scipy.interpolate import PchipInterpolator  # keeps amplitudes >= 0, without overshoot at the onset

    X, amplitude, phase = np.asarray(X, dtype=float), np.asarray(amplitude), 2 * np.pi * curve.X / wavelength
    wrinkle = PchipInterpolator(X, amplitude.real, axis=1)(curve.X) * np.cos(phase)
    if np.iscomplexobj(amplitude):
        wrinkle -= PchipInterpolator(X, amplitude.imag, axis=1)(curve.X) * np.sin(phase)
    return curve.x + wrinkle * curve.normal_x, curve.y + wrinkle * curve.normal_y
