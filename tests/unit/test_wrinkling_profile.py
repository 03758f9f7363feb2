"""Eq. 1 and Eq. 2 of the paper: amplitude, wavelength, and the wrinkled surface."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.laboratory_frame import surface_curve
from wrinklewave.wrinkling.film import instantaneous_critical_strain, instantaneous_modulus
from wrinklewave.wrinkling.profile import smooth_surface, wrinkled_curve, wrinkled_surface
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude, wrinkle_wavelength

FILM = {"critical_strain": 0.043, "critical_wavelength": 2e-3}
LENGTH = 50.4e-3


def test_amplitude_at_the_strain_of_the_stopped_striker() -> None:
    """A_0 = 0.1714 mm and lambda = 1.846 mm at eps = 0.12, computed by hand from Eq. 1."""
    assert wrinkle_amplitude(0.12, **FILM) == pytest.approx(1.7141480368e-4, rel=1e-10)
    assert wrinkle_wavelength(0.12, **FILM) == pytest.approx(1.846e-3, rel=1e-12)


def test_no_wrinkles_below_the_critical_strain() -> None:
    strain = np.array([-0.1, 0.0, 0.0429])
    np.testing.assert_array_equal(wrinkle_amplitude(strain, **FILM), 0.0)
    assert np.isnan(wrinkle_wavelength(strain, **FILM)).all()
    assert np.isnan(wrinkle_amplitude(np.nan, **FILM))


@given(st.floats(0.043, 0.6), st.floats(1e-4, 0.1))
def test_amplitude_grows_with_strain(strain: float, more: float) -> None:
    assert wrinkle_amplitude(strain + more, **FILM) > wrinkle_amplitude(strain, **FILM)


def _tilted_plane(angle: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    X = np.linspace(0.0, LENGTH, 101)
    return X, X[None] * np.cos(angle), X[None] * np.sin(angle)


@pytest.mark.parametrize("angle", [-0.5, 0.0, 0.8])
def test_wrinkles_stand_normal_to_the_surface(angle: float) -> None:
    """On a tilted plane, rotating back by the tilt gives the sinusoid A cos(2 pi X / lambda_c) over X."""
    X, x_p, y_p = _tilted_plane(angle)
    curve = surface_curve(X, x_p, y_p, spacing=1e-5)
    x, y = wrinkled_curve(curve, X, np.full_like(x_p, 1.5e-4), wavelength=2e-3)
    along = x * np.cos(angle) + y * np.sin(angle)
    across = -x * np.sin(angle) + y * np.cos(angle)
    np.testing.assert_allclose(along[0], curve.X, atol=1e-12)
    np.testing.assert_allclose(across[0], 1.5e-4 * np.cos(2 * np.pi * curve.X / 2e-3), atol=1e-12)


def test_wrinkles_ride_on_material_points() -> None:
    """A block moved and compressed evenly to 1 - eps: crests sit at x = u + (1 - eps) n lambda_c."""
    X = np.linspace(0.0, LENGTH, 203)
    strain, travel = 0.12, 0.12 * LENGTH
    x_p = travel + (1 - strain) * X[None]
    x = np.arange(0.0, LENGTH, 5e-6)
    heights = wrinkled_surface(
        X,
        x_p,
        np.full_like(x_p, 0.0185),
        np.full_like(x_p, 1.5e-4),
        wavelength=2e-3,
        x=x,
        x_boundary=x_p[:, 0],
    )
    y = heights.wrinkled[0]
    crests = x[1:-1][(y[1:-1] > y[:-2]) & (y[1:-1] >= y[2:])]
    np.testing.assert_allclose(
        crests, travel + (1 - strain) * 2e-3 * np.arange(1, crests.size + 1), atol=1e-5
    )
    assert crests.size == 25
    # chords between 64 samples per wavelength cut crests by at most 0.12 %
    assert np.nanmax(y) - 0.0185 == pytest.approx(1.5e-4, rel=1.2e-3)
    np.testing.assert_allclose(heights.smooth[0][x > travel], 0.0185, rtol=1e-12)
    assert np.isnan(y[x < travel]).all()


def test_without_wrinkles_both_heights_agree() -> None:
    X = np.linspace(0.0, LENGTH, 203)
    x_p = (X + 1e-3 * np.sin(X / LENGTH * np.pi))[None]
    y_p = (0.0185 + 2e-3 * np.sin(X / 8e-3))[None]
    x = np.arange(0.0, LENGTH, 1e-4)
    heights = wrinkled_surface(X, x_p, y_p, 0 * x_p, wavelength=2e-3, x=x, x_boundary=[0.0])
    np.testing.assert_array_equal(heights.wrinkled, heights.smooth)
    # the samples of smooth_surface are coarser: chords of 0.1 mm on a curvature of at most 31 /m, c^2 k / 8
    expected = smooth_surface(X, x_p, y_p, x=x, x_boundary=[0.0])
    np.testing.assert_allclose(heights.smooth, expected, atol=1.1e-4**2 * 31 / 8)


def test_momentary_modulus_and_critical_strain() -> None:
    """eps_c grows with the modulus to the power 2/3: 18.12-fold for the paper's instantaneous modulus."""
    modulus = instantaneous_modulus([1e3, 5e3, 1.0], [0.01, 0.05, 1e-5], smallest_strain=1e-3)
    np.testing.assert_allclose(modulus, [1e5, 1e5, np.nan])
    ratio = (131.12e3 + 9.983e6) / 131.12e3
    critical = instantaneous_critical_strain(
        [131.12e3, ratio * 131.12e3, -1.0], critical_strain=0.043, long_term_modulus=131.12e3
    )
    np.testing.assert_allclose(critical, [0.043, 0.043 * 18.120608370532867, np.nan], rtol=1e-12)
