"""Grey values on both sides of the edge, and the noise: what the profile of the edge stands on.

On either side the pixels of a band beside the edge are described by I = value(x) + gradient(x) d, d the
distance from the edge down the column: the gradient pooled over a wide window of columns, the value by a
straight line in a window of triangular weight about each column. Pooling makes the levels so certain that
the edge can be found in each column as if they were known; gradient and line keep uneven lighting from
moving it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating, uintp, vector
from wrinklewave.imaging.arrays import Flags, Floats, Pixels

_BAND = 20  # pixels along the column
_FEWEST = 3  # pixels of a band that say anything
_CLEARANCE = 3.5  # blurs between the edge and the band
_BIN = 4  # columns that share a line
_WIDTH = 16  # bins: half the base of the triangular window
_GRADIENT_WIDTH = 48  # the same for the gradient
_GRADIENT_PRIOR = 0.01  # its standard deviation beforehand, in contrasts per pixel
_LANES = 8  # numbers smoothed side by side
_BLOCK = 64  # columns whose pixels are summed together
_OUTLIER = 6.0  # standard deviations of a band's mean from the line, beyond a tenth of the contrast
_LEAST_NOISE = 0.29  # grey values: rounding to integers
_SPOILT = 2.2  # blurs between a column that something stands before and the nearest that may be trusted
_ENOUGH = 256  # columns, spread evenly, of which medians are taken
_LOWEST_CONTRAST = 0.4  # of the median: columns with less have no edge

_N, _D, _DD, _GREY, _GREY_D, _VARIANCE = range(6)
"""Sums over the band of each column on one side; d is the distance from the edge. The variance is that of a pixel's
noise, from differences between neighbouring columns."""


class Levels(NamedTuple):
    """Grey values beside the edge.

    Attributes:
        origin: rows at which ``value`` holds, shape [n_columns].
        blur: down the columns [px], shape [n_columns].
        bands: sums over the pixels beside the edge, above and below, shape [2, 6, n_columns].
        value: above (background) and below (sample), shape [2, n_columns]; NaN where unknown.
        gradient: the same per pixel down the column, shape [2, n_columns].
        noise: standard deviation of a pixel's noise above and below, shape [2].
        usable: whether the column shows a step of the usual contrast, shape [n_columns].
        blocked: whether it was looked at and does not, shape [n_columns].
        contrast: median height of the step.
    """

    origin: Floats
    blur: Floats
    bands: Floats
    value: Floats
    gradient: Floats
    noise: Floats
    usable: Flags
    blocked: Flags
    contrast: float

    @property
    def mean_noise(self) -> float:
        """Root mean square of both sides' noise."""
        return float(np.sqrt(np.mean(self.noise**2)))


@allocating
def find_levels(image: Pixels, rows: Floats, blur: Floats, first: int, stop: int) -> Levels:
    """Levels on both sides of an edge known to a pixel or two.

    Args:
        image: grey values, shape [n_rows, n_columns].
        rows: row of the edge, shape [n_columns].
        blur: standard deviation of the blur down each column [px], shape [n_columns].
        first, stop: the columns to look at.
    """
    bands = _band_sums(image, rows, blur, first, stop)
    usable, blocked = _with_contrast(bands, first, stop)
    return _levels(rows, blur, bands, usable, blocked)


@allocating
def without(levels: Levels, hidden: Flags) -> Levels:
    """The same from other columns only, and the ``hidden`` ones [n_columns] blocked."""
    usable, blocked = levels.usable & ~hidden, levels.blocked | (levels.usable & hidden)
    return _levels(levels.origin, levels.blur, levels.bands, usable, blocked)


@allocating
def _levels(rows: Floats, blur: Floats, bands: Floats, usable: Flags, blocked: Flags) -> Levels:
    contrast, noise, value, gradient = _lines(bands, usable, blur)
    return Levels(rows, blur, bands, value, gradient, noise, usable, blocked, contrast)


@allocating
def with_neighbours(marked: Flags, blur: Floats) -> Flags:
    """Marked columns and those that the blur mixes with them, shape [n_columns]."""
    width = int(np.ceil(_SPOILT * np.min(blur)))
    n = marked.size
    spread = np.zeros(n, np.bool_)
    for c in range(n):
        if marked[c]:
            spread[max(c - width, 0) : min(c + width + 1, n)] = True
    return spread


@allocating
def _with_contrast(bands: Floats, first: int, stop: int) -> tuple[Flags, Flags]:
    """Which columns between ``first`` and ``stop`` show a step of the usual contrast, and which do not."""
    n_columns = bands.shape[2]
    step = _steps(bands)
    seen = (bands[0, _N] >= _FEWEST) & (bands[1, _N] >= _FEWEST)
    typical = _median(step, seen) if seen.any() else 0.0
    usable = seen & (step * typical > _LOWEST_CONTRAST * typical**2)
    blocked = np.zeros(n_columns, np.bool_)
    for c in range(max(first, 0), min(stop, n_columns)):
        blocked[c] = not usable[c]
    return usable, blocked


@allocating
def _steps(bands: Floats) -> Floats:
    """Mean grey value below less that above, shape [n_columns]."""
    step = np.empty(bands.shape[2])
    for c in range(step.size):
        step[c] = bands[1, _GREY, c] / max(bands[1, _N, c], 1.0) - bands[0, _GREY, c] / max(
            bands[0, _N, c], 1.0
        )
    return step


@allocating
def _lines(bands: Floats, usable: Flags, blur: Floats) -> tuple[float, Floats, Floats, Floats]:
    """Contrast; noise on both sides; value and gradient on both sides, as in ``Levels``."""
    n_columns = usable.size
    noise, value, gradient = np.empty(2), np.empty((2, n_columns)), np.empty((2, n_columns))
    contrast = abs(_median(_steps(bands), usable)) if usable.any() else 0.0
    for side in range(2):
        noise[side] = _pooled_noise(bands[side], usable)
        _side(bands[side], usable, contrast, noise[side], blur, value[side], gradient[side])
    return contrast, noise, value, gradient


@allocating
def _side(
    band: Floats,
    usable: Flags,
    contrast: float,
    noise: float,
    blur: Floats,
    value: Floats,
    gradient: Floats,
) -> None:
    """Value and gradient on one side; again without columns unlike their neighbours (a wire, a shadow)."""
    ridge = (noise / max(_GRADIENT_PRIOR * contrast, 1e-9)) ** 2
    _find_gradient(band, usable, ridge, gradient)
    _find_value(band, usable, gradient, value)
    unlike = np.zeros(usable.size, np.bool_)
    for c in range(usable.size):
        n = max(band[_N, c], 1.0)
        away = band[_GREY, c] - n * value[c] - gradient[c] * band[_D, c]
        unlike[c] = usable[c] and not abs(away) <= _OUTLIER * noise * np.sqrt(n) + 0.1 * contrast * n
    if unlike.any():
        alike = usable & ~with_neighbours(unlike, blur)
        _find_gradient(band, alike, ridge, gradient)
        _find_value(band, alike, gradient, value)


@allocating
def _pooled_noise(band: Floats, usable: Flags) -> float:
    """Median over columns of the bands' variances, brought to the mean (Wilson and Hilferty)."""
    if not usable.any():
        return _LEAST_NOISE
    n = _median(band[_N], usable)
    median = _median(band[_VARIANCE] / band[_N], usable)
    return max(np.sqrt(median / (1.0 - 2.0 / (9.0 * n)) ** 3), _LEAST_NOISE)


@allocating
def _median(values: Floats, taken: Flags) -> float:
    """Median of the values that are taken, or of every so many of them."""
    chosen = values[taken]
    return np.median(chosen[:: max(chosen.size // _ENOUGH, 1)])


@allocating
def _find_gradient(band: Floats, taken: Flags, ridge: float, gradient: Floats) -> None:
    """Gradient down the columns, from what varies within each column, in the wide window."""
    sums = _zero_bins(taken.size, _GRADIENT_WIDTH)  # of d^2 and of grey value times d
    for c in range(taken.size):
        if taken[c]:
            r, share = 2 * _GRADIENT_WIDTH + c // _BIN, band[_D, c] / max(band[_N, c], 1.0)
            sums[r, 0] += band[_DD, c] - share * band[_D, c]
            sums[r, 1] += band[_GREY_D, c] - share * band[_GREY, c]
    _smooth(sums, _GRADIENT_WIDTH, np.zeros(_LANES), np.zeros(_LANES))
    prior = ridge * _GRADIENT_WIDTH**2 / _WIDTH
    for c in range(taken.size):
        r = _GRADIENT_WIDTH - 1 + c // _BIN
        gradient[c] = sums[r, 1] / (sums[r, 0] + prior)


@allocating
def _find_value(band: Floats, taken: Flags, gradient: Floats, value: Floats) -> None:
    """Value at the edge: a straight line, weighted, about every bin."""
    sums = _zero_bins(taken.size, _WIDTH)  # n, n x, n x^2, grey value and grey value times x
    for c in range(taken.size):
        if taken[c]:
            r, n, total = 2 * _WIDTH + c // _BIN, band[_N, c], band[_GREY, c] - gradient[c] * band[_D, c]
            sums[r, 0] += n
            sums[r, 1] += n * c
            sums[r, 2] += n * c * c
            sums[r, 3] += total
            sums[r, 4] += total * c
    _smooth(sums, _WIDTH, np.zeros(_LANES), np.zeros(_LANES))
    _put_lines(sums, value)


@allocating
def _put_lines(sums: Floats, value: Floats) -> None:
    """The line of each column's bin at the column."""
    centre, mean, line = 0.0, np.nan, 0.0
    for c in range(value.size):
        if c % _BIN == 0:
            r = _WIDTH - 1 + c // _BIN
            centre, mean, line = 0.0, np.nan, 0.0
            if sums[r, 0] > 0.5:
                centre, mean = sums[r, 1] / sums[r, 0], sums[r, 3] / sums[r, 0]
                spread = sums[r, 2] / sums[r, 0] - centre * centre + 1.0
                line = (sums[r, 4] / sums[r, 0] - centre * mean) / spread
        value[c] = mean + line * (c - centre)


@allocating
def _zero_bins(n_columns: int, width: int) -> Floats:
    """For sums over bins of columns, and what ``_smooth`` needs beside."""
    return np.zeros(((n_columns - 1) // _BIN + 1 + 3 * width, _LANES))


@vector
def _smooth(sums: Floats, width: int, rise: Floats, level: Floats) -> None:
    """Sums in a window of triangular weight, ``width`` at its middle, in place.

    The second difference of the triangle is 1 at -width, -2 at 0, 1 at +width. Row r moves to row r - width - 1, so 2
    width rows before those that count and width after them are zeros; so are ``rise`` and ``level``, shape [_LANES].
    """
    w = uintp(width)
    for i in range(uintp(sums.shape[0]) - w - w):
        for q in range(uintp(_LANES)):
            rise[q] += sums[i + w + w, q] - 2.0 * sums[i + w, q] + sums[i, q]
            level[q] += rise[q]
            sums[i, q] = level[q]


@allocating
def _band_sums(image: Pixels, rows: Floats, blur: Floats, begin: int, stop: int) -> Floats:
    """Sums over the bands above and below, shape [2, 6, n_columns]."""
    n_rows, n_columns = image.shape
    begin, stop = max(begin, 0), min(stop, n_columns)
    sums = np.zeros((2, 6, n_columns))
    for side in range(2):
        top, bottom = np.zeros(n_columns, np.float32), np.full(n_columns, np.float32(-1.0))
        _bounds(rows, blur, side, n_rows, begin, stop, top, bottom)
        grey = np.zeros(n_columns, np.float32)
        grey_depth, variance = grey.copy(), grey.copy()
        for left in range(begin, stop, _BLOCK):
            right = min(left + _BLOCK, stop)
            first, last = int(top[left:right].min()), int(bottom[left:right].max())
            inner = min(right, n_columns - 1)
            _add_pixels(image, top, bottom, left, inner, 1, first, last + 1, grey, grey_depth, variance)
            _add_pixels(image, top, bottom, inner, right, -1, first, last + 1, grey, grey_depth, variance)
        _moments(top, bottom, rows, grey, grey_depth, variance, sums[side])
    return sums


@vector
def _bounds(
    rows: Floats, blur: Floats, side: int, n_rows: int, begin: int, stop: int, top: Pixels, bottom: Pixels
) -> None:
    """First and last row of a band, the latter before the first where nothing of it is in the image."""
    last = float(n_rows - 1)
    for c in range(uintp(begin), uintp(stop)):
        away = _CLEARANCE * blur[c] + 1.0
        nearest = np.ceil(rows[c] + away) if side == 1 else np.floor(rows[c] - away)
        other = nearest + (_BAND - 1.0) if side == 1 else nearest - (_BAND - 1.0)
        top[c] = max(min(nearest, other), 0.0)
        bottom[c] = max(min(max(nearest, other), last), -1.0)


@vector
def _moments(
    top: Pixels,
    bottom: Pixels,
    rows: Floats,
    grey: Pixels,
    grey_depth: Pixels,
    variance: Pixels,
    sums: Floats,
) -> None:
    """Sums as in ``bands`` from those over depths below ``top``."""
    for c in range(uintp(top.size)):
        n, d = max(bottom[c] - top[c] + 1.0, 0.0), top[c] - rows[c]
        sums[_N, c] = n
        sums[_D, c] = n * (d + 0.5 * (n - 1.0))
        sums[_DD, c] = n * (d * d + d * (n - 1.0) + (n - 1.0) * (2.0 * n - 1.0) / 6.0)
        sums[_GREY, c] = grey[c]
        sums[_GREY_D, c] = grey_depth[c] + d * grey[c]
        sums[_VARIANCE, c] = variance[c]


@vector
def _add_pixels(
    image: Pixels,
    top: Pixels,
    bottom: Pixels,
    left: int,
    right: int,
    neighbour: int,
    first: int,
    stop: int,
    grey: Pixels,
    grey_depth: Pixels,
    variance: Pixels,
) -> None:
    """Add the pixels between top and bottom of the columns from ``left`` to ``right``.

    The noise is taken from differences to the ``neighbour`` at +1 or -1. Row by row, those outside as zeros: they cost
    less than to jump from column to column. Single precision holds the sums of 12-bit grey values exactly.
    """
    beside = uintp(neighbour)  # unsigned numbers wrap: c + beside is c - 1 for -1
    for r in range(uintp(first), uintp(stop)):
        row = np.float32(r)
        for c in range(uintp(left), uintp(right)):
            counts = (row >= top[c]) & (row <= bottom[c])
            here = np.float32(image[r, c])
            step = np.float32(image[r, c + beside]) - here
            here = here if counts else np.float32(0.0)
            step = step if counts else np.float32(0.0)
            grey[c] += here
            grey_depth[c] += here * (row - top[c])
            variance[c] += np.float32(0.5) * step * step
