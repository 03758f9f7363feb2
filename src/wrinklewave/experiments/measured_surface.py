"""From measured frames, in pixels, to a surface motion."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from wrinklewave.experiments.frame_blocks import FrameBlock
from wrinklewave.experiments.impact_moments import EndTrack
from wrinklewave.imaging.appearance import Appearance
from wrinklewave.imaging.arrays import Flags, Floats
from wrinklewave.imaging.boundary import StruckEnd
from wrinklewave.imaging.calibration import PixelMap
from wrinklewave.imaging.camera.curves import interpolate
from wrinklewave.imaging.contact import touching_frames
from wrinklewave.imaging.edges.locking import PixelLocking
from wrinklewave.imaging.tracks import WireTracks, smooth_in_time, track_wires
from wrinklewave.imaging.wires import WireLook, WireSightings, bridged
from wrinklewave.surface import SurfaceFile

WIDEST_BRIDGE = 2.5
"""Gaps in the surface are bridged up to so many resolutions, and NaN beyond."""
FEWEST_COLUMNS = 4


@dataclass(frozen=True)
class FrameSeries:
    """What is known of all frames together but for the surface itself; arrays of shape [n_frames].

    Attributes:
        frame: index in the recording.
        end: struck end and striker, fields of ``StruckEnd`` by name.
        sightings: of the wires.
        locking: of all frames.
        contrast, noise: grey values.
        seen: share of the sample's columns with a valid surface.
    """

    frame: NDArray[np.int64]
    end: dict[str, Floats]
    sightings: list[WireSightings]
    locking: PixelLocking
    contrast: Floats
    noise: Floats
    seen: Floats


def frame_series(blocks: Iterable[FrameBlock]) -> FrameSeries:
    """Gather what blocks say beside the surface itself."""
    kept = []
    sightings: list[WireSightings] = []
    locking = PixelLocking.none()
    for block in blocks:
        seen = block.valid.sum(axis=1) / np.maximum(np.isfinite(block.rows).sum(axis=1), 1)
        kept.append((block.frame, block.end, block.contrast, block.noise, seen))
        sightings += block.sightings
        locking = locking + block.pixel_locking
    frame, end, contrast, noise, seen = (np.concatenate(parts) for parts in zip(*kept, strict=True))
    fields = dict(zip(StruckEnd._fields, end.T, strict=True))
    return FrameSeries(frame, fields, sightings, locking, contrast, noise, seen)


def end_track(series: FrameSeries, time: Floats, n_undeformed: int, appearance: Appearance) -> EndTrack:
    """Struck end and striker at the surface, followed along their faces from where they are measured."""
    end = series.end
    touching = touching_frames(end["gain"])
    touches = touching == 1.0
    column, sigma, slope, slope_sigma = (
        np.where(touches, end[there], end[apart])
        for there, apart in (
            ("touch", "column"),
            ("touch_sigma", "sigma"),
            ("touch_slope", "slope"),
            ("touch_slope_sigma", "slope_sigma"),
        )
    )
    slope, slope_sigma = (each[:, 0] for each in smooth_in_time(slope[:, None], slope_sigma[:, None]))
    up = end["corner_row"] - end["row"]
    up_striker = end["corner_row"] - end["striker_row"]
    column, sigma = column + slope * up, np.hypot(sigma, slope_sigma * up)
    at_rest = column[series.frame < n_undeformed]
    known = at_rest[np.isfinite(at_rest)]
    return EndTrack(
        time=time,
        column=column,
        sigma=sigma,
        row=end["corner_row"],
        row_sigma=end["corner_sigma"],
        striker=np.where(touches, column, end["striker"] + slope * up_striker),
        striker_sigma=np.where(touches, sigma, np.hypot(end["striker_sigma"], slope_sigma * up_striker)),
        gap=np.where(touches, 0.0, end["gap"]),
        gap_sigma=np.where(touches, 0.0, end["gap_sigma"]),
        touching=touching,
        rest=float(known.mean()) if known.size else appearance.struck_end,
    )


@dataclass(frozen=True)
class Grid:
    """Laboratory grid whose points are the image's columns where the sample lies level.

    Attributes:
        x: positions [m], shape [n_x].
        rest, rest_sigma: height of the undeformed surface there and its standard uncertainty [m].
        widest_gap: that is bridged [m].
    """

    x: Floats
    rest: Floats
    rest_sigma: Floats
    widest_gap: float


def laboratory_grid(appearance: Appearance, pixels: PixelMap, resolution: float) -> Grid:
    """Grid from the struck end at rest to the held end, or as far as the image reaches."""
    surface, sigma = appearance.surface, appearance.surface_sigma
    last = min(appearance.held_end, surface.size - 1.0)
    columns = np.arange(np.ceil(pixels.origin[0] - 1e-6), np.floor(last) + 1.0)
    x = pixels.pixel_size * (columns - pixels.origin[0])
    known = np.flatnonzero(np.isfinite(surface))
    at, height = pixels.to_metres(known, surface[known])
    rest = interpolate(x, at, height)
    rest_sigma = np.interp(x, at, pixels.pixel_size * sigma[known])
    return Grid(x, rest, rest_sigma, WIDEST_BRIDGE * resolution * pixels.pixel_size)


def write_surface(
    path: Path,
    *,
    blocks: Iterable[FrameBlock],
    time: Floats,
    track: EndTrack,
    wires: WireLook | None,
    series: FrameSeries,
    pixels: PixelMap,
    grid: Grid,
    attrs: dict[str, Any],
) -> WireTracks | None:
    """Write the surface motion, block by block; return the wires' tracks.

    Args:
        path: of the file.
        blocks: of frames, in order.
        time: of every frame [s], contact at 0.
        track: the struck end.
        wires: how the wires look; None if there are none.
        series: of the frames.
        pixels: the calibration.
        grid: the laboratory grid.
        attrs: of the surface motion.
    """
    tracks = track_wires(series.sightings, wires) if wires else None
    places = tracks.column if tracks else np.zeros((time.size, 0))
    X = np.zeros(0) if wires is None else pixels.to_metres(wires.columns, _rows_at_rest(wires, pixels))[0]
    x_boundary = pixels.to_metres(track.column, track.row)[0]
    left = _bridged_in_time(track.column)
    with SurfaceFile(path, time=time, x=grid.x, X=X, attrs=attrs) as file:
        file.write("x_boundary", x_boundary)
        for first, block in _numbered(blocks):
            here = slice(first, first + block.frame.size)
            for name, values in _heights(block, left[here], pixels, grid).items():
                file.write(name, values, first)
            for name, values in _wire_places(block, places[here], pixels).items():
                file.write(name, values, first)
    return tracks


def track_columns(
    time: Floats, track: EndTrack, wires: WireTracks | None, pixels: PixelMap
) -> dict[str, Floats]:
    """Struck end, striker and wires in every frame with their standard uncertainties, as columns of a table."""
    pixel = pixels.pixel_size
    by_row = track.row_sigma * np.sin(pixels.tilt)  # of faces, which are followed to the row of the corner
    columns = {
        "time_s": time,
        "x_boundary_m": pixels.to_metres(track.column, track.row)[0],
        "x_boundary_sigma_m": pixel * np.hypot(track.sigma, by_row),
        "x_striker_m": pixels.to_metres(track.striker, track.row)[0],
        "x_striker_sigma_m": pixel * np.hypot(track.striker_sigma, by_row),
        "striker_touches": track.touching,
    }
    if wires is not None:
        x = pixels.to_metres(wires.column, pixels.origin[1])[0]
        for wire in range(x.shape[1]):
            columns[f"x_wire_{wire + 1}_m"] = x[:, wire]
            columns[f"x_wire_{wire + 1}_sigma_m"] = pixel * wires.sigma[:, wire]
    return columns


def _numbered(blocks: Iterable[FrameBlock]) -> Iterator[tuple[int, FrameBlock]]:
    """Blocks with the number of frames before each."""
    first = 0
    for block in blocks:
        yield first, block
        first += block.frame.size


def _heights(block: FrameBlock, left: Floats, pixels: PixelMap, grid: Grid) -> dict[str, Floats]:
    """Heights, displacements and their uncertainties on the grid, shape [n_frames, n_x]."""
    y, sigma = np.full((2, block.frame.size, grid.x.size), np.nan)
    for frame in range(block.frame.size):
        known = np.isfinite(block.rows[frame]) & (np.arange(block.rows.shape[1]) >= left[frame])
        columns = np.flatnonzero(known)
        if columns.size < FEWEST_COLUMNS:
            continue
        x, height = pixels.to_metres(columns, block.rows[frame, columns])
        uncertainty = pixels.pixel_size * block.sigma[frame, columns]
        inside = (grid.x >= x[0]) & (grid.x <= x[-1])
        inside &= ~_in_wide_gap(grid.x, x[block.valid[frame, columns]], grid.widest_gap)
        y[frame, inside] = interpolate(grid.x[inside], x, height)
        sigma[frame, inside] = np.interp(grid.x[inside], x, uncertainty)
    return {"y": y, "u_y": y - grid.rest, "u_y_sigma": np.hypot(sigma, grid.rest_sigma)}


def _in_wide_gap(at: Floats, known: Floats, widest: float) -> Flags:
    """Whether places lie in a gap between ``known`` ones that is wider than may be bridged, or beyond them."""
    if known.size == 0:
        return np.ones(at.size, bool)
    after = np.searchsorted(known, at)
    previous, following = known[np.maximum(after - 1, 0)], known[np.minimum(after, known.size - 1)]
    return np.asarray((following - previous > widest) | (at < known[0]) | (at > known[-1]))


def _wire_places(block: FrameBlock, columns: Floats, pixels: PixelMap) -> dict[str, Floats]:
    """Where the wires leave the surface [m], shape [n_frames, n_wires]."""
    at = np.arange(block.rows.shape[1])
    rows = [np.interp(places, at, bridged(row)) for places, row in zip(columns, block.rows, strict=True)]
    x, y = pixels.to_metres(columns, np.array(rows).reshape(columns.shape))
    return {"x_p": x, "y_p": y}


def _rows_at_rest(wires: WireLook, pixels: PixelMap) -> Floats:
    return pixels.origin[1] - np.tan(pixels.tilt) * (wires.columns - pixels.origin[0])


def _bridged_in_time(column: Floats) -> Floats:
    """Column of the struck end in every frame, for discarding what is left of it."""
    frames, known = np.arange(column.size), np.isfinite(column)
    return np.interp(frames, frames[known], column[known]) if known.any() else np.full(column.size, -np.inf)
