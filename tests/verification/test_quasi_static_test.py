"""The quasi-static test against analytic compressions of which every number is known (Eqs. 1 and 2)."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

from support.ledger import Verified
from wrinklewave.analysis.compression import compression_series
from wrinklewave.analysis.wrinkles import mean_amplitude
from wrinklewave.config.recorded import recorded_analysis
from wrinklewave.experiments.quasi_static_test import QuasiStaticTest, quasi_static_test
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude
from wrinklewave.wrinkling.slow_compression import SlowCompression

WINDOW = "analysis.amplitude_window=['12 mm', '46 mm']"


def analysed(made: SlowCompression, second: SlowCompression | None = None, **options: Any) -> QuasiStaticTest:
    surface = made.surface()
    return quasi_static_test(
        surface,
        recorded_analysis([surface.attrs], [WINDOW]),
        second=None if second is None else second.surface(),
        **options,
    )


def test_initial_wrinkles_leave_eq_1_far_from_onset_and_grow_from_what_they_were() -> None:
    film = {"critical_strain": 0.043, "critical_wavelength": 2e-3}
    strain = np.array([0.0, 0.02, 0.2])
    before = wrinkle_amplitude(strain, **film, initial_amplitude=1e-6)
    assert before[0] == pytest.approx(1e-6, rel=1e-3)
    assert before[1] == pytest.approx(1e-6 / (1 - 0.02 / 0.043), rel=1e-3)  # A_i / (1 - eps/eps_c), Southwell
    assert before[2] == pytest.approx(wrinkle_amplitude(0.2, **film), rel=2e-3)
    # Koiter at eps_c: eps_c A_i / A = (pi/lambda_c)^2 (A^2 - A_i^2) to leading order, so A^3 = A_i eps_c
    # (lambda_c/pi)^2
    assert wrinkle_amplitude(0.043, **film, initial_amplitude=1e-8) == pytest.approx(
        (1e-8 * 0.043 * (2e-3 / np.pi) ** 2) ** (1 / 3), rel=5e-3
    )


@pytest.mark.parametrize(
    "made",
    [
        SlowCompression(),
        SlowCompression(bulge=0.0),
        SlowCompression(initial_amplitude=10e-6, margins=(6e-3, 3e-3)),
        SlowCompression(critical_strain=0.06, wavelength=1.4e-3, margins=(4e-3, 2e-3)),
    ],
    ids=["to the ends", "flat", "wrinkled before", "another film"],
)
def test_critical_values_come_back(made: SlowCompression, verified: Verified) -> None:
    """From exact surfaces; what the fit is off by is the filter's doing at the ends."""
    fit = analysed(made).first.fit
    assert fit is not None
    compressed = made.wavelength * (1 - made.critical_strain)
    verified.value("critical strain fitted", fit.critical_strain, made.critical_strain, relative=0.02)
    verified.value(
        "critical wavelength fitted (mm)",
        1e3 * fit.critical_wavelength,
        1e3 * made.wavelength,
        relative=0.005,
    )
    verified.value(
        "the same on the compressed sample (mm)",
        1e3 * fit.compressed_wavelength,
        1e3 * compressed,
        relative=0.005,
    )
    verified.error(
        "initial amplitude fitted, error (µm)", 1e6 * abs(fit.initial_amplitude - made.initial_amplitude), 0.5
    )


def test_stated_uncertainties_hold_under_noise() -> None:
    """Amplitudes and strains with independent errors: the fits' errors over their uncertainties have variance 1."""
    from dataclasses import replace

    from wrinklewave.analysis.compression_fit import fit_compression

    made = SlowCompression(margins=(6e-3, 3e-3), initial_amplitude=10e-6)
    series = analysed(made).first.series
    rng = np.random.default_rng(0)
    clean = made.amplitude(series.strain)
    reduced = []
    for _ in range(60):
        noisy = replace(
            series,
            amplitude=clean + rng.normal(0, 2e-6, clean.size),
            material_wavelength=np.where(
                np.isfinite(series.material_wavelength), rng.normal(2e-3, 4e-6, clean.size), np.nan
            ),
        )
        fit = fit_compression(noisy)
        assert fit is not None
        reduced.append(
            (
                (fit.critical_strain - 0.043) / fit.sigmas["critical_strain"],
                (fit.critical_wavelength - 2e-3) / fit.sigmas["critical_wavelength"],
                (fit.initial_amplitude - 10e-6) / fit.sigmas["initial_amplitude"],
            )
        )
    spread = np.sqrt(np.mean(np.square(reduced), axis=0))
    assert (spread > 0.65).all()  # 60 fits: 9 % by chance, and correlated residuals are counted as fewer
    assert (spread < 1.3).all()


def test_a_wavelength_that_drifts_with_the_strain_is_fitted_as_such() -> None:
    from dataclasses import replace

    from wrinklewave.analysis.compression_fit import fit_compression

    made = SlowCompression()
    series = analysed(made).first.series
    drifting = np.where(
        np.isfinite(series.material_wavelength), made.wavelength * (1 + 0.3 * (series.strain - 0.043)), np.nan
    )
    fit = fit_compression(
        replace(series, amplitude=made.amplitude(series.strain), material_wavelength=drifting)
    )
    assert fit is not None
    assert fit.drift == pytest.approx(0.3, rel=1e-3)
    assert fit.critical_wavelength == pytest.approx(made.wavelength, rel=1e-5)
    assert fit.wavelength(np.array([0.02, 0.143])) == pytest.approx(
        [np.nan, 2e-3 * 1.03 * (1 - 0.143)], rel=1e-4, nan_ok=True
    )


def test_noise_is_taken_off_the_amplitude() -> None:
    """Gaussian noise of standard deviation s has the mean envelope s sqrt(pi/2); s of displacements is that of the
    image and of the mean of the undeformed ones."""
    made = SlowCompression(strains=(0.0, 0.0, 0.0, 0.0, 0.1, 0.15))
    surface = made.surface()
    clean, sigma = surface.copy(), np.full(surface["u_y"].shape, 20e-6)
    sigma[:, ::3] = np.nan
    surface["u_y_sigma"] = (("time", "x"), sigma, {"units": "m"})
    settings = recorded_analysis([surface.attrs], [WINDOW])
    noisy, noiseless = (compression_series(one, settings, undeformed_images=4) for one in (surface, clean))
    np.testing.assert_array_equal(noiseless.amplitude_noise, 0.0)
    np.testing.assert_allclose(noisy.amplitude_noise, np.sqrt(np.pi / 2) * 20e-6 / np.sqrt(1.25), rtol=1e-12)
    raw = mean_amplitude(noiseless.envelope, noiseless.X, window=noiseless.window)[4:]
    np.testing.assert_allclose(
        noisy.amplitude[4:], noiseless.amplitude[4:] * np.sqrt(1 - (noisy.amplitude_noise[4:] / raw) ** 2)
    )


def test_strain_is_the_arcs_not_the_ends() -> None:
    made = SlowCompression(margins=(6e-3, 3e-3))
    series = analysed(made).first.series
    np.testing.assert_allclose(series.strain, made.strains, atol=5e-4)
    ends = 1 - (made.length - made.surface()["x_boundary"].values) / made.length
    assert ends[-1] - made.strains[-1] > 5e-3  # the bulge: the chord is shorter than the arc


def test_margins_and_period_doubling() -> None:
    made = SlowCompression(margins=(6e-3, 3e-3), doubling_strain=0.15, doubling=0.4)
    series = analysed(made).first.series
    assert series.struck_margin[-1] == pytest.approx(6e-3, abs=0.6e-3)
    assert series.held_margin[-1] == pytest.approx(3e-3, abs=0.6e-3)
    assert series.doubled[-1] == pytest.approx(0.4, abs=0.01)
    # 0.1 of the amplitude is reached a quarter of the way from 0.15 to 0.2; images are 0.005 apart
    assert series.doubling_strain == pytest.approx(0.1625, abs=0.005)
    assert np.isnan(analysed(SlowCompression()).first.series.doubling_strain)


def test_second_series_on_the_same_sample() -> None:
    """A second test that wrinkles later: 30 % less amplitude near the onset, as in Fig. S6, and none at the end."""
    found = analysed(SlowCompression(), SlowCompression(critical_strain=0.047))
    expected = np.sqrt((0.055 - 0.047) / (0.055 - 0.043))
    assert found.repetition is not None
    at = np.interp(0.055, found.repetition.strain, found.repetition.ratio)
    assert at == pytest.approx(expected, rel=0.03)
    assert found.repetition.ratio[-1] == pytest.approx(1, abs=0.02)
    assert found.summary["critical_strain_change"] == pytest.approx(0.004, abs=3e-4)
    assert found.summary["second_to_first_amplitude_min_strain"] == pytest.approx(0.055, abs=0.003)


def test_images_beyond_the_fitted_strains_do_not_matter() -> None:
    made = SlowCompression(margins=(6e-3, 3e-3), doubling_strain=0.15, doubling=0.5)
    within, all_of_them = (analysed(made, **options).first.fit for options in ({"strains": (0.0, 0.152)}, {}))
    assert within is not None
    assert all_of_them is not None
    assert abs(within.critical_strain - 0.043) < abs(all_of_them.critical_strain - 0.043)
    assert within.n_amplitudes == 31


def test_a_sample_without_wrinkles_is_said_to_have_none() -> None:
    found = analysed(SlowCompression(critical_strain=0.3))
    assert found.first.fit is None
    assert found.summary["critical_strain"] is None
    assert "nothing to fit" in found.warnings[0]


def test_a_window_that_reaches_into_the_margins_is_reported() -> None:
    found = analysed(SlowCompression(margins=(15e-3, 3e-3)))
    assert any("amplitude_window" in warning for warning in found.warnings)
