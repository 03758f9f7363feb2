"""Modes of slow wrinkles: what is read from a surface that is known."""

from __future__ import annotations

import numpy as np
import pytest
import xarray as xr

from wrinklewave.experiments.slow_wrinkles import critical_strains, doubling_strains, modes, onset

LENGTH = 10e-3
CRITICAL = {6: 0.044, 7: 0.042, 8: 0.043}


def surface() -> xr.Dataset:
    """Modes that grow as 1/(1 - strain/critical) up to 0.041, and one of half the number above 0.2 in loading and
    0.18 in unloading."""
    X = np.linspace(0.0, LENGTH, 401)
    strain = np.concatenate([np.linspace(0.0, 0.25, 501), np.linspace(0.25, 0.0, 501)[1:]])
    wave = {n: np.cos(n * np.pi * X / LENGTH) for n in (*CRITICAL, 4)}
    height = 5e-3 + sum(
        np.outer(1e-6 / (1 - np.minimum(strain, 0.041) / critical), wave[n])
        for n, critical in CRITICAL.items()
    )
    loading = np.arange(strain.size) <= 500
    height += np.outer(2e-5 * np.where(loading, strain > 0.2, strain > 0.18), wave[4])
    return xr.Dataset(
        {
            "x_p": (("time", "X"), np.outer(strain, LENGTH - X) + X),
            "y_p": (("time", "X"), height),
        },
        coords={"X": X},
    )


def test_modes_diverge_at_their_critical_strains() -> None:
    found = modes(surface())
    strains = critical_strains(found, np.array(list(CRITICAL)), near=0.042)
    np.testing.assert_allclose(strains, list(CRITICAL.values()), rtol=1e-3)
    strain, mode = onset(np.array(list(CRITICAL)), strains)
    assert 0.0419 < strain < 0.042
    assert 7.0 < mode < 7.5
    assert found.wavelength(8) == pytest.approx(LENGTH / 4)


def test_period_doubling_in_loading_and_unloading() -> None:
    appears, gone = doubling_strains(modes(surface()), 8)
    assert appears == pytest.approx(0.2, abs=1e-3)
    assert gone == pytest.approx(0.18, abs=1e-3)


def test_no_period_doubling() -> None:
    flat = surface().isel(time=slice(0, 300))
    assert np.isnan(doubling_strains(modes(flat), 8)).all()
