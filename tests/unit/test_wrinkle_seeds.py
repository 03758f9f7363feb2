"""Seeds of wrinkles: what an imperfection gives to each wavelength, and the wrinkle of all together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wrinklewave.config import load_case
from wrinklewave.experiments.wrinkle_seeds import BANDS, wrinkle_seeds
from wrinklewave.mesh.imperfection import imperfection_height
from wrinklewave.wrinkling.seeds import FAINTEST, Seeds, of_height, of_one_wave, shared_evenly

CASE = Path(__file__).parents[2] / "examples" / "paper_resolved.toml"
RATE_DEPENDENT = "wrinkles.model=rate-dependent"
RANDOM = "film.imperfection={kind='random', amplitude='20 um', wavelengths=['1.2 mm', '4 mm'], seed=3}"
BUMP = "film.imperfection={kind='bump', amplitude='20 um', position='25 mm', width='0.5 mm'}"
X = np.linspace(5e-3, 45e-3, 161)


def test_bands_share_a_height_and_give_it_back() -> None:
    """Whole half waves along the film: each is one component of the cosine transform, and exact."""
    start, k = -2e-3, 2 * np.pi * np.array([600.0, 720.0])
    along = start + np.linspace(0.0, 50e-3, 2001)
    height = 3e-6 * np.cos(k[0] * (along - start)) - 2e-6 * np.cos(k[1] * (along - start))
    seeds = of_height(along, height, 1 / np.linspace(500.0, 800.0, 4), X)
    one, other = 3e-6 * np.exp(1j * k[0] * (X - start)), -2e-6 * np.exp(1j * k[1] * (X - start))
    np.testing.assert_allclose(
        seeds.waves, np.outer(one, [0, 1, 0, 0]) + np.outer(other, [0, 0, 0.8, 0.2]), atol=1e-16
    )


def test_a_single_wave_is_a_cosine() -> None:
    np.testing.assert_allclose(
        of_one_wave(5e-6, 2e-3, X).waves[:, 0].real, 5e-6 * np.cos(2 * np.pi * X / 2e-3), atol=1e-17
    )


def test_faint_waves_are_raised_and_keep_their_phase() -> None:
    waves = np.array([[1.0 + 1.0j, 1e-9j], [-0.5, 0.0]])
    audible, least = Seeds(np.array([2e-3, 1e-3]), waves).audible, FAINTEST * np.sqrt(2)
    np.testing.assert_allclose(audible, [[1.0 + 1.0j, 1j * least], [-0.5, least]], atol=1e-15)


def test_wrinkles_that_have_not_grown_are_the_imperfection() -> None:
    seeds = shared_evenly(10e-6, 1 / np.linspace(400.0, 700.0, 7), X)
    together = seeds.grown(np.ones((1, X.size, 7)), X, 2e-3)[0]
    height = (together * np.exp(2j * np.pi / 2e-3 * X)).real
    np.testing.assert_allclose(height, seeds.waves.real.sum(axis=1), atol=1e-12)
    assert np.sqrt(2 * (height**2).mean()) == pytest.approx(10e-6, rel=0.1)
    assert np.abs(height).max() < 0.75 * np.sqrt(7) * 10e-6  # what all waves in phase would add up to


@pytest.mark.parametrize(
    ("overrides", "number"),
    [((), 1), (("wrinkles.wavelength=fastest",), BANDS), ((RANDOM,), BANDS), ((BUMP,), BANDS)],
    ids=["kept", "fastest", "random", "bump"],
)
def test_wavelengths_of_a_case(overrides: tuple[str, ...], number: int) -> None:
    """Left out, the wavelength is kept with a sinusoidal imperfection and the fastest with any other."""
    case = load_case(CASE, [RATE_DEPENDENT, *overrides])
    assert wrinkle_seeds(case, X).wavelengths.size == number


def test_random_imperfection_is_followed_as_it_is() -> None:
    case = load_case(CASE, [RATE_DEPENDENT, RANDOM])
    assert case.film is not None
    assert case.film.imperfection is not None
    height = imperfection_height(case.film.imperfection, X)
    found = wrinkle_seeds(case, X).waves.real.sum(axis=1)
    assert np.abs(found - height).max() < 0.05 * height.max()


def test_random_imperfection_can_keep_one_wavelength() -> None:
    case = load_case(CASE, [RATE_DEPENDENT, RANDOM, "wrinkles.wavelength=kept"])
    assert wrinkle_seeds(case, X).waves.shape == (X.size, 1)
