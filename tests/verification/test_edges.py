"""The edge detector against exact images, and its errors against the Cramér-Rao bound."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.special import ndtr

from wrinklewave.imaging.edges import EdgeFinder, Optics
from wrinklewave.imaging.edges.bounds import band_limited_bound, column_bound, mean_column_bound
from wrinklewave.imaging.edges.columns import find_columns
from wrinklewave.imaging.edges.lateral import lateral_kernels, local_kernels
from wrinklewave.imaging.edges.levels import Levels
from wrinklewave.imaging.edges.locking import PixelLocking
from wrinklewave.imaging.edges.profile import blurred_step, blurred_step_at, normal_distribution
from wrinklewave.imaging.edges.regularised import band_limited_surface, penalty

Surface = Callable[[NDArray[np.float64]], NDArray[np.float64]]

LOW, HIGH = 400.0, 1600.0
_SUB = 8  # sub-columns per pixel for the lateral convolution


def edge_image(
    surface: Callable[[NDArray[np.float64]], NDArray[np.float64]], shape: tuple[int, int], blur: float
) -> NDArray[np.float64]:
    """Grey values of a step at the row ``surface(column)``, HIGH below it; blur is a standard deviation [px].

    Down a column the convolution and the pixel's integral are exact: s [G((u + 1/2)/s) - G((u - 1/2)/s)] with
    G(t) = t Phi(t) + phi(t). Along the row both are one kernel, Phi((x + 1/2)/s) - Phi((x - 1/2)/s), summed
    over sub-columns at the midpoint rule.
    """
    n_rows, n_columns = shape
    pad = int(np.ceil(6 * blur)) + 2
    x = (np.arange((n_columns + 2 * pad) * _SUB) + 0.5) / _SUB - 0.5 - pad
    u = np.arange(n_rows)[:, None] - surface(x)[None, :]
    profile = blur * (_G((u + 0.5) / blur) - _G((u - 0.5) / blur))
    offset = (np.arange(-pad * _SUB, pad * _SUB) + 0.5) / _SUB
    kernel = ndtr((offset + 0.5) / blur) - ndtr((offset - 0.5) / blur)
    kernel /= kernel.sum()
    windows = np.lib.stride_tricks.sliding_window_view(profile, 2 * pad * _SUB, axis=1)
    return LOW + (HIGH - LOW) * (windows[:, _SUB // 2 :: _SUB][:, :n_columns] @ kernel)


def with_noise(image: NDArray[np.float64], contrast_to_noise: float, seed: int) -> NDArray[np.float32]:
    """The image with white Gaussian noise, rounded to whole grey values."""
    noise = np.random.default_rng(seed).normal(0, (HIGH - LOW) / contrast_to_noise, image.shape)
    return np.round(image + noise).astype(np.float32)


def _G(t: NDArray[np.float64]) -> NDArray[np.float64]:
    return t * ndtr(t) + np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi)


def _errors(
    surface: Surface,
    blur: float,
    contrast_to_noise: float,
    *,
    n_images: int,
    n_columns: int = 512,
    trim: int = 12,
    seed: int = 0,
) -> dict[str, NDArray[np.float64]]:
    """Errors, as they are and over their uncertainties, of images that differ in their noise; no ends."""
    clean = edge_image(surface, (96, n_columns), blur)
    finder = EdgeFinder(Optics(blur=blur, sample_brighter=True))
    truth = surface(np.arange(float(n_columns)))
    found = [finder.find(with_noise(clean, contrast_to_noise, seed + i)) for i in range(n_images)]
    inner = slice(trim, n_columns - trim)
    assert all(edge.valid[inner].all() for edge in found)
    assert np.mean([edge.column_valid[inner] for edge in found]) > 0.995
    errors = {
        "surface": np.array([edge.rows - truth for edge in found]),
        "column": np.array([edge.column_rows - truth for edge in found]),
    }
    reduced = {
        "surface_reduced": errors["surface"] / np.array([edge.sigma for edge in found]),
        "column_reduced": errors["column"] / np.array([edge.column_sigma for edge in found]),
    }
    return {name: values[:, inner] for name, values in (errors | reduced).items()}


def _rms(values: NDArray[np.float64]) -> float:
    return float(np.sqrt(np.nanmean(np.square(values))))


def _tilted(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """A slow tilt passes through every sub-pixel phase."""
    return 45.2 + 0.011 * x


def _wrinkled(amplitude: float, wavelength: float) -> Surface:
    return lambda x: 47.8 + amplitude * np.cos(2 * np.pi * x / wavelength)


def _turned(x: NDArray[np.float64]) -> NDArray[np.float64]:
    """Steep (slope 1.3) at the left, as where the surface turns near the struck end."""
    return 20 + 65 * np.exp(-x / 50) + 0.3 * np.sin(2 * np.pi * x / 33)


def _band_limited(resolution: float, seed: int, rms: float = 0.5) -> Surface:
    """Random waves of equal power per wave number, none shorter than ``resolution``."""
    rng = np.random.default_rng(seed)
    k = rng.uniform(2 * np.pi / 400, 2 * np.pi / resolution, 60)
    phase = rng.uniform(0, 2 * np.pi, 60)
    return lambda x: 47.5 + rms * np.sqrt(2 / 60) * np.cos(k[:, None] * x + phase[:, None]).sum(axis=0)


def test_column_bound_in_the_limit_of_small_pixels() -> None:
    # Integral of the squared sensitivity phi(u/s)^2/s^2 du = 1/(2 sqrt(pi) s): sigma = sqrt(2 sqrt(pi)
    # s)/CNR;
    # for s = 1.2 px and CNR 20 it is 0.1031 px. The pixel widens the blur: s^2 -> s^2 + 1/12, to order s^-4.
    assert np.sqrt(2 * np.sqrt(np.pi) * 1.2) / 20 == pytest.approx(0.1031, abs=1e-4)
    assert column_bound(20, 12.0) == pytest.approx(np.sqrt(2 * np.sqrt(np.pi) * 12.0) / 20, rel=2e-4)
    assert column_bound(20, 1.2) == pytest.approx(
        np.sqrt(2 * np.sqrt(np.pi) * np.hypot(1.2, 12**-0.5)) / 20, rel=2e-3
    )


def test_band_limited_bound_without_blur_counts_degrees_of_freedom() -> None:
    # 2/R independent values per column: sigma = sigma_column sqrt(2/R) but for the pixel's width,
    # exp(k^2/12).
    expected = mean_column_bound(20, 0.3) * np.sqrt(2 / 50)
    assert band_limited_bound(20, 0.3, 50) == pytest.approx(expected, rel=2e-3)


@pytest.mark.parametrize("blur", [0.5, 1.2, 2.0, 3.0])
@pytest.mark.parametrize(
    "surface", [_tilted, _wrinkled(2.0, 36.3), _turned], ids=["tilted", "wrinkled", "turned"]
)
def test_bias(surface: Surface, blur: float) -> None:
    """Below 0.01 px root mean square along the surface; noise contributes under 0.002 px here."""
    errors = _errors(surface, blur, 1000, n_images=1, trim=20)
    assert _rms(errors["surface"]) < 0.01
    assert _rms(errors["column"]) < 0.01
    assert abs(errors["surface"].mean()) < 0.002


def test_bias_under_uneven_lighting() -> None:
    """A lamp that falls off by a third along the sample and a fifth across the frame."""
    clean = edge_image(_tilted, (96, 512), 1.2)
    rows, columns = np.mgrid[:96, :512]
    lamp = (1 - 0.33 * (columns / 512) ** 2) * (0.8 + 0.2 * rows / 96)
    edge = EdgeFinder(Optics(1.2, True)).find((clean * lamp).astype(np.float32))
    error = (edge.rows - _tilted(np.arange(512.0)))[20:-20]
    assert _rms(error) < 0.01


@pytest.mark.parametrize("contrast_to_noise", [5, 20, 100])
@pytest.mark.parametrize("blur", [0.5, 1.2, 3.0])
def test_columns_reach_the_bound(blur: float, contrast_to_noise: float) -> None:
    """Random error within 1.1 of the bound; 20,000 columns leave 0.5 % of statistical uncertainty."""
    errors = _errors(_tilted, blur, contrast_to_noise, n_images=40)
    bounds = [column_bound(contrast_to_noise, blur, phase=row % 1) for row in _tilted(np.arange(12.0, 500))]
    assert _rms(errors["column"] / bounds) < 1.1
    assert 0.95 < _rms(errors["column_reduced"]) < 1.11


@pytest.mark.parametrize("contrast_to_noise", [5, 20, 100])
@pytest.mark.parametrize("blur", [0.5, 1.2, 2.0, 3.0])
def test_regularised_surface_reaches_the_bound(blur: float, contrast_to_noise: float) -> None:
    """All errors, bias included, within 1.3 of the bound for surfaces band-limited at the resolution."""
    resolution = EdgeFinder(Optics(blur, True)).resolution
    assert resolution == pytest.approx(10.0) or blur > 1.9
    errors = [
        _errors(_band_limited(resolution, i), blur, contrast_to_noise, n_images=4, seed=100 * i)
        for i in range(10)
    ]
    total = _rms(np.array([error["surface"] for error in errors]))
    assert total < 1.3 * band_limited_bound(contrast_to_noise, blur, resolution)
    assert total > 0.8 * band_limited_bound(contrast_to_noise, blur, resolution)


@pytest.mark.parametrize("blur", [0.5, 1.2, 2.0, 3.0])
def test_wrinkles_of_twenty_pixels_keep_their_amplitude(blur: float) -> None:
    """Within 1 % of the amplitude of 1 px; the fit's own noise is 0.1 %."""
    surface = _wrinkled(1.0, 20.0)
    errors = _errors(surface, blur, 200, n_images=4, n_columns=1024, trim=32)
    x = np.arange(32.0, 992.0)
    found = errors["surface"].mean(axis=0) + surface(x) - 47.8
    wave = np.exp(-2j * np.pi * x / 20)
    assert abs(2 * np.mean(found * wave)) == pytest.approx(1.0, abs=0.01)


@pytest.mark.parametrize("blur", [0.5, 1.2, 2.0, 3.0])
def test_steep_short_wrinkles_are_unbiased_under_noise(blur: float) -> None:
    """Slopes to 0.94. The mean of 24 wavelengths in 40 images leaves 0.003 px of noise at 3 px of blur."""
    errors = _errors(_wrinkled(3.0, 20.0), blur, 20, n_images=40, trim=16)
    for resolution in ("surface", "column"):
        assert _rms(np.nanmean(errors[resolution].reshape(40, 24, 20), axis=(0, 1))) < 0.01


@pytest.mark.parametrize("blur", [0.5, 1.2, 3.0])
def test_waves_pass_with_the_stated_gain(blur: float) -> None:
    # Level columns known to 0.1 px: 1 - h^2, h = q u / (b^2 + q u), u = (sin(k/2) / sin(pi/R))^16, q = 0.81 b(R)^2,
    # with b = exp(-k^2 v/2); the operator's own b is that of its kernel, so both are taken from it.
    n, R = 600, max(10.0, 5.5 * np.hypot(blur, 12**-0.5))
    local = local_kernels(np.zeros(n), lateral_kernels(blur))
    reach, x = local.shape[0] // 2, np.arange(float(n))
    offsets = np.arange(-reach, reach + 1)
    sigma = np.full(n, 0.1)
    for wavelength in (0.8 * R, R, 1.2 * R, 20.0):
        k = 2 * np.pi / wavelength
        b = local[:, 0] @ np.cos(k * offsets)
        qu = 0.81 * np.exp(-((2 * np.pi / R) ** 2) * (blur**2 + 1 / 12))
        qu *= (np.sin(k / 2) / np.sin(np.pi / R)) ** 16
        rows = b * np.cos(k * x)
        found, _ = band_limited_surface(rows, sigma, 0.1, np.zeros(n), local, penalty(R, blur))
        middle = slice(200, 400)
        gain = found[reach:-reach][middle] @ np.cos(k * x)[middle] / np.sum(np.cos(k * x)[middle] ** 2)
        assert gain == pytest.approx(1 - (qu / (b**2 + qu)) ** 2, abs=2e-3)


@pytest.mark.parametrize("blur", [0.5, 1.2, 2.0, 3.0])
def test_lateral_kernels_have_their_variance(blur: float) -> None:
    # v (1 + m^2/2)/(1 + m^2), v = s^2 + 1/12, level and very steep
    for slope, share in ((0.0, 1.0), (1e4, 0.5)):
        kernel = local_kernels(np.array([slope]), lateral_kernels(blur))[:, 0]
        offsets = np.arange(kernel.size) - kernel.size // 2
        assert kernel.sum() == pytest.approx(1.0, abs=1e-12)
        assert kernel @ offsets**2 == pytest.approx(share * (blur**2 + 1 / 12), rel=1e-6)


def test_uncertainties_are_honest() -> None:
    errors = _errors(_wrinkled(2.0, 36.3), 1.2, 20, n_images=16)
    assert 0.9 < _rms(errors["surface_reduced"]) < 1.05  # a posterior's, so a little larger than the error
    assert 0.97 < _rms(errors["column_reduced"]) < 1.06


def test_pixel_locking_is_absent_and_would_be_seen() -> None:
    finder = EdgeFinder(Optics(1.2, True))
    locking = PixelLocking.none()
    pulled = PixelLocking.none()
    clean = edge_image(_tilted, (96, 512), 1.2)
    for seed in range(20):
        edge = finder.find(with_noise(clean, 20, seed))
        residual = edge.column_rows - edge.rows
        locking += PixelLocking.of(edge.rows, residual)
        pulled += PixelLocking.of(edge.rows, residual + 0.02 * np.sin(2 * np.pi * edge.rows))
    assert locking.amplitude < 0.005
    assert pulled.amplitude == pytest.approx(0.02 / np.sqrt(2), abs=0.004)


@pytest.mark.parametrize("blur", [0.5, 1.2, 3.0])
def test_single_precision_and_the_approximated_profile_cost_less_than_a_ten_thousandth_of_a_pixel(
    blur: float,
) -> None:
    """Columns without noise, and without neighbours: I = LOW + (HIGH - LOW) E(r - y), levels known."""
    rng = np.random.default_rng(5)
    rows = 150.0 + rng.uniform(-20.0, 20.0, 400)
    profile = blurred_step(np.arange(256.0)[:, None] - rows, blur)
    ones = np.ones(rows.size)
    levels = Levels(
        origin=rows,
        blur=blur * ones,
        bands=np.zeros((2, 6, rows.size)),
        value=np.array([LOW * ones, HIGH * ones]),
        gradient=np.zeros((2, rows.size)),
        noise=np.array([20.0, 30.0]),
        usable=ones > 0,
        blocked=ones < 0,
        contrast=HIGH - LOW,
    )
    image = (LOW + (HIGH - LOW) * profile).astype(np.float32)
    found = find_columns(
        image, rows + rng.uniform(-0.1, 0.1, rows.size), levels.blur, levels, levels.usable, 5e-3
    )
    np.testing.assert_allclose(found.rows, rows, rtol=0.0, atol=1e-4)


def test_the_approximated_profile_is_that_of_the_normal_distribution() -> None:
    """Phi to 1e-7, its integral to 1e-6, and E by them to a millionth of a step."""
    t = np.linspace(-9.0, 9.0, 4001)
    found = np.array([normal_distribution(one) for one in t])
    density = np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi)
    np.testing.assert_allclose(found[:, 0], ndtr(t), rtol=0, atol=1e-7)
    np.testing.assert_allclose(found[:, 1], t * ndtr(t) + density, rtol=0, atol=1e-6)
    for blur in (0.5, 1.2, 3.0):
        step = np.array([blurred_step_at(u, blur) for u in t])
        np.testing.assert_allclose(step[:, 0], blurred_step(t, blur), rtol=0, atol=3e-6)
        np.testing.assert_allclose(step[:, 1], ndtr((t + 0.5) / blur) - ndtr((t - 0.5) / blur), atol=2e-7)
