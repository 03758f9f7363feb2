"""The sample's free surface in one frame, at two resolutions, each with its standard uncertainty."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.edges.coarse import coarse_edge
from wrinklewave.imaging.edges.columns import Columns, find_columns
from wrinklewave.imaging.edges.lateral import lateral_kernels, local_kernels, seen_exactly, seen_linearly
from wrinklewave.imaging.edges.levels import Levels, find_levels
from wrinklewave.imaging.edges.regularised import ORDER, band_limited_surface, penalty, uncertainty

RESOLUTION = 10.0  # px
_FINEST = 5.5  # lateral blurs to a wavelength: finer ones would be little but amplified noise
_COARSE_SPAN = 4  # columns on either side for the slope of the coarse edge
_FEWEST = 4 * ORDER  # columns with an edge
_ROUGHLY, _FINELY = 0.05, 5e-3  # px: where the columns' iterations stop, first and last time
_ASTRAY = 6.0  # standard uncertainties between a column and the surface through its neighbours ...
_ASTRAY_ROWS = 0.3  # ... and pixels beyond


@dataclass(frozen=True)
class Optics:
    """What a recording's images of an edge have in common.

    Attributes:
        blur: standard deviation of the optical blur [px], the pixel's own size not included.
        sample_brighter: whether the sample is brighter than the background.
    """

    blur: float
    sample_brighter: bool


@dataclass(frozen=True)
class Edge:
    """The free surface in one frame; arrays of shape [n_columns], rows and uncertainties in pixels.

    A row r is the centre of the frame's row r of pixels; NaN where nothing is known.

    Attributes:
        rows: the surface regularised along the sample, at the stated resolution.
        sigma: standard uncertainty of ``rows``.
        valid: whether ``rows`` is at least as certain as a single column's estimate; elsewhere it bridges a gap.
        column_rows: the surface column by column: each one's own estimate, freed of the lateral blur's bias.
        column_sigma: standard uncertainty of ``column_rows``.
        column_valid: whether a well-shaped edge was found in the column.
        contrast: median difference of grey values across the edge.
        noise: standard deviation of a pixel's grey value (root mean square of both sides).
    """

    rows: Floats
    sigma: Floats
    valid: Flags
    column_rows: Floats
    column_sigma: Floats
    column_valid: Flags
    contrast: float
    noise: float


@dataclass(frozen=True)
class RoughEdge:
    """The surface to a fraction of a pixel; arrays of shape [n_columns].

    Attributes:
        rows: where the columns see it [px], bridged where something hides it; NaN beside the sample.
        slope: of the surface.
        beyond: ``rows`` less what the linear lateral blur makes of the surface [px].
        levels: grey values beside it.
    """

    rows: Floats
    slope: Floats
    beyond: Floats
    levels: Levels


class EdgeFinder:
    """Finds the free surface of a sample that fills the frame below it, each frame on its own.

    Args:
        optics: blur and polarity of the recording.
        resolution: shortest wavelength to keep along the surface [px].

    Attributes:
        resolution: the one used: not finer than 5.5 standard deviations of the lateral blur.
    """

    def __init__(self, optics: Optics, *, resolution: float = RESOLUTION) -> None:
        self.optics = optics
        self.resolution = max(resolution, _FINEST * float(np.hypot(optics.blur, 12**-0.5)))
        self._kernels = lateral_kernels(optics.blur)
        self._reach = self._kernels.shape[1] // 2
        self._stiffness = penalty(self.resolution, optics.blur)

    def find(self, image: Pixels, *, first: int = 0, stop: int | None = None) -> Edge:
        """The surface in the columns from ``first`` up to ``stop`` of an image [n_rows, n_columns]."""
        coarse = self.coarse(image)
        return self.fine(image, self.rough(image, coarse, first=first, stop=stop))

    def coarse(self, image: Pixels) -> Floats:
        """Row of the edge in every column to about a pixel, shape [n_columns]; anything where there is none."""
        return coarse_edge(image, 1.0 if self.optics.sample_brighter else -1.0)

    def rough(self, image: Pixels, coarse: Floats, *, first: int = 0, stop: int | None = None) -> RoughEdge:
        """The surface to a fraction of a pixel, by which it is known what stands before it."""
        n_columns = image.shape[1]
        stop = n_columns if stop is None else min(stop, n_columns)
        slope = _slope(coarse, _COARSE_SPAN)
        blur = _seen_blur(slope, self.optics.blur)
        levels = find_levels(image, coarse, blur, max(first, 0), stop)
        columns = find_columns(image, coarse, blur, levels, levels.usable, _ROUGHLY)
        if columns.found.sum() < _FEWEST:
            return RoughEdge(np.full(n_columns, np.nan), slope, np.zeros(n_columns), levels)
        fit = self._fit(columns, slope, np.zeros(n_columns))
        slope[fit.part] = _slope(fit.surface, 1)[self._reach : -self._reach]
        linear = seen_linearly(fit.surface, local_kernels(slope[fit.part], self._kernels))
        rows, beyond = np.full(n_columns, np.nan), np.zeros(n_columns)
        rows[fit.part] = seen_exactly(fit.surface, linear, slope[fit.part], self.optics.blur)
        beyond[fit.part] = rows[fit.part] - linear
        return RoughEdge(rows, slope, beyond, levels)

    def fine(self, image: Pixels, rough: RoughEdge, blocked: Flags | None = None) -> Edge:
        """The surface at both resolutions; ``blocked`` columns [n_columns] are hidden by something known."""
        levels = rough.levels if blocked is None else rough.levels.without(blocked)
        usable = levels.usable & np.isfinite(rough.rows)
        blur = _seen_blur(rough.slope, self.optics.blur)
        columns = find_columns(image, rough.rows, blur, levels, usable, _FINELY)
        columns = columns.only(np.abs(columns.rows - rough.rows) <= _ASTRAY * columns.sigma + _ASTRAY_ROWS)
        if columns.found.sum() < _FEWEST:
            return _nothing(levels)
        return self._edge(columns, rough.beyond, self._fit(columns, rough.slope, rough.beyond), levels)

    def _fit(self, columns: Columns, slope: Floats, beyond: Floats) -> _Fit:
        """The surface through ``columns`` of a surface of about this ``slope``.

        ``beyond`` is where columns see the surface, less what the linear lateral blur says.
        """
        found = np.flatnonzero(columns.found)
        part = slice(int(found[0]), int(found[-1]) + 1)
        level_sigma = _level_sigma(columns.sigma[found], slope[found], self.optics.blur)
        local = local_kernels(slope[part], self._kernels)
        surface, factor = band_limited_surface(
            (columns.rows - beyond)[part],
            columns.sigma[part],
            level_sigma,
            slope[part],
            local,
            self._stiffness,
        )
        return _Fit(part, surface, factor, level_sigma, seen_linearly(surface, local))

    def _edge(self, columns: Columns, beyond: Floats, fit: _Fit, levels: Levels) -> Edge:
        rows, sigma, shift = (np.full(columns.rows.size, value) for value in (np.nan, np.inf, np.nan))
        inner = slice(self._reach, -self._reach)
        rows[fit.part] = fit.surface[inner]
        sigma[fit.part] = uncertainty(fit.factor, fit.level_sigma)[inner]
        shift[fit.part] = fit.surface[inner] - fit.linear
        known = np.where(columns.found, columns.sigma, 0.0)
        return Edge(
            rows=rows,
            sigma=sigma,
            valid=sigma < np.maximum(known, fit.level_sigma),
            column_rows=columns.rows - beyond + shift,
            column_sigma=columns.sigma,
            column_valid=columns.found,
            contrast=levels.contrast,
            noise=levels.mean_noise,
        )


class _Fit(NamedTuple):
    """A band-limited surface in the columns ``part``: with its margins, its factor, and as columns see it."""

    part: slice
    surface: Floats
    factor: Floats
    level_sigma: float
    linear: Floats


def _nothing(levels: Levels) -> Edge:
    n_columns = levels.usable.size
    nowhere, unknown, never = (
        np.full(n_columns, np.nan),
        np.full(n_columns, np.inf),
        np.zeros(n_columns, bool),
    )
    return Edge(nowhere, unknown, never, nowhere, unknown, never, levels.contrast, levels.mean_noise)


@allocating
def _seen_blur(slope: Floats, blur: float) -> Floats:
    """Standard deviation of the blur that a column sees at the slope m, without the pixel's height.

    Its square is s^2 (1 + m^2) + m^2/12, where the last term is the pixel's width.
    """
    return np.sqrt(blur**2 * (1.0 + slope**2) + slope**2 / 12.0)


@allocating
def _level_sigma(sigma: Floats, slope: Floats, blur: float) -> float:
    """Typical standard uncertainty of a column in which the edge were level."""
    return np.median(sigma * np.sqrt(blur / _seen_blur(slope, blur)))


@allocating
def _slope(rows: Floats, span: int) -> Floats:
    """Central differences over ``span`` columns on either side, shorter at the ends."""
    n = rows.size
    slope = np.empty(n)
    for c in range(n):
        left, right = max(c - span, 0), min(c + span, n - 1)
        slope[c] = (rows[right] - rows[left]) / (right - left)
    return slope
