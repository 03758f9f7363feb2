"""The rate-dependent wrinkling model: against an independent solver, its invariants, and its errors."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.layers import RATIO, THICKNESS, solid
from support.strip import strip, surface_amplitudes
from wrinklewave.errors import InputError
from wrinklewave.wrinkling.rate_dependent import FilmLayer, competing_wrinkles, wrinkle_amplitude
from wrinklewave.wrinkling.rate_dependent_block import Block, wrinkles_on_block

TIME = np.linspace(0.0, 3e-3, 76)
FILM = FilmLayer(THICKNESS, solid(RATIO))
SUBSTRATE = solid(relaxes=True, bulk_relaxes=False)
CASE = {"film": FILM, "substrate": SUBSTRATE}


def smooth(phase: np.ndarray) -> np.ndarray:
    phase = np.clip(phase, 0.0, 1.0)
    return phase - np.sin(2 * np.pi * phase) / (2 * np.pi)


IMPACT = 0.15 * smooth(TIME / 0.6e-3) - 0.09 * smooth((TIME - 1e-3) / 1.8e-3)


@pytest.mark.parametrize(
    ("film_relaxes", "bulk_relaxes", "imperfection", "wavelength"),
    [
        (False, False, 60e-6, 2.6e-3),
        (False, True, 30e-6, 1.6e-3),
        (True, True, 30e-6, 2e-3),
    ],
)
def test_agrees_with_finite_elements(
    film_relaxes: bool, bulk_relaxes: bool, imperfection: float, wavelength: float
) -> None:
    """An impact's strain history, from small to large amplitudes, against half a wavelength of nine-node elements.

    The elements err by about 1 % in the amplitude (4 along half a wavelength), the model by up to 2 %. Neither has
    a mass to speak of.
    """
    film, substrate = (
        replace(solid(ratio, relaxes=relaxes, bulk_relaxes=bulk_relaxes), density=1e-3)
        for ratio, relaxes in ((RATIO, film_relaxes), (1.0, True))
    )
    mesh = strip(film, substrate, thickness=THICKNESS, wavelength=wavelength, imperfection=imperfection)
    expected = surface_amplitudes(mesh, IMPACT[1:], float(TIME[1]))
    found = wrinkle_amplitude(
        TIME,
        IMPACT[:, np.newaxis],
        film=FilmLayer(THICKNESS, film),
        substrate=substrate,
        wavelength=wavelength,
        imperfection=imperfection,
    )[1:, 0]
    assert expected.max() > 2 * imperfection
    assert np.abs(found / expected - 1).max() < 0.03


@settings(max_examples=10)
@given(
    rise=st.floats(1e-4, 3e-3),
    peak=st.floats(0.0, 0.2),
    seed=st.floats(1e-7, 5e-5),
    factor=st.floats(0.1, 2.0),
)
def test_larger_imperfections_make_larger_wrinkles(
    rise: float, peak: float, seed: float, factor: float
) -> None:
    strain = np.stack([peak * smooth(TIME / rise)] * 2, axis=1)
    seeds = np.array([seed, factor * seed])
    amplitude = wrinkle_amplitude(TIME, strain, wavelength=2e-3, imperfection=seeds, **CASE)
    assert np.isfinite(amplitude).all()
    assert amplitude[0] == pytest.approx(seeds)
    assert (
        np.sign(amplitude[:, 1] - amplitude[:, 0]) == np.sign(factor - 1)
    ).all() or factor == pytest.approx(1)


def test_small_wrinkles_are_linear_in_the_imperfection_and_keep_its_sign() -> None:
    strain = np.stack([IMPACT] * 3, axis=1)
    seeds = np.array([1e-12, 2e-12, -1e-12])
    amplitude = wrinkle_amplitude(TIME, strain, wavelength=2e-3, imperfection=seeds, **CASE)
    assert amplitude[:, 1] == pytest.approx(2 * amplitude[:, 0], rel=1e-6)
    assert amplitude[:, 2] == pytest.approx(-amplitude[:, 0], rel=1e-6)


def test_a_flat_film_stays_flat_and_an_unstrained_one_as_it_was() -> None:
    strain = np.stack([IMPACT, 0 * IMPACT], axis=1)
    amplitude = wrinkle_amplitude(TIME, strain, wavelength=2e-3, imperfection=[0.0, 20e-6], **CASE)
    assert np.abs(amplitude[:, 0]).max() == 0.0
    assert amplitude[:, 1] == pytest.approx(20e-6, rel=1e-9)


def test_points_do_not_know_of_each_other() -> None:
    together = wrinkle_amplitude(
        TIME, np.stack([IMPACT, 0.5 * IMPACT], axis=1), wavelength=2e-3, imperfection=20e-6, **CASE
    )
    alone = wrinkle_amplitude(TIME, IMPACT[:, np.newaxis], wavelength=2e-3, imperfection=20e-6, **CASE)
    assert together[:, 0] == pytest.approx(alone[:, 0], rel=1e-6)


def test_competing_wavelengths_share_the_film() -> None:
    lengths = np.array([1.4e-3, 2.0e-3, 3.0e-3])
    strain = 0.1 * smooth(TIME / 0.5e-3)[:, np.newaxis]
    time = 4 * TIME
    alone = [
        wrinkle_amplitude(time, strain, wavelength=length, imperfection=10e-6, **CASE)[-1, 0]
        for length in lengths
    ]
    together = competing_wrinkles(time, strain, wavelengths=lengths, imperfection=10e-6, **CASE)
    assert (together.amplitudes[-1, 0] < alone).all()
    assert together.wavelength[-1, 0] == lengths[1]
    assert 0.6 * max(alone) < together.amplitude[-1, 0] < max(alone)


def test_a_film_near_a_free_end_wrinkles_less() -> None:
    X = np.linspace(0.0, 50e-3, 51)
    strain = 0.1 * smooth(TIME / 0.5e-3)[:, np.newaxis] * np.ones(X.size)
    block = Block(50e-3, 20e-3, 50e-3)
    held, flying = (
        wrinkles_on_block(
            TIME, X, strain, block=block, wavelengths=[2e-3], imperfection=20e-6, gap=gap, **CASE
        ).wrinkles.amplitude[-1]
        for gap in (0.0, 5e-3)
    )
    assert flying[2] < 0.7 * held[2]
    assert 0.9 * held[40] < flying[40] < held[40]


def test_the_film_ends_before_the_held_end() -> None:
    X = np.linspace(0.0, 50e-3, 51)
    strain = 0.1 * smooth(TIME / 0.5e-3)[:, np.newaxis] * np.ones(X.size)
    result = wrinkles_on_block(
        TIME, X, strain, block=Block(50e-3, 20e-3, 40e-3), wavelengths=[2e-3], imperfection=20e-6, **CASE
    )
    assert result.strain[-1, 42] > 0.1 > result.strain[-1, 38]


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time": TIME[::-1]}, "times do not increase"),
        ({"strain": np.full((TIME.size, 1), np.nan)}, "not a number"),
        ({"strain": np.full((TIME.size, 1), 0.9)}, "too large"),
        ({"strain": IMPACT}, "shape"),
        ({"wavelength": -2e-3}, "wavelengths are"),
        ({"imperfection": np.full(3, 1e-6)}, "imperfection has shape"),
        ({"imperfection": 1e-3}, "steep"),
    ],
)
def test_mistakes_are_named(change: dict[str, object], message: str) -> None:
    arguments = {
        "time": TIME,
        "strain": IMPACT[:, np.newaxis],
        "wavelength": 2e-3,
        "imperfection": 20e-6,
    } | change
    with pytest.raises(InputError, match=message):
        wrinkle_amplitude(arguments.pop("time"), arguments.pop("strain"), **CASE, **arguments)


def test_positions_must_increase() -> None:
    with pytest.raises(InputError, match="positions"):
        wrinkles_on_block(
            TIME,
            [1e-3, 0.0],
            np.zeros((TIME.size, 2)),
            block=Block(50e-3, 20e-3, 50e-3),
            wavelengths=[2e-3],
            imperfection=20e-6,
            **CASE,
        )
