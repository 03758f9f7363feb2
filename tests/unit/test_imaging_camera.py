"""The synthetic camera against exact images and against its own truth."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from numpy.typing import NDArray
from scipy.special import ndtr

from wrinklewave.errors import InputError
from wrinklewave.imaging.camera import Camera, Film, Levels, Striker, Wires, film
from wrinklewave.imaging.camera.optics import add_layer, sampling, sub_columns
from wrinklewave.surface import surface_motion

PIXEL = 50e-6
EVEN = Levels(background=0.0, sample=1.0, striker=0.5, wire=0.5)
CAMERA = Camera(
    shape=(96, 160),
    scale=1 / PIXEL,
    origin=(10.0, 40.0),
    exposure=0.0,
    levels=EVEN,
    gradient=(0.0, 0.0),
    read_noise=0.0,
    full_well=math.inf,
)


def _surface(height=lambda t, x: 0 * x, boundary=lambda t: 0.0, n_times: int = 21) -> xr.Dataset:  # type: ignore[no-untyped-def]
    """A surface motion from functions of time and place, 7 mm long."""
    time, x, X = np.arange(n_times) * 10e-6, np.arange(0, 7.01e-3, 25e-6), np.linspace(0, 7e-3, 29)
    ends = np.array([boundary(t) for t in time])
    y = np.stack([np.where(x >= end, height(t, x), np.nan) for t, end in zip(time, ends, strict=True)])
    x_p = ends[:, None] + X * (1 - ends[:, None] / 7e-3)
    attrs = {"kind": "simulation", "name": "test", "length": 7e-3}
    return surface_motion(
        time=time, x=x, X=X, attrs=attrs, y=y + 1e-3, u_y=y, x_boundary=ends, x_p=x_p, y_p=np.zeros_like(x_p)
    )


def _edge_by_area(film: Film, index: int) -> NDArray[np.float64]:
    """Row of the edge in each column from the light below it: exact for any blur along the column."""
    light = film.brightness(index).astype(float)
    return film.shape[0] - 0.5 - light.sum(axis=0)


def _render(line, blur: float, per_pixel: int, shape=(160, 120)) -> NDArray[np.float64]:  # type: ignore[no-untyped-def]
    at = sampling(shape[0], blur, per_pixel)
    image = np.zeros(shape, dtype=np.float32)
    add_layer(image, line(at.columns), np.ones_like(at.columns), at)
    return image.T.astype(float)


@pytest.mark.parametrize("blur", [0.3, 0.5, 1.2, 3.0])
@pytest.mark.parametrize("row", [0.2, 40.0, 40.37, 119.0])
def test_level_edge_is_exact(blur: float, row: float) -> None:
    """A step blurred by a Gaussian of standard deviation s and integrated over the pixel:
    E(u) = s [G((u + 1/2)/s) - G((u - 1/2)/s)], G(t) = t Phi(t) + phi(t)."""

    def G(t: NDArray[np.float64]) -> NDArray[np.float64]:
        return t * ndtr(t) + np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi)

    u = np.arange(120) - row
    expected = blur * (G((u + 0.5) / blur) - G((u - 0.5) / blur))
    image = _render(lambda column: row + 0 * column, blur, 4)
    # linear interpolation between the tabulated phases, h = 1/128: h^2/8 max|E''|, E'' < 1/s^2 at 0.3 px
    assert np.abs(image - expected[:, None]).max() < max(1.0 / (8 * 128**2 * blur**2), 3e-6)


@pytest.mark.parametrize("blur", [0.3, 0.5, 1.2, 3.0])
@pytest.mark.parametrize("slope", [0.0, 0.5, 1.0, 3.0, 6.0])
def test_sub_columns_are_close_enough(blur: float, slope: float) -> None:
    def line(column: NDArray[np.float64]) -> NDArray[np.float64]:
        return 60.3 + slope * (column - 80.2)

    columns = np.arange(160.0)
    n = sub_columns(columns, line(columns), blur)
    difference = _render(line, blur, n) - _render(line, blur, 64)
    assert np.abs(difference[:, 70:90]).max() < 2e-5


@pytest.mark.parametrize("blur", [0.5, 1.2, 3.0])
def test_wave_is_seen_through_blur_and_pixel(blur: float) -> None:
    """The light below a wavy edge is the wave, damped along the row by exp(-(k s)^2/2) sin(k/2)/(k/2)."""
    k, amplitude = 2 * np.pi / 20, 3.0
    image = _render(lambda column: 60.3 + amplitude * np.sin(k * column), blur, 4)
    seen = 119.5 - image.sum(axis=0)
    damped = amplitude * np.exp(-((k * blur) ** 2) / 2) * np.sinc(1 / 20)
    expected = 60.3 + damped * np.sin(k * np.arange(160))
    assert np.abs(seen - expected)[30:-30].max() < 2e-4


def test_edge_is_where_the_truth_says() -> None:
    """Bias under 0.002 px, in every frame, at any tilt, for a straight surface that rises."""
    surface = _surface(lambda t, x: 2.0 * t + 0.1 * x)
    for tilt in (0.0, math.radians(2)):
        recording = film(surface, replace(CAMERA, tilt=tilt), frames_before=0)
        truth = recording.truth()["edge_row"].values
        for index in (0, 3, 10):
            inside = slice(25, 135)
            assert np.abs(_edge_by_area(recording, index) - truth[index])[inside].max() < 0.002


def test_truth_follows_the_motion() -> None:
    """An analytic motion, sampled every 10 us and filmed at other times: cubic in time, 4-point in space."""
    k, speed = 2 * np.pi / 2e-3, 10.0
    surface = _surface(lambda t, x: 150e-6 * np.sin(k * (x - speed * t)))
    camera = replace(CAMERA, frame_rate=37e3)
    recording = film(surface, camera, frames_before=0)
    truth = recording.truth()
    x = (np.arange(160) - 10.0) * PIXEL
    assert recording.times is not None
    for index, time in enumerate(recording.times):
        expected = 40.0 - 150e-6 / PIXEL * np.sin(k * (x - speed * time))
        seen = np.isfinite(truth["edge_row"].values[index])
        # error of the cubic in time: (k V dt)^4 3/128 of the amplitude of 3 px
        assert np.abs(truth["edge_row"].values[index] - expected)[seen].max() < 3 * (0.314**4 * 3 / 128) * 1.5


def test_struck_end_and_striker_are_where_the_truth_says() -> None:
    """Across a vertical face the light of a row sums up to its column."""
    surface = _surface(boundary=lambda t: 10.0 * t)
    recording = film(surface, CAMERA, striker=Striker(velocity=10.0, stop_distance=1e-3), frames_before=5)
    truth = recording.truth()
    low = 80  # a row well below the surface: striker 0.5, gap 0, sample 1, plate behind the sample 0.5
    for index in (0, 5, 9, 15):
        light = recording.brightness(index)[low].astype(float)
        end = truth["boundary_column"].values[index]
        face = max(truth["striker_column"].values[index], -0.5)
        right = 10.0 + 7e-3 / PIXEL
        expected = 0.5 * (face + 0.5) + (right - end) + 0.5 * (159.5 - right)
        assert light.sum() == pytest.approx(expected, abs=2e-3)
        if face < end - 10:
            assert light[round((face + end) / 2)] == pytest.approx(0.0, abs=1e-4)
    contact = truth["striker_column"].values - truth["boundary_column"].values
    assert (contact[:5] < -3.9).all()
    stopped = np.maximum(10.0 * truth["time"].values - 1e-3, 0.0)  # the sample goes on without the plate
    np.testing.assert_allclose(contact[5:], -stopped[5:] / PIXEL, atol=1e-9)


def test_the_face_of_the_sample_is_sharp_and_in_place() -> None:
    surface = _surface(boundary=lambda t: 0.2e-3)
    row = film(surface, CAMERA, frames_before=0).brightness(0)[80].astype(float)
    u = np.arange(160) - (10.0 + 0.2e-3 / PIXEL)
    s = CAMERA.blur

    def G(t: NDArray[np.float64]) -> NDArray[np.float64]:
        return t * ndtr(t) + np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi)

    expected = s * (G((u + 0.5) / s) - G((u - 0.5) / s))
    # sub-columns beside the jump widen its blur: s^2 by h^2/6 with h = 1/3, E changes by h^2/12 |E''|
    assert np.abs(row - expected)[:100].max() < (1 / 3) ** 2 / 12 * 0.25 / s**2 * 2


def test_wires_stand_where_the_truth_says() -> None:
    surface = _surface(boundary=lambda t: 5.0 * t)
    wires = Wires(X=(2e-3, 5e-3), width=0.2e-3, length=0.8e-3)
    recording = film(surface, CAMERA, wires=wires, frames_before=0)
    truth = recording.truth()
    for index in (0, 8):
        row = recording.brightness(index)[40 - 8].astype(float)  # half-way up the wires
        for wire in (0, 1):
            centre = truth["wire_column"].values[index, wire]
            near = slice(round(centre) - 10, round(centre) + 11)
            columns = np.arange(160)[near]
            assert (row[near] * columns).sum() / row[near].sum() == pytest.approx(centre, abs=0.002)
            assert row[near].sum() == pytest.approx(0.5 * 4.0, abs=0.01)  # level times width
        time = float(truth["time"].values[index])
        expected = 5 * time + np.array(wires.X) * (1 - 5 * time / 7e-3)
        np.testing.assert_allclose(truth["wire_column"].values[index], 10 + expected / PIXEL, atol=1e-6)
        np.testing.assert_allclose(truth["wire_row"].values[index], 40.0, atol=1e-6)


def test_exposure_blurs_motion_without_moving_it() -> None:
    """A surface that rises by v T during the exposure: variance (v T)^2/12 more, the same place."""
    surface = _surface(lambda t, x: 10.0 * t + 0 * x)
    fast = replace(CAMERA, exposure=20e-6, frame_rate=50e3)
    sharp = film(surface, CAMERA, frames_before=0, times=[1e-4])
    blurred = film(surface, fast, frames_before=0, times=[1e-4])
    assert np.abs(_edge_by_area(blurred, 0) - _edge_by_area(sharp, 0))[30:120].max() < 1e-3

    def variance(recording: Film) -> float:
        profile = np.diff(recording.brightness(0)[:, 80].astype(float))
        rows = np.arange(profile.size)
        return float(profile @ rows**2 - (profile @ rows) ** 2)

    travel = 10.0 * 20e-6 / PIXEL
    n = math.ceil(travel / (0.7 * 1.2))
    assert variance(blurred) - variance(sharp) == pytest.approx(travel**2 / 12 * (1 - 1 / n**2), rel=0.01)


def test_noise_has_the_variance_that_the_camera_has() -> None:
    camera = replace(
        CAMERA,
        levels=Levels(background=0.2, sample=0.8),
        read_noise=0.01,
        full_well=2000.0,
        bit_depth=16,
        black_level=0,
    )
    recording = film(_surface(), camera, frames_before=0)
    grey = np.stack([recording.frame(index) for index in range(11)]) / 65535.0
    for rows, level in ((slice(0, 30), 0.2), (slice(55, 96), 0.8)):
        noise = grey[:, rows, 20:140]
        expected = 0.01**2 + level / 2000.0
        n = noise.size
        assert noise.mean() == pytest.approx(level, abs=5 * math.sqrt(expected / n))
        assert noise.var() == pytest.approx(expected, rel=5 * math.sqrt(2 / n))
    # no frame repeats another's noise, no pixel its neighbour's
    first, second = grey[0, 60:, 20:140].ravel() - 0.8, grey[1, 60:, 20:140].ravel() - 0.8
    assert abs(np.corrcoef(first, second)[0, 1]) < 5 / math.sqrt(first.size)
    assert abs(np.corrcoef(first[:-1], first[1:])[0, 1]) < 5 / math.sqrt(first.size)


def test_contrast_to_noise() -> None:
    camera = replace(CAMERA, levels=Levels()).at_contrast_to_noise(20.0)
    assert camera.contrast_to_noise == pytest.approx(20.0)
    assert camera.read_noise == pytest.approx(camera.contrast / 20)


def test_same_seed_same_frames_in_any_order() -> None:
    surface, noisy = _surface(), replace(CAMERA, read_noise=0.02)
    forward = [image.copy() for _, image in film(surface, noisy, frames_before=0).frames()]
    again = film(surface, noisy, frames_before=0)
    for index in (7, 2, 2, 9):
        np.testing.assert_array_equal(again.frame(index), forward[index])
    other = film(surface, replace(noisy, seed=1), frames_before=0)
    assert (other.frame(2) != forward[2]).any()


@pytest.mark.parametrize(("bits", "black"), [(8, 0), (10, 20), (12, 64), (16, 500)])
def test_grey_values(bits: int, black: int) -> None:
    camera = replace(CAMERA, bit_depth=bits, black_level=black, levels=Levels(background=0.0, sample=1.3))
    image = film(_surface(), camera, frames_before=0).frame(0)
    assert image.dtype == (np.uint8 if bits == 8 else np.uint16)
    assert (image[:20, 40:100] == black).all()
    assert (image[60:, 40:100] == 2**bits - 1).all()  # clipped


def test_lighting_gradient() -> None:
    camera = replace(CAMERA, gradient=(0.2, -0.1), levels=Levels(background=0.5, sample=0.5))
    light = film(_surface(), camera, frames_before=0).brightness(0)
    assert light[0, 0] == pytest.approx(0.5 * (1 - 0.1 + 0.05), rel=1e-6)
    assert light[-1, -1] == pytest.approx(0.5 * (1 + 0.1 - 0.05), rel=1e-6)


def test_framing_sees_everything() -> None:
    surface = _surface(lambda t, x: 5.0 * t + 0 * x, boundary=lambda t: 5.0 * t)
    camera = Camera.framing(surface, scale=20e3)
    truth = film(surface, camera).truth()
    rows = truth["edge_row"].values
    assert np.nanmin(rows) > 30
    assert np.nanmax(rows) < camera.shape[0] - 30
    assert np.isfinite(rows).any(axis=0).sum() >= 7e-3 * 20e3 - 1


@pytest.mark.parametrize(
    ("key", "value"),
    [
        ("blur", 0.1),
        ("tilt", 0.2),
        ("exposure", 1.0),
        ("frame_rate", -5.0),
        ("bit_depth", 20),
        ("scale", 0.0),
        ("full_well", 0.0),
        ("read_noise", -1.0),
        ("shape", (2, 500)),
        ("black_level", 4000),
    ],
)
def test_impossible_cameras(key: str, value: object) -> None:
    with pytest.raises(InputError) as caught:
        replace(CAMERA, **{key: value})  # type: ignore[arg-type]
    assert caught.value.key == key


def test_wire_outside_the_sample() -> None:
    with pytest.raises(InputError, match="9 mm"):
        film(_surface(), CAMERA, wires=Wires(X=(9e-3,)))


def test_striker_rises_like_the_drive_of_that_name() -> None:
    """v = V (1 - cos(pi t/T))/2 up to T, then V, until the stop; V t before contact."""
    striker = Striker(velocity=10.0, stop_distance=6.3e-3, rise_time=0.1e-3)
    time = np.linspace(0, 1e-3, 200001)
    speed = np.where(time < 0.1e-3, 5 * (1 - np.cos(np.pi * time / 0.1e-3)), 10.0)
    travel = np.concatenate([[0.0], np.cumsum((speed[1:] + speed[:-1]) / 2 * np.diff(time))])
    for t in (0.03e-3, 0.1e-3, 0.4e-3, 0.9e-3):
        expected = min(np.interp(t, time, travel), 6.3e-3)
        assert striker.position(t) == pytest.approx(expected, rel=1e-6)
    assert striker.position(-1e-4) == pytest.approx(-1e-3)
