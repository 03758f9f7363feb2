"""The wrinkles of a film that is part of the mesh, told apart from the surface that they ride on.

In the undeformed coordinate, wrinkles keep their wavelength and their place. So the displacements of the surface
nodes are smoothed along X; what is left across the smooth surface is the wrinkle, its envelope the amplitude.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave.analysis.filters import low_pass
from wrinklewave.analysis.wrinkles import amplitude_envelope
from wrinklewave.laboratory_frame import Array


class ResolvedWrinkles(NamedTuple):
    """Smooth surface and wrinkles at material points, shapes [n_times, n_points].

    Args:
        x, y: positions of the smooth surface [m].
        height: of the wrinkle above it, along its normal [m].
        amplitude: envelope of the height [m]; too small within about a wavelength of both ends.
    """

    x: Array
    y: Array
    height: Array
    amplitude: Array


def resolved_wrinkles(X: Array, x_p: Array, y_p: Array, *, filter_wavelength: float) -> ResolvedWrinkles:
    """Tell wrinkles from the surface below them.

    Args:
        X: undeformed positions of the surface nodes along the film [m], shape [n_points], increasing.
        x_p, y_p: their positions [m], shape [n_times, n_points].
        filter_wavelength: between wrinkles and pulse, in undeformed material length [m].

    Raises:
        InputError: if the filter does not suit the mesh.
    """
    x = X + smooth_displacement(X, x_p - X, filter_wavelength=filter_wavelength)
    y = smooth_displacement(X, y_p, filter_wavelength=filter_wavelength)
    slope_x, slope_y = np.gradient(x, X, axis=1), np.gradient(y, X, axis=1)
    height = ((y_p - y) * slope_x - (x_p - x) * slope_y) / np.hypot(slope_x, slope_y)
    even = np.linspace(X[0], X[-1], X.size)
    return ResolvedWrinkles(x, y, height, _moved(amplitude_envelope(_moved(height, X, even)), even, X))


def smooth_displacement(X: Array, values: Array, *, filter_wavelength: float) -> Array:
    """Low-pass of values [n_times, n_points] along the undeformed surface, which need not be evenly divided.

    Raises:
        InputError: if the filter does not suit the mesh.
    """
    even = np.linspace(X[0], X[-1], X.size)
    spacing = float(even[1] - even[0])
    smooth = low_pass(_moved(values, X, even), spacing=spacing, cutoff_wavelength=filter_wavelength)
    return _moved(smooth, even, X)


def _moved(values: Array, X: Array, points: Array) -> Array:
    """Values [n_times, n] known at ``X``, at other points."""
    from scipy.interpolate import make_interp_spline

    if np.allclose(X, points, rtol=0.0, atol=1e-9 * float(X[-1])):
        return values
    return make_interp_spline(X, values, k=3, axis=1)(points)
