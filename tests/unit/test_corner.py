"""The corner of the struck end: the surface followed to the face, against closed forms and filmed corners."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest

from wrinklewave.imaging.appearance import learn_appearance
from wrinklewave.imaging.camera import Camera, Striker, film
from wrinklewave.imaging.corner import follow_to_face
from wrinklewave.imaging.edges.profile import blurred_step
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.surface import surface_motion

FACE, N_COLUMNS = 20.3, 80
COLUMNS = np.arange(N_COLUMNS, dtype=float)
LENGTH, SCALE, AT_REST, MOVED = 16e-3, 20e3, 8, 40


def followed(
    image: np.ndarray, rows: np.ndarray, own: np.ndarray, known: np.ndarray, *, blur: float = 1.2
) -> tuple[float, float]:
    """Row at the face and its uncertainty where columns are known to 0.05 px."""
    sigma = np.full(N_COLUMNS, 0.05)
    return follow_to_face(np.float32(image), rows, own, sigma, known, FACE, FACE, blur, 1.0, 0.01)


def test_what_is_known_of_a_surface_is_carried_to_the_face_by_a_smoothing_spline() -> None:
    """Posterior of y(s) = a + b s + W(s), cov W(s, t) = q s^2 (3 t - s)/6, s <= t, s from the 12th column leftwards."""
    random = np.random.default_rng(3)
    rows = 100.0 + 0.2 * (COLUMNS - FACE) + 2.0 * np.sin(2 * np.pi * COLUMNS / 30.0)
    own = rows + random.normal(0.0, 0.05, N_COLUMNS)
    known = (COLUMNS >= 26) & (COLUMNS != 31)
    columns = np.flatnonzero(known)[:12]
    bends = np.diff(rows[26:50], 2)
    q = 0.02**2 + 2.0 * np.mean(bends**2)
    s = columns[-1] - np.append(columns, FACE)
    shorter, longer = np.minimum.outer(s, s), np.maximum.outer(s, s)
    prior = q * shorter**2 * (3.0 * longer - shorter) / 6.0 + np.outer(s, s) + 1e6
    noise = np.full(12, 0.05**2 + 0.02**2)
    noise[-1] = 0.05**2
    weights = np.linalg.solve(prior[:-1, :-1] + np.diag(noise), prior[:-1, -1])
    level = own[columns].mean()
    row, sigma = followed(np.zeros((200, N_COLUMNS)), rows, own, known)
    assert row == pytest.approx(level + weights @ (own[columns] - level), abs=1e-5)
    assert sigma == pytest.approx(np.sqrt(prior[-1, -1] - weights @ prior[:-1, -1]), rel=1e-4)


@pytest.mark.parametrize("striker", [0.0, 0.4, 1.0])
@pytest.mark.parametrize("blur", [0.7, 1.2, 3.0])
def test_columns_beside_the_face_show_a_surface_that_leads_to_its_corner(blur: float, striker: float) -> None:
    """Exactly: a level surface is a product of two steps, whatever stands beside it as high as the image."""
    row = 100.37
    along, down = blurred_step(COLUMNS - FACE, blur), blurred_step(np.arange(200.0) - row, blur)
    image = np.outer(down, along) + striker * (1.0 - along)
    rows = np.full(N_COLUMNS, row)
    found, sigma = followed(image, rows, rows, COLUMNS > FACE + 12.0, blur=blur)
    without, unknown = followed(np.zeros_like(image), rows, rows, COLUMNS > FACE + 12.0, blur=blur)
    assert found == pytest.approx(row, abs=1e-3)
    assert without == pytest.approx(row, abs=1e-9)
    assert sigma < 0.5 * unknown


def test_a_slope_leads_to_where_the_columns_beside_the_face_see_it() -> None:
    """A column at the face sees the mean of the half of its blur that lies on the sample."""
    blur, slope, fine = 2.0, 0.3, 8
    x, r = (np.arange(N_COLUMNS * fine) + 0.5) / fine - 0.5, np.arange(160.0)
    kernel = np.exp(-0.5 * ((COLUMNS[:, None] - x) ** 2) / (blur**2 + 1 / 12))
    kernel *= (x > FACE) / kernel.sum(axis=1, keepdims=True)
    image = blurred_step(r[:, None] - (60.0 + slope * (x - FACE)), blur) @ kernel.T
    rows = 60.0 + slope * (COLUMNS - FACE)
    found, sigma = followed(image, rows, rows, COLUMNS > FACE + 8.0, blur=blur)
    assert sigma < 0.5
    assert found == pytest.approx(60.0, abs=0.1)


def test_a_surface_that_is_not_seen_near_the_face_tells_nothing() -> None:
    rows = np.full(N_COLUMNS, 100.0)
    for known in (COLUMNS > FACE + 30.0, COLUMNS < FACE, (COLUMNS > FACE) & (COLUMNS < FACE + 5.0)):
        assert not np.isfinite(followed(np.zeros((200, N_COLUMNS)), rows, rows, known)).any()


class Corners(NamedTuple):
    """Errors of the corner's row, and its stated uncertainty [px], shape [n_frames]."""

    error: np.ndarray
    sigma: np.ndarray


def filmed_corners(blur: float, seed: int) -> Corners:
    """Corners of unlike surfaces: 24 to 60 px of wavelength, up to 5 px of amplitude, above and below a striker."""
    random = np.random.default_rng(seed)
    n, x = AT_REST + MOVED, np.arange(0.0, LENGTH + 1e-9, 25e-6)
    ends, heights = np.zeros(n), np.zeros((n, x.size))
    for frame in range(AT_REST, n):
        ends[frame] = random.uniform(0.0, 4e-3)
        d, wave = x - ends[frame], random.uniform(1.2e-3, 3e-3)
        amplitude = random.uniform(0.0, min(0.25e-3, 0.08 * wave))
        heights[frame] = random.uniform(-0.3e-3, 3e-3) - random.uniform(0.0, 0.1) * d
        heights[frame] += amplitude * np.cos(2 * np.pi * d / wave + random.uniform(0.0, 2 * np.pi))
        heights[frame, d < 0.0] = np.nan
    X = np.linspace(0.0, LENGTH, 33)
    surface = surface_motion(
        time=np.arange(1 - AT_REST, MOVED + 1) * 1e-3,
        x=x,
        X=X,
        attrs={"kind": "simulation", "name": "corners", "length": LENGTH},
        y=heights,
        u_y=heights,
        x_boundary=ends,
        x_p=np.maximum(X, ends[:, None]),
        y_p=np.zeros((n, X.size)),
    )
    camera = Camera(
        shape=(240, 400), scale=SCALE, origin=(40.0, 120.0), tilt=0.03, blur=blur, exposure=0.0, seed=seed
    ).at_contrast_to_noise(20.0)
    recording = film(
        surface, camera, striker=Striker(velocity=1e3, stop_distance=3e-3), times=surface["time"].values
    )
    frames = [recording.frame(index) for index in range(n)]
    measurer = FrameMeasurer(learn_appearance(frames[:AT_REST], frames[AT_REST::4]))
    ends_found = [measurer.measure(frame).end for frame in frames[AT_REST:]]
    true = recording.truth()["boundary_row"].values[AT_REST:]
    return Corners(
        np.array([end.corner_row for end in ends_found]) - true,
        np.array([end.corner_sigma for end in ends_found]),
    )


@pytest.mark.parametrize(("blur", "allowed"), [(0.7, 0.2), (1.2, 0.25), (3.0, 0.6)])
def test_the_stated_uncertainty_of_a_corner_is_that_of_its_row(blur: float, allowed: float) -> None:
    found = filmed_corners(blur, seed=6)
    assert np.sqrt(np.mean(found.error**2)) < allowed
    assert 0.8 < np.sqrt(np.mean((found.error / found.sigma) ** 2)) < 1.25
