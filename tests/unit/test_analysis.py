"""Analysis against surface motions and signals whose numbers are known."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from support.settings import SETTINGS
from wrinklewave.analysis.analyse import analyse
from wrinklewave.analysis.boundary import (
    boundary_spectrum,
    contact_time,
    moved,
    separation_time,
    stop_time,
)
from wrinklewave.analysis.filters import low_pass
from wrinklewave.analysis.fronts import ahead_of_front, arrival_times, fit_speed, rise_time
from wrinklewave.analysis.strain import arc_length_strain, arc_positions, strain_rate
from wrinklewave.analysis.wrinkles import (
    amplitude_envelope,
    analytic_signal,
    mean_amplitude,
    wavelength_spectra,
)
from wrinklewave.errors import InputError
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

PIXEL = 50e-6
X_GRID = np.arange(0.0, 50.4e-3, PIXEL)


# the whole analysis


@pytest.mark.parametrize(("front_speed", "wrinkle_speed"), [(57.0, 40.0), (90.0, 32.0)])
def test_travelling_pulse_gives_its_numbers_back(front_speed: float, wrinkle_speed: float) -> None:
    """Speeds within 0.5 %, amplitude within 1 %, wavelength within 0.3 % of the truth."""
    motion = TravellingPulse(front_speed=front_speed, wrinkle_speed=wrinkle_speed)
    result = analyse(motion.surface(), SETTINGS)
    assert result.summary["wavefront_speed_m_per_s"] == pytest.approx(front_speed, rel=5e-3)
    assert result.summary["wavefront_local_speed_m_per_s"] == pytest.approx(front_speed, rel=5e-3)
    assert result.summary["wrinkle_speed_m_per_s"] == pytest.approx(wrinkle_speed, rel=5e-3)
    assert result.summary["wrinkle_to_wavefront_speed_ratio"] == pytest.approx(
        wrinkle_speed / front_speed, rel=1e-2
    )
    assert result.pulse.wavefront.is_line
    assert result.pulse.wavefront.is_line_through_origin
    settled = -20  # the last 0.2 ms
    assert result.wrinkles.amplitude[settled:] == pytest.approx(motion.amplitude, rel=1e-2)
    wavelength = motion.wavelength * (1 - motion.travel / motion.length)
    assert result.wrinkles.spectra.peak[settled:] == pytest.approx(wavelength, rel=3e-3)


def test_strain_along_the_arc_is_that_of_the_surface_without_wrinkles() -> None:
    motion = TravellingPulse(height=3e-3, rise_time=0.5e-3)
    surface = motion.surface()
    exact = arc_length_strain(surface["x"], surface["y_smooth"], surface["x_boundary"], length=motion.length)
    found = analyse(surface, SETTINGS).pulse.arc_strain
    assert exact.max() > 0.1
    np.testing.assert_allclose(found, exact, atol=1e-3)


def test_onset_is_the_first_wrinkle_beyond_the_filters_reach_of_the_struck_end() -> None:
    """It comes at the time of the front, 5 mm (the cut-off) from the end that has moved on meanwhile."""
    motion = TravellingPulse()
    result = analyse(motion.surface(), SETTINGS)
    onset = result.wrinkles.onset
    assert onset.distance == pytest.approx(SETTINGS.filter_wavelength, abs=PIXEL)
    end = min(motion.velocity * onset.time, motion.travel)
    assert onset.position - onset.distance == pytest.approx(end, abs=1e-9)
    front = result.wrinkles.front
    assert onset.time == pytest.approx(front.intercept + onset.position / front.speed, rel=0.1)


def test_wrinkles_at_material_points_run_ahead_of_the_laboratory() -> None:
    """While the travel lasts, a point of undeformed position X is at X + u (1 - X / L) in the laboratory."""
    motion = TravellingPulse()
    fit = analyse(motion.surface(), SETTINGS).wrinkles.material_front
    late = fit.times > motion.travel / motion.velocity  # the end is at rest: dX = dx / (1 - strain)
    speed = np.polyfit(fit.times[late], fit.positions[late], 1)[0]
    strain = motion.travel / motion.length
    assert speed == pytest.approx(motion.wrinkle_speed / (1 - strain), rel=1e-2)


def test_moments_of_the_struck_end() -> None:
    """10 m/s to 6.3 mm: 50 um after 5 us, the stop after 630 us; the end does not outrun the striker."""
    result = analyse(TravellingPulse().surface(), SETTINGS)
    assert result.summary["contact_time_s"] == pytest.approx(5e-6, abs=1e-9)
    assert result.summary["stop_time_s"] == pytest.approx(630e-6, abs=1e-9)
    assert result.summary["separation_time_s"] is None


def test_strain_rate_and_expected_wrinkles() -> None:
    motion = TravellingPulse(height=0.0, amplitude=0.0)
    result = analyse(motion.surface(), SETTINGS)
    assert result.summary["strain_rate_max_per_s"] == pytest.approx(10.0 / 50.4e-3, rel=1e-6)
    assert result.strains is not None
    assert result.quasi_static is not None
    # a flat surface: its arc is the block's length less the travel
    assert result.quasi_static.strain_at_rest == pytest.approx(0.125, abs=1e-6)
    assert result.summary["amplitude_at_rest_m"] == pytest.approx(1.765316e-4, rel=1e-5)


def test_scalars_of_the_strain_say_where_and_how_much() -> None:
    """A map of a few values: largest beyond 2 mm from the end, reach of 500 /s, share of 300 /s, margin, strains."""
    surface = TravellingPulse(end_time=1e-3, interval=20e-6).surface()
    X, strain, rate = surface["X"].values, surface["strain_xx"].values.copy(), np.zeros((51, 203))
    rate[10:20] = np.where(X < 8e-3, 600.0, np.where(X < 20e-3, 350.0, 100.0))
    rate[15, X <= 2e-3] = 5000.0
    strain[5, X < 1e-3], strain[-1] = 0.5, np.where(X < 3e-3, 0.01, 0.1)
    surface["strain_xx"] = (("time", "point"), strain, {"units": "1"})
    surface["strain_rate_xx"] = (("time", "point"), rate, {"units": "1/s"})
    summary = analyse(surface, SETTINGS).summary
    away = X[X > 2e-3]
    assert summary["strain_rate_max_per_s"] == 600.0
    assert summary["strain_rate_max_overall_per_s"] == 5000.0
    assert summary["strain_rate_above_500_per_s_reach_m"] == X[X >= 8e-3][0]
    assert summary["strain_rate_above_300_per_s_share"] == pytest.approx(10 / 51 * (away < 20e-3).mean())
    assert summary["strain_max"] == pytest.approx(strain[:, X > 2e-3].max())
    assert summary["strain_max_over_critical_strain"] == pytest.approx(0.5 / 0.043)
    assert summary["wrinkle_free_margin_at_end_m"] == X[X >= 3e-3][0]
    surface["strain_rate_xx"].values[12] = 600.0
    surface["strain_xx"].values[-1] = 0.01
    everywhere = analyse(surface, SETTINGS).summary
    assert everywhere["strain_rate_above_500_per_s_reach_m"] == 50.4e-3
    assert everywhere["wrinkle_free_margin_at_end_m"] == 50.4e-3


def test_scalars_of_the_pulse_are_those_of_its_step() -> None:
    """A step 10 s^3 - 15 s^4 + 6 s^5 within the rise time; far from the end the filter does nothing to it."""
    motion = TravellingPulse(amplitude=0.0)
    surface = motion.surface()
    front = surface["x"].values > 40e-3
    surface["u_y"].values[:, front] *= 0.5  # so that places can be told apart
    surface["y"].values[:, front] -= surface["u_y"].values[:, front]
    summary = analyse(surface, SETTINGS).summary
    s = np.linspace(0.0, 1.0, 10_001)
    tenth, nine = np.interp([0.1, 0.9], s**3 * (10 - 15 * s + 6 * s**2), s)
    for place in (15, 25, 45):
        assert summary[f"rise_time_at_{place}_mm_s"] == pytest.approx(
            (nine - tenth) * motion.rise_time, rel=5e-3
        )
    assert summary["displacement_max_m"] == pytest.approx(motion.height, rel=0.03)
    # where the front (a tenth of the maximum) arrives, the step 10 mm ahead is as far as 10 mm / front speed ago
    ahead = np.interp(
        tenth - 10e-3 / motion.front_speed / motion.rise_time, s, s**3 * (10 - 15 * s + 6 * s**2)
    )
    assert summary["displacement_10_mm_ahead_of_wavefront_m"] == pytest.approx(
        motion.height * ahead, abs=0.02 * motion.height
    )


def test_wrinkles_over_those_of_eq_1() -> None:
    """A flat surface: 0.15 mm at a strain of 0.125, where Eq. 1 has 0.1765 mm; 1.75 mm where it has 1.836 mm."""
    summary = analyse(TravellingPulse(height=0.0).surface(), SETTINGS).summary
    assert summary["wrinkle_amplitude_over_expected"] == pytest.approx(0.15 / 0.1765316, rel=1e-2)
    assert summary["wavelength_m"] == pytest.approx(1.75e-3, rel=3e-3)
    assert summary["wavelength_over_expected"] == pytest.approx(1.75 / 1.836, rel=3e-3)
    before = analyse(TravellingPulse(height=0.0, end_time=0.2e-3).surface(), SETTINGS).summary
    assert before["wrinkle_amplitude_over_expected"] is None  # nothing is seen yet


def test_a_surface_without_film_or_strain_is_analysed_as_far_as_it_goes() -> None:
    surface = TravellingPulse(amplitude=0.0, end_time=1e-3, interval=20e-6).surface()
    surface = surface.drop_vars(["strain_xx", "y_smooth", "u_y_smooth", "amplitude"])
    surface.attrs = {"kind": "measurement", "name": "bare", "length": 50.4e-3}
    result = analyse(surface, SETTINGS)
    assert result.strains is None
    assert result.quasi_static is None
    assert result.summary["wrinkle_speed_m_per_s"] is None
    assert result.summary["wavefront_speed_m_per_s"] == pytest.approx(57.0, rel=5e-3)


def test_a_struck_end_that_was_never_seen_costs_its_own_results_only() -> None:
    surface = TravellingPulse(end_time=2e-3, interval=20e-6).surface()
    surface["x_boundary"] = surface["x_boundary"] * np.nan
    surface["x_boundary"].attrs["units"] = "m"
    summary = analyse(surface, SETTINGS).summary
    assert summary["wavefront_speed_m_per_s"] == pytest.approx(57.0, rel=5e-3)
    for name in ("contact_time_s", "boundary_bandwidth_hz", "boundary_displacement_max_m", "arc_strain_max"):
        assert summary[name] is None, name


def test_a_sample_at_rest_has_no_fronts_and_no_wrinkles() -> None:
    motion = TravellingPulse(velocity=0.0, travel=0.0, height=0.0, amplitude=0.0, end_time=1e-4)
    summary = analyse(motion.surface(), SETTINGS).summary
    for name in (
        "wavefront_speed_m_per_s",
        "wrinkle_speed_m_per_s",
        "wrinkle_onset_time_s",
        "contact_time_s",
    ):
        assert summary[name] is None, name


def test_times_may_be_uneven() -> None:
    """Frames that were lost cost accuracy in time, nothing else."""
    motion = TravellingPulse()
    kept = np.delete(np.arange(401), [20, 21, 55, 90, 91])
    summary = analyse(motion.surface().isel(time=kept), SETTINGS).summary
    assert summary["wavefront_speed_m_per_s"] == pytest.approx(motion.front_speed, rel=5e-3)


@pytest.mark.parametrize(
    ("selection", "message"),
    [({"x": [0, 1, 3, 4, 5, 6]}, "even spacing"), ({"time": [0, 1, 2]}, "at least four")],
)
def test_grids_that_cannot_be_analysed_are_refused(selection: dict[str, list[int]], message: str) -> None:
    surface = TravellingPulse(end_time=2e-4).surface().isel(selection)
    with pytest.raises(InputError, match=message):
        analyse(surface, SETTINGS)


# fronts


@given(speed=st.floats(1.0, 500.0), delay=st.floats(0.0, 1e-3))
def test_a_straight_front_has_its_speed(speed: float, delay: float) -> None:
    fit = fit_speed(X_GRID, delay + X_GRID / speed, window=(12e-3, 40e-3), start=delay)
    assert fit.speed == pytest.approx(speed, rel=1e-6)
    assert fit.origin_speed == pytest.approx(speed, rel=1e-6)
    assert fit.intercept == pytest.approx(delay, abs=1e-9)


def test_uncertainty_of_a_speed_covers_the_scatter_of_many() -> None:
    """Independent and correlated errors of arrival: the stated sigma is the scatter over 300 trials."""
    rng = np.random.default_rng(7)
    for correlation, tolerance in ((0.0, 0.1), (0.6, 0.25)):
        speeds, sigmas = [], []
        for _ in range(300):
            noise = np.empty(200)
            noise[0] = rng.normal()
            for i in range(1, 200):
                noise[i] = correlation * noise[i - 1] + np.sqrt(1 - correlation**2) * rng.normal()
            x = np.linspace(0.0, 50e-3, 200)
            fit = fit_speed(x, x / 50.0 + 20e-6 * noise, window=(0.0, 1.0))
            speeds.append(fit.speed)
            sigmas.append(fit.speed_sigma)
        assert np.mean(sigmas) == pytest.approx(np.std(speeds), rel=tolerance)


def test_a_front_that_is_everywhere_at_once_has_no_speed() -> None:
    fit = fit_speed(X_GRID, np.full(X_GRID.size, 1e-3), window=(12e-3, 40e-3))
    assert np.isnan(fit.speed)
    assert np.isnan(fit.speed_sigma)


def test_arrivals_are_interpolated_across_gaps() -> None:
    field = np.array([[0.0, 0.0, 5.0], [np.nan, 1.0, 6.0], [4.0, 1.0, 7.0]])
    arrival = arrival_times([0.0, 1.0, 2.0], field, 2.0)
    np.testing.assert_allclose(arrival, [1.0, np.nan, np.nan])  # never, and beyond it from the start


def test_uncertainty_of_a_speed_of_few_independent_arrivals_is_the_textbooks() -> None:
    """Residuals of alternating sign do not correlate: sigma^2 = r.r/(n - 2) (D^T D)^-1, as in scipy's regression."""
    from scipy.stats import linregress

    x = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    times = 0.1 * x + np.array([0.01, -0.02, 0.01, -0.02, 0.02])
    fit, line = fit_speed(x, times, window=(0.0, 4.0)), linregress(x, times)
    assert fit.speed == pytest.approx(1 / line.slope, rel=1e-9)
    assert fit.speed_sigma == pytest.approx(line.stderr / line.slope**2, rel=1e-9)
    residual = times - (line.intercept + line.slope * x)
    assert fit.residual_rms == pytest.approx(np.sqrt(np.mean(residual**2)))


def test_values_ahead_of_a_front_are_those_of_its_arrival() -> None:
    """A field t + 10 x, 2 ahead of a front of speed 1: x + 10 (x + 2), up to the end of the grid."""
    x, time = np.arange(1.0, 11.0), np.linspace(0.0, 12.0, 121)
    front = fit_speed(x, x, window=(3.0, 10.0))
    values = ahead_of_front(time, x, time[:, None] + 10 * x, front, distance=2.0)
    np.testing.assert_allclose(values, [at + 10 * (at + 2) for at in (3, 4, 5, 6, 7, 8)])


def test_rise_time_of_a_ramp() -> None:
    time = np.linspace(0.0, 2.0, 201)
    assert rise_time(time, np.clip(time, 0.0, 1.0)) == pytest.approx(0.8, abs=1e-9)


# the filter


@pytest.mark.parametrize("wavelength", [1e-3, 2e-3, 5e-3, 10e-3, 25e-3])
def test_filter_has_the_stated_transfer_function(wavelength: float) -> None:
    x = np.arange(0.0, 0.2, PIXEL)
    wave = np.cos(2 * np.pi * x / wavelength + 0.3)
    smooth = low_pass(wave[None], spacing=PIXEL, cutoff_wavelength=5e-3)[0]
    ratio = np.sin(np.pi * PIXEL / wavelength) / np.sin(np.pi * PIXEL / 5e-3)
    inside = (x > 0.06) & (x < 0.14)
    np.testing.assert_allclose(smooth[inside], wave[inside] / (1 + ratio**6), atol=2e-6)


@given(st.lists(st.floats(-1.0, 1.0), min_size=3, max_size=3), st.integers(0, 40), st.integers(60, 100))
@settings(max_examples=25)
def test_filter_passes_parabolas_through_edges_and_gaps(c: list[float], start: int, gap: int) -> None:
    s = np.linspace(-1.0, 1.0, 300)
    parabola = c[0] + c[1] * s + c[2] * s**2
    row = parabola.copy()
    row[:start] = np.nan
    row[100 : 100 + gap] = np.nan
    smooth = low_pass(row[None], spacing=PIXEL, cutoff_wavelength=5e-3)[0]
    np.testing.assert_array_equal(np.isnan(smooth), np.isnan(row))
    known = np.isfinite(row)
    np.testing.assert_allclose(smooth[known], parabola[known], atol=1e-6)


def test_rows_with_too_few_values_become_unknown() -> None:
    rows = np.full((1, 50), np.nan)
    rows[0, 10:13] = 1.0
    assert np.isnan(low_pass(rows, spacing=PIXEL, cutoff_wavelength=5e-3)).all()


@pytest.mark.parametrize("cutoff", [0.5 * PIXEL, 500 * PIXEL])
def test_cutoffs_that_do_not_suit_the_grid_are_refused(cutoff: float) -> None:
    with pytest.raises(InputError, match="filter_wavelength"):
        low_pass(np.zeros((1, 50)), spacing=PIXEL, cutoff_wavelength=cutoff)


# amplitude and wavelength


@given(wavelength=st.floats(1.5e-3, 2.5e-3), phase=st.floats(0.0, 6.28))
@settings(max_examples=40)
def test_a_sinusoid_has_its_amplitude_and_wavelength(wavelength: float, phase: float) -> None:
    wrinkles = 1.5e-4 * np.cos(2 * np.pi * X_GRID / wavelength + phase)[None]
    amplitude = mean_amplitude(amplitude_envelope(wrinkles), X_GRID, window=(16e-3, 49e-3))
    assert amplitude[0] == pytest.approx(1.5e-4, rel=1e-2)
    spectra = wavelength_spectra(wrinkles, X_GRID, window=(16e-3, 49e-3), longest=5e-3)
    assert spectra.peak[0] == pytest.approx(wavelength, rel=1e-3)
    assert spectra.magnitude.max() == pytest.approx(1.5e-4, rel=1e-2)


@pytest.mark.parametrize("n", [60, 75])
def test_analytic_signal_is_scipys(n: int) -> None:
    from scipy.fft import next_fast_len
    from scipy.signal import hilbert

    signal = np.random.default_rng(1).normal(size=(3, n))
    expected = hilbert(signal, N=next_fast_len(2 * n), axis=-1)[:, :n]
    np.testing.assert_allclose(analytic_signal(signal), expected, atol=1e-12)


def test_amplitude_leaves_out_what_is_unknown() -> None:
    wrinkles = 1.5e-4 * np.cos(2 * np.pi * X_GRID / 2e-3)[None]
    wrinkles[:, 500:520] = np.nan
    envelope = amplitude_envelope(wrinkles)
    assert np.isnan(envelope[0, 500:520]).all()
    amplitude = mean_amplitude(envelope, X_GRID, window=(16e-3, 49e-3))
    # zeros in a gap of half a wavelength depress the envelope beside it
    assert 0.93 * 1.5e-4 < amplitude[0] < 1.5e-4
    assert np.isnan(mean_amplitude(np.full((1, X_GRID.size), np.nan), X_GRID, window=(16e-3, 49e-3)))


def test_faint_spectra_have_no_wavelength() -> None:
    wave = np.cos(2 * np.pi * X_GRID / 2e-3)
    spectra = wavelength_spectra(
        np.stack([wave, 1e-3 * wave, 0 * wave]), X_GRID, window=(0.0, 1.0), longest=5e-3
    )
    np.testing.assert_array_equal(np.isnan(spectra.peak), [False, True, True])


# the struck end


def test_spectrum_of_an_oscillating_end_peaks_at_its_frequency() -> None:
    time = np.arange(0.0, 20e-3, 10e-6)
    spectrum = boundary_spectrum(time, 1e-3 * np.sin(2 * np.pi * 400.0 * time))
    assert spectrum.frequency[spectrum.magnitude.argmax()] == pytest.approx(400.0, abs=10.0)
    assert spectrum.magnitude.max() == 1.0


def test_bandwidth_of_a_decay() -> None:
    """exp(-t/T) has the magnitude 1/sqrt(1 + (2 pi f T)^2), a tenth of the largest at 2 pi f T = sqrt(99)."""
    decay = 1e-3
    time = 5e-3 + np.arange(0.0, 12e-3, 4e-6)
    lost = np.delete(np.arange(time.size), [700, 701, 1500])  # frames, bridged
    spectrum = boundary_spectrum(time[lost], np.exp(-(time[lost] - time[0]) / decay))
    assert spectrum.bandwidth == pytest.approx(np.sqrt(99) / (2 * np.pi * decay), rel=0.02)
    expected = 1 / np.hypot(1, 2 * np.pi * spectrum.frequency * decay)
    low = spectrum.frequency < 3e3
    np.testing.assert_allclose(spectrum.magnitude[low], expected[low], atol=3e-3)


def test_the_end_moves_from_where_it_was_first_seen() -> None:
    np.testing.assert_array_equal(moved([np.nan, 2.0, np.nan, 2.5]), [np.nan, 0.0, np.nan, 0.5])


def test_contact_stop_and_separation() -> None:
    time = np.linspace(0.0, 2e-3, 201)
    displacement = 5.0 * time  # 50 um after 10 us; 6.3 mm after 1.26 ms; 50 um more after 1.27 ms
    assert contact_time(time, displacement) == pytest.approx(10e-6)
    assert stop_time(time, displacement, stop_distance=6.3e-3) == pytest.approx(1.26e-3)
    assert separation_time(time, displacement, stop_distance=6.3e-3) == pytest.approx(1.27e-3)
    assert np.isnan(separation_time(time, displacement, stop_distance=20e-3))


# strain


def test_arc_strain_of_a_circular_arc() -> None:
    """Half-width a, radius R: s = 2 R asin(a / R); polygons on the grid are shorter by (dx/R)^2/24."""
    length, radius = 50e-3, 60e-3
    x = np.linspace(0.0, length, 1001)
    height = np.sqrt(radius**2 - (x - length / 2) ** 2)
    strain = arc_length_strain(x, height[None], [0.0], length=length)
    exact = 1 - 2 * radius * np.arcsin(length / 2 / radius) / length
    assert strain[0] == pytest.approx(exact, abs=1e-7)


def test_arc_strain_of_a_flat_surface_is_that_of_its_ends() -> None:
    x = np.linspace(0.0, 50e-3, 1001)
    height = np.full((2, x.size), 1.0)
    height[:, :150] = np.nan  # the struck end is somewhere in between grid points, and more is lost beside it
    height[1, 400:500] = np.nan
    np.testing.assert_allclose(
        arc_length_strain(x, height, [0.0, 5.01e-3], length=50e-3), [0.0, 0.1002], atol=1e-12
    )


@given(slope=st.floats(-2.0, 2.0), first=st.integers(0, 20), last=st.integers(30, 49))
def test_arc_of_an_incline_runs_to_its_ends(slope: float, first: int, last: int) -> None:
    """What was not seen at the ends and in between continues straight."""
    x = np.linspace(1.0, 3.0, 50)
    height = slope * x
    height[:first] = height[last:] = height[24:27] = np.nan
    positions, length = arc_positions(x, height, start=0.9, end=3.2)
    assert length == pytest.approx(np.hypot(1, slope) * 2.3)
    np.testing.assert_allclose(
        positions, np.where(np.isfinite(height), np.hypot(1, slope) * (x - 0.9), np.nan), rtol=1e-12
    )


def test_strain_rate_of_a_parabola_in_time() -> None:
    time = np.linspace(0.0, 1e-3, 101)
    rate = strain_rate(time, 1e4 * time[:, None] ** 2 * np.ones(3))
    np.testing.assert_allclose(rate[1:-1], (2e4 * time[1:-1, None]) * np.ones(3), rtol=1e-9)


def test_filter_treats_every_row_alike() -> None:
    rows = np.random.default_rng(1).normal(size=(4, 200))
    rows[2, 50:70] = np.nan
    together = low_pass(rows, spacing=1e-4, cutoff_wavelength=2e-3)
    alone = [low_pass(row, spacing=1e-4, cutoff_wavelength=2e-3) for row in rows]
    np.testing.assert_allclose(together, alone, rtol=1e-12)


def test_a_bridged_gap_does_not_pass_for_a_wrinkle() -> None:
    """A bump where the surface is hardly known, long before the wrinkles come, as where a wire hides it."""
    surface = TravellingPulse().surface()
    rows, columns = slice(20, 22), slice(260, 280)
    surface["u_y"].values[rows, columns] += 80e-6
    surface["y"].values[rows, columns] += 80e-6
    sigma = np.full(surface["u_y"].shape, 3e-6)
    sigma[:, columns] = 50e-6
    believed = analyse(surface, SETTINGS).wrinkles.front
    surface["u_y_sigma"] = (("time", "x"), sigma, {"units": "m"})
    doubted = analyse(surface, SETTINGS).wrinkles.front
    true = analyse(TravellingPulse().surface(), SETTINGS).wrinkles.front
    assert abs(believed.speed / true.speed - 1) > 0.02
    assert doubted.speed == pytest.approx(true.speed, rel=0.005)
