"""Sightings of wires in single frames, joined in time to tracks of material points."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from wrinklewave.imaging.arrays import Floats
from wrinklewave.imaging.wires import WireLook, WireSightings

BRIDGED_FRAMES = 5
"""Gaps of so many frames or fewer are bridged, longer ones reported."""

_SPAN = 5  # frames on either side over which inclinations are averaged
_GATE = 0.45  # of the distance to the neighbouring wire
_ALONE = 100.0  # px: the gate of a single wire over 0.45


@dataclass(frozen=True)
class Gap:
    """Frames in which a wire was not seen: the first, one past the last, and whether they were bridged."""

    wire: int
    first: int
    stop: int
    bridged: bool


@dataclass(frozen=True)
class WireTracks:
    """Wires followed through a recording; arrays of shape [n_frames, n_wires].

    Attributes:
        column: where each leaves the surface [px]; NaN where it was not seen and not bridged.
        sigma: its standard uncertainty [px].
        gaps: where wires were not seen.
    """

    column: Floats
    sigma: Floats
    gaps: tuple[Gap, ...]


def track_wires(sightings: Sequence[WireSightings], look: WireLook) -> WireTracks:
    """Join sightings of consecutive frames: each wire to the nearest one to where it should be by now.

    Args:
        sightings: of every frame.
        look: with the wires' places in the undeformed frames.
    """
    chosen = _joined(sightings, look.columns)
    shape = (len(sightings), look.columns.size)
    column, sigma, lean, lean_sigma, distance = (np.full(shape, np.nan) for _ in range(5))
    for frame, places in enumerate(chosen):
        for wire, place in enumerate(places):
            if place >= 0:
                seen = sightings[frame]
                column[frame, wire], sigma[frame, wire] = seen.column[place], seen.sigma[place]
                lean[frame, wire], lean_sigma[frame, wire] = seen.lean[place], seen.lean_sigma[place]
                distance[frame, wire] = seen.distance[place]
    lean, lean_sigma = smooth_in_time(lean, lean_sigma)
    return _bridged(column + lean * distance, np.hypot(sigma, lean_sigma * distance))


def smooth_in_time(values: Floats, sigma: Floats) -> tuple[Floats, Floats]:
    """Weighted straight-line fits over neighbouring frames, for what changes slowly.

    Args:
        values: shape [n_frames, n], NaN where unknown.
        sigma: their standard uncertainties, same shape.

    Returns:
        Smooth values and their standard uncertainties; NaN where a value is unknown.
    """
    known = np.isfinite(values) & np.isfinite(sigma) & (sigma > 0)
    weight = np.where(known, 1.0 / np.where(known, sigma, 1.0) ** 2, 0.0)
    filled = np.where(known, values, 0.0)
    smooth, smooth_sigma = np.full(values.shape, np.nan), np.full(values.shape, np.nan)
    for frame in range(values.shape[0]):
        near = slice(max(frame - _SPAN, 0), frame + _SPAN + 1)
        away = np.arange(near.start, min(near.stop, values.shape[0]))[:, None] - frame
        w, v = weight[near], filled[near]
        s0, s1, s2 = w.sum(axis=0), (w * away).sum(axis=0), (w * away**2).sum(axis=0)
        here = known[frame]
        mean, lever = (w * v).sum(axis=0), (w * away * v).sum(axis=0)
        determinant = s0 * s2 - s1**2
        line = here & (determinant > 1e-9 * s0 * s2)
        safe = np.where(line, determinant, 1.0)
        level = np.where(s0 > 0, mean / np.where(s0 > 0, s0, 1.0), np.nan)
        level_variance = 1.0 / np.where(s0 > 0, s0, np.nan)
        smooth[frame] = np.where(here, np.where(line, (s2 * mean - s1 * lever) / safe, level), np.nan)
        smooth_sigma[frame] = np.where(here, np.sqrt(np.where(line, s2 / safe, level_variance)), np.nan)
    return smooth, smooth_sigma


def _joined(sightings: Sequence[WireSightings], start: Floats) -> list[list[int]]:
    """Index of the sighting of every wire in every frame, -1 where there is none."""
    from scipy.optimize import linear_sum_assignment

    spacing = np.diff(start, prepend=-np.inf, append=np.inf)
    gate = _GATE * np.minimum(np.minimum(spacing[:-1], spacing[1:]), _ALONE)
    place, step = start.copy(), np.zeros(start.size)
    missing = np.zeros(start.size)
    chosen = []
    for seen in sightings:
        expected = place + step * (1 + missing)
        distance = np.abs(expected[:, None] - seen.column[None, :])
        cost = np.minimum(distance, gate[:, None]) ** 2
        found = [-1] * start.size
        for wire, candidate in zip(*linear_sum_assignment(cost), strict=True):
            if distance[wire, candidate] < gate[wire]:
                found[wire] = int(candidate)
        for wire, candidate in enumerate(found):
            if candidate < 0:
                missing[wire] += 1
            else:
                step[wire] = (seen.column[candidate] - place[wire]) / (1 + missing[wire])
                place[wire], missing[wire] = seen.column[candidate], 0
        chosen.append(found)
    return chosen


def _bridged(column: Floats, sigma: Floats) -> WireTracks:
    """Short gaps filled by monotone cubics in time."""
    from scipy.interpolate import PchipInterpolator

    column, sigma = column.copy(), sigma.copy()
    gaps = []
    for wire in range(column.shape[1]):
        known = np.flatnonzero(np.isfinite(column[:, wire]))
        for first, stop in _gaps(known, column.shape[0]):
            inside = known.size > 1 and first > known[0] and stop <= known[-1]
            bridge = bool(inside and stop - first <= BRIDGED_FRAMES)  # one that JSON knows
            if bridge:
                frames = np.arange(first, stop)
                column[first:stop, wire] = PchipInterpolator(known, column[known, wire])(frames)
                sigma[first:stop, wire] = np.abs(column[stop, wire] - column[first - 1, wire]) / (
                    stop - first + 1
                )
            gaps.append(Gap(wire, first, stop, bridge))
    return WireTracks(column, sigma, tuple(gaps))


def _gaps(known: NDArray[np.intp], n_frames: int) -> list[tuple[int, int]]:
    """Stretches of frames that are not among the ``known`` ones."""
    bounds = [-1, *known.tolist(), n_frames]
    return [(int(a) + 1, int(b)) for a, b in pairwise(bounds) if b - a > 1]
