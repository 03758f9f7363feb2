"""From the imperfection of a case to the seeds of the rate-dependent model's wrinkles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.config.imperfections import SinusoidalImperfection
from wrinklewave.laboratory_frame import Array
from wrinklewave.mesh.imperfection import imperfection_height
from wrinklewave.theory.film import critical_values
from wrinklewave.wrinkling.seeds import Seeds, of_height, of_one_wave, shared_evenly

if TYPE_CHECKING:
    from wrinklewave.config import Case

BANDS = 8
"""Of wavelengths that compete, evenly spaced in wavenumber."""
BAND_RANGE = (0.4, 2.2)
"""Wavenumbers that compete, over that of the model's wavelength: beyond them hardly anything grows."""
SAMPLES_PER_WAVELENGTH = 40
"""Of an imperfection whose parts are looked for."""


def model_wavelength(case: Case) -> float:
    """Undeformed wavelength [m] of a model's wrinkles: of a sinusoidal imperfection, else the critical one."""
    assert case.film is not None  # a case with a wrinkling model has a film
    imperfection = case.film.imperfection
    if case.wrinkles.model == "rate-dependent" and isinstance(imperfection, SinusoidalImperfection):
        return imperfection.wavelength
    return critical_values(case.film, case.substrate)[1]


def wrinkle_seeds(case: Case, X: Array) -> Seeds:
    """Seeds at undeformed positions ``X`` [m], of one wavelength or of several that compete."""
    assert case.film is not None
    assert case.film.imperfection is not None  # checked with the case
    imperfection, wavelength = case.film.imperfection, model_wavelength(case)
    competing = wavelength / np.linspace(*BAND_RANGE, BANDS)
    if isinstance(imperfection, SinusoidalImperfection):
        if case.wrinkles.wavelength == "kept":
            return of_one_wave(imperfection.amplitude, wavelength, X)
        return shared_evenly(imperfection.amplitude, competing, X)
    along = np.linspace(
        0.0, case.block.length, round(SAMPLES_PER_WAVELENGTH * case.block.length / wavelength)
    )
    seeds = of_height(along, imperfection_height(imperfection, along), competing, X)
    if case.wrinkles.wavelength == "fastest":
        return seeds
    return Seeds(np.array([wavelength]), seeds.waves.sum(axis=1, keepdims=True))
