"""The sample's free surface in one frame, at two resolutions, each with its standard uncertainty."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.edges.banded import Band
from wrinklewave.imaging.edges.coarse import coarse_edge
from wrinklewave.imaging.edges.columns import Columns, find_columns
from wrinklewave.imaging.edges.lateral import lateral_kernels, local_kernels, seen_exactly, seen_linearly
from wrinklewave.imaging.edges.levels import Levels, find_levels, without
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


class RoughEdge(NamedTuple):
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
        self._by = _Regularisation(
            optics.blur, lateral_kernels(optics.blur), penalty(self.resolution, optics.blur)
        )

    def find(self, image: Pixels, *, first: int = 0, stop: int | None = None) -> Edge:
        """The surface in the columns from ``first`` up to ``stop`` of an image [n_rows, n_columns]."""
        coarse = self.coarse(image)
        return self.fine(image, self.rough(image, coarse, first=first, stop=stop))

    def coarse(self, image: Pixels) -> Floats:
        """Row of the edge in every column to about a pixel, shape [n_columns]; anything where there is none."""
        return coarse_edge(image, 1.0 if self.optics.sample_brighter else -1.0)

    def rough(self, image: Pixels, coarse: Floats, *, first: int = 0, stop: int | None = None) -> RoughEdge:
        """The surface to a fraction of a pixel, by which it is known what stands before it."""
        stop = image.shape[1] if stop is None else min(stop, image.shape[1])
        return _rough(image, coarse, max(first, 0), stop, self._by)

    def fine(self, image: Pixels, rough: RoughEdge, blocked: Flags | None = None) -> Edge:
        """The surface at both resolutions; ``blocked`` columns [n_columns] are hidden by something known."""
        blocked = np.zeros(rough.rows.size, np.bool_) if blocked is None else blocked
        return Edge(*_fine(image, rough, blocked, self._by))


class _Regularisation(NamedTuple):
    """What columns are put together by: blur of the optics [px], table of lateral kernels, penalty."""

    blur: float
    kernels: Floats
    stiffness: float


class _Fit(NamedTuple):
    """A band-limited surface in the columns from ``first`` to ``stop``, with ``reach`` more on both sides.

    Its factors, the uncertainty of a column in which it were level, and the surface as columns see it.
    """

    first: int
    stop: int
    reach: int
    surface: Floats
    factors: Band
    level_sigma: float
    linear: Floats


@allocating
def _rough(image: Pixels, coarse: Floats, first: int, stop: int, by: _Regularisation) -> RoughEdge:
    slope = _slope(coarse, _COARSE_SPAN)
    blur = _seen_blur(slope, by.blur)
    levels = find_levels(image, coarse, blur, first, stop)
    columns = find_columns(image, coarse, blur, levels, levels.usable, _ROUGHLY)
    rows, beyond = np.full(slope.size, np.nan), np.zeros(slope.size)
    if np.isfinite(columns.rows).sum() >= _FEWEST:
        fit = _fit(columns, slope, beyond, by)
        part, reach = slice(fit.first, fit.stop), fit.reach
        slope[part] = _slope(fit.surface, 1)[reach : fit.surface.size - reach]
        linear = seen_linearly(fit.surface, local_kernels(slope[part], by.kernels))
        rows[part] = seen_exactly(fit.surface, linear, slope[part], by.blur)
        beyond[part] = rows[part] - linear
    return RoughEdge(rows, slope, beyond, levels)


@allocating
def _fine(
    image: Pixels, rough: RoughEdge, blocked: Flags, by: _Regularisation
) -> tuple[Floats, Floats, Flags, Floats, Floats, Flags, float, float]:
    """Fields of ``Edge``."""
    levels = without(rough.levels, blocked) if blocked.any() else rough.levels
    usable = levels.usable & np.isfinite(rough.rows)
    columns = find_columns(image, rough.rows, _seen_blur(rough.slope, by.blur), levels, usable, _FINELY)
    _drop_astray(columns, rough.rows)
    n_columns, noise = usable.size, np.sqrt(np.mean(levels.noise**2))
    rows, sigma, own_rows = (
        np.full(n_columns, np.nan),
        np.full(n_columns, np.inf),
        np.full(n_columns, np.nan),
    )
    found = np.isfinite(columns.rows)
    if found.sum() < _FEWEST:
        nowhere = np.zeros(n_columns, np.bool_)
        return rows, sigma, nowhere, own_rows, sigma, nowhere, levels.contrast, noise
    fit = _fit(columns, rough.slope, rough.beyond, by)
    part, inner = slice(fit.first, fit.stop), slice(fit.reach, fit.surface.size - fit.reach)
    rows[part] = fit.surface[inner]
    sigma[part] = uncertainty(fit.factors, fit.level_sigma)[inner]
    own_rows[part] = (columns.rows - rough.beyond)[part] + fit.surface[inner] - fit.linear
    valid = sigma < np.maximum(np.where(found, columns.sigma, 0.0), fit.level_sigma)
    return rows, sigma, valid, own_rows, columns.sigma, found, levels.contrast, noise


@allocating
def _drop_astray(columns: Columns, rows: Floats) -> None:
    """Forget columns that are too far from the surface through their neighbours."""
    for c in range(rows.size):
        if not abs(columns.rows[c] - rows[c]) <= _ASTRAY * columns.sigma[c] + _ASTRAY_ROWS:
            columns.rows[c], columns.sigma[c] = np.nan, np.inf


@allocating
def _fit(columns: Columns, slope: Floats, beyond: Floats, by: _Regularisation) -> _Fit:
    """The surface through ``columns`` of a surface of about this ``slope``.

    ``beyond`` is where columns see the surface, less what the linear lateral blur says.
    """
    found = np.flatnonzero(np.isfinite(columns.rows))
    first, stop = found[0], found[-1] + 1
    part = slice(first, stop)
    level_sigma = _level_sigma(columns.sigma[found], slope[found], by.blur)
    local = local_kernels(slope[part], by.kernels)
    surface, factors = band_limited_surface(
        (columns.rows - beyond)[part], columns.sigma[part], level_sigma, slope[part], local, by.stiffness
    )
    return _Fit(
        first, stop, local.shape[0] // 2, surface, factors, level_sigma, seen_linearly(surface, local)
    )


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
