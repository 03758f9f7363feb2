"""Surfaces as they are before a test, and the meshes that follow them."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from wrinklewave.config.imperfections import (
    BumpImperfection,
    ProfileImperfection,
    RandomImperfection,
    SinusoidalImperfection,
)
from wrinklewave.mesh.bilayer import FILM, SUBSTRATE, bilayer, warn_if_coarse
from wrinklewave.mesh.imperfection import imperfection_height, with_imperfection

SINUSOIDAL = SinusoidalImperfection(kind="sinusoidal", amplitude="30 um", wavelength="2 mm")
BUMP = BumpImperfection(kind="bump", amplitude="30 um", position="5 mm", width="0.5 mm")


def random(seed: int) -> RandomImperfection:
    return RandomImperfection(kind="random", amplitude="30 um", wavelengths=("1 mm", "4 mm"), seed=seed)


def film_on_block():
    return bilayer(
        length=10e-3, bottom=0.0, top=5e-3, thickness=0.14e-3, columns=100, substrate_rows=20, film_rows=4,
        grading=(1.0, 0.1),
    )  # fmt: skip


def test_sinusoidal_imperfection_is_highest_at_the_struck_end() -> None:
    X = np.array([0.0, 0.5e-3, 1e-3, 2e-3])
    np.testing.assert_allclose(imperfection_height(SINUSOIDAL, X), [30e-6, 0, -30e-6, 30e-6], atol=1e-18)


@settings(max_examples=10)
@given(st.integers(0, 2**63 - 1))
def test_random_imperfection_has_the_mean_square_of_a_sinusoid_of_its_amplitude(seed: int) -> None:
    """Over 41 m, a thousand times the distance over which neighbouring cosines get out of step."""
    X = np.linspace(0.0, 41.0, 50_000)
    height = imperfection_height(random(seed), X)
    assert np.sqrt(2 * np.mean(height**2)) == pytest.approx(30e-6, rel=0.02)
    np.testing.assert_array_equal(height, imperfection_height(random(seed), X))


def test_a_bump_is_a_gaussian() -> None:
    X = 5e-3 + 0.5e-3 * np.array([-2.0, 0.0, 1.0])
    np.testing.assert_allclose(imperfection_height(BUMP, X), 30e-6 * np.exp([-2.0, 0.0, -0.5]), rtol=1e-9)


@pytest.mark.parametrize(("imperfection", "reached"), [(SINUSOIDAL, 2e-3), (random(1), 4e-3), (BUMP, 4e-3)])
def test_the_shift_dies_out_within_the_longest_wavelength(imperfection, reached: float) -> None:
    """As the square of the distance from that depth; within a shallow block, at its bottom."""
    flat = film_on_block()
    for depth in (reached + 0.5e-3, reached - 0.5e-3):
        mesh = with_imperfection(flat, imperfection, interface=4e-3, depth=depth)
        left = np.clip(1 - (4e-3 - flat.Y) / min(reached, depth), 0.0, 1.0)
        np.testing.assert_allclose(
            mesh.Y - flat.Y, left**2 * imperfection_height(imperfection, flat.X), atol=1e-17
        )


def test_random_imperfection_is_band_limited() -> None:
    X = np.arange(0.0, 1.0, 0.1e-3)
    spectrum = np.abs(np.fft.rfft(imperfection_height(random(3), X) * np.hanning(X.size))) ** 2
    frequency = np.fft.rfftfreq(X.size, 0.1e-3)
    outside = (frequency < 240) | (frequency > 1010)
    assert spectrum[outside].sum() < 1e-3 * spectrum.sum()


def test_measured_profile_is_interpolated_and_scaled(tmp_path: Path) -> None:
    file = tmp_path / "profile.csv"
    file.write_text("x_m,height_m\n0,0\n0.001,1e-5\n0.002,0\n")
    profile = ProfileImperfection(kind="profile", file=file, scale=2.0)
    X = np.array([0.0, 1e-3, 2e-3, 5e-3])
    np.testing.assert_allclose(imperfection_height(profile, X), [0, 2e-5, 0, 0], atol=1e-12)


@pytest.mark.parametrize("imperfection", [SINUSOIDAL, BUMP, random(1)])
def test_film_follows_an_imperfection_at_constant_thickness_and_the_bottom_stays(imperfection) -> None:
    flat = film_on_block()
    mesh = with_imperfection(flat, imperfection, interface=5e-3 - 0.14e-3, depth=5e-3 - 0.14e-3)
    np.testing.assert_allclose(mesh.Y[-1] - mesh.Y[-5], 0.14e-3, rtol=1e-12)
    np.testing.assert_allclose(mesh.Y[-1], 5e-3 + imperfection_height(imperfection, mesh.X[-1]), rtol=1e-12)
    np.testing.assert_array_equal(mesh.Y[0], 0.0)
    assert (mesh.areas() > 0).all()


def test_layers_of_a_bilayer() -> None:
    mesh = film_on_block()
    assert (mesh.layer[:20] == SUBSTRATE).all()
    assert (mesh.layer[20:] == FILM).all()
    assert mesh.areas()[mesh.layer == FILM].sum() == pytest.approx(10e-3 * 0.14e-3)
    assert mesh.areas().sum() == pytest.approx(10e-3 * 5e-3)
    heights = np.diff(mesh.Y[:, 0])[:20]
    assert heights[-1] / heights[0] == pytest.approx(0.1)


def test_a_film_may_end_before_the_block() -> None:
    mesh = bilayer(
        length=10.0, bottom=0.0, top=5.0, thickness=0.5, columns=40, substrate_rows=4, film_rows=2,
        end_gap=1.6, grading=(2.0, 1.0),
    )  # fmt: skip
    middles = 0.5 * (mesh.X[0, 1:] + mesh.X[0, :-1])
    assert mesh.shape == (6, 40)
    assert mesh.n_elements == 240
    np.testing.assert_array_equal(mesh.layer[4:] == FILM, np.broadcast_to(middles < 8.4, (2, 40)))
    assert (mesh.layer[:4] == SUBSTRATE).all()


def test_coarse_meshes_are_warned_about(recwarn: pytest.WarningsRecorder) -> None:
    """Elements of 0.1 mm along the film, and of 0.061 mm just below it: enough for wrinkles of 1.6 mm and more."""
    mesh = film_on_block()
    below = np.diff(mesh.Y[:, 0])[19]
    warn_if_coarse(mesh, 1.6e-3)
    assert not recwarn.list
    with pytest.warns(UserWarning, match="along the film are 0.1 mm, 15.9 per wrinkle"):
        warn_if_coarse(mesh, 1.59e-3)
    with pytest.warns(UserWarning, match="just below the film"):
        warn_if_coarse(mesh, 15.9 * below)
