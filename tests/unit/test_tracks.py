"""Sightings of wires become tracks: in order, bridged over short gaps, reported over long ones."""

from __future__ import annotations

import json

import numpy as np
import pytest

from wrinklewave.imaging.tracks import BRIDGED_FRAMES, Gap, smooth_in_time, track_wires
from wrinklewave.imaging.wires import WireLook, WireSightings

LOOK = WireLook(columns=np.array([100.0, 130.0, 300.0]), width=3.0, height=1.4, length=16.0)
N_FRAMES = 40


def places(frame: int) -> np.ndarray:
    """The first two wires move 3.5 px a frame, one a little later than the other; the third rests."""
    return LOOK.columns + 3.5 * np.maximum(frame - np.array([5, 12, np.inf]), 0.0)


def sighting(columns: np.ndarray, lean: float = 0.0, distance: float = 8.0) -> WireSightings:
    n = columns.size
    return WireSightings(columns, np.full(n, 0.02), np.full(n, lean), np.full(n, 0.005), np.full(n, distance))


def test_wires_keep_their_names_when_they_come_close_and_false_ones_are_ignored() -> None:
    seen = [sighting(np.sort(np.append(places(frame), 210.0 + 0.1 * frame))) for frame in range(N_FRAMES)]
    tracks = track_wires(seen, LOOK)
    np.testing.assert_allclose(tracks.column, [places(frame) for frame in range(N_FRAMES)], atol=1e-9)
    assert tracks.gaps == ()


def test_leaning_wires_are_followed_to_the_surface() -> None:
    tracks = track_wires([sighting(places(0), lean=0.1) for _ in range(N_FRAMES)], LOOK)
    np.testing.assert_allclose(tracks.column, places(0) + 0.8 + np.zeros((N_FRAMES, 1)))
    assert tracks.sigma[20, 0] == pytest.approx(np.hypot(0.02, 8.0 * 0.005 / np.sqrt(11)))


def test_short_gaps_are_bridged_and_long_ones_reported() -> None:
    short, long = (20, 20 + BRIDGED_FRAMES), (15, 15 + BRIDGED_FRAMES + 1)

    def seen(frame: int) -> WireSightings:
        kept = [not short[0] <= frame < short[1], not long[0] <= frame < long[1], frame < N_FRAMES - 2]
        return sighting(places(frame)[kept])

    tracks = track_wires([seen(frame) for frame in range(N_FRAMES)], LOOK)
    assert tracks.gaps == (Gap(0, *short, True), Gap(1, *long, False), Gap(2, N_FRAMES - 2, N_FRAMES, False))
    assert json.dumps([vars(gap) for gap in tracks.gaps])  # summary.json lists them
    np.testing.assert_allclose(
        tracks.column[slice(*short), 0], [places(f)[0] for f in range(*short)], atol=1e-6
    )
    np.testing.assert_allclose(
        tracks.sigma[slice(*short), 0], 3.5, rtol=1e-9
    )  # the way from one frame to the next
    assert np.isnan(tracks.column[slice(*long), 1]).all()
    np.testing.assert_allclose(tracks.column[long[1] :, 1], [places(f)[1] for f in range(long[1], N_FRAMES)])


def test_smoothing_keeps_straight_lines_and_says_how_certain_they_are() -> None:
    time = np.arange(30.0)[:, None]
    values, sigma = 2.0 + 0.3 * time, np.full((30, 1), 0.1)
    values[7] = np.nan
    smooth, smooth_sigma = smooth_in_time(values, sigma)
    known = np.isfinite(values)
    np.testing.assert_allclose(smooth[known], values[known])
    assert np.isnan(smooth[7])
    assert smooth_sigma[20, 0] == pytest.approx(0.1 / np.sqrt(11))
