"""Grey values on both sides of the edge, and the noise: what the profile of the edge stands on.

On either side the pixels of a band beside the edge are described by I = value(x) + gradient(x) d, d the
distance from the edge down the column: the gradient pooled over a wide window of columns, the value by a
straight line in a window of triangular weight about each column. Pooling makes the levels so certain that
the edge can be found in each column as if they were known; gradient and line keep uneven lighting from
moving it.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Flags, Floats, Pixels

_BAND = 20  # pixels along the column
_FEWEST = 3  # pixels of a band that say anything
_CLEARANCE = 3.5  # blurs between the edge and the band
_HALF_WINDOW = 32  # two running sums over 2 _HALF_WINDOW + 1 columns make the triangular window
_GRADIENT_HALF_WINDOW = 96  # the same for the gradient
_GRADIENT_PRIOR = 0.01  # its standard deviation beforehand, in contrasts per pixel
_OUTLIER = 6.0  # standard deviations of a band's mean from the line, beyond a tenth of the contrast
_LEAST_NOISE = 0.29  # grey values: rounding to integers
_SPOILT = 2.2  # blurs between a column that something stands before and the nearest that may be trusted
_ENOUGH = 256  # columns, spread evenly, of which medians are taken
_LOWEST_CONTRAST = 0.4  # of the median: columns with less have no edge

_N, _D, _DD, _GREY, _GREY_D, _VARIANCE = range(6)
"""Sums over the band of each column on one side; d is the distance from the edge. The variance is that of a pixel's
noise, from differences between neighbouring columns."""


@dataclass(frozen=True)
class Levels:
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

    def without(self, hidden: Flags) -> Levels:
        """The same from other columns only, and the ``hidden`` ones [n_columns] blocked."""
        usable = self.usable & ~hidden
        return _levels(self.origin, self.blur, self.bands, usable, self.blocked | (self.usable & hidden))

    @property
    def mean_noise(self) -> float:
        """Root mean square of both sides' noise."""
        return float(np.sqrt(np.mean(self.noise**2)))


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
        away = band[_GREY, c] / n - value[c] - gradient[c] * band[_D, c] / n
        unlike[c] = usable[c] and not abs(away) <= _OUTLIER * noise / np.sqrt(n) + 0.1 * contrast
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
    sums = np.zeros((2, taken.size))
    for c in range(taken.size):
        if taken[c]:
            n = max(band[_N, c], 1.0)
            sums[0, c] = band[_DD, c] - band[_D, c] ** 2 / n
            sums[1, c] = band[_GREY_D, c] - band[_D, c] * band[_GREY, c] / n
    window = (2.0 * _GRADIENT_HALF_WINDOW + 1.0) ** 2 / (2.0 * _HALF_WINDOW + 1.0)
    _window(sums, _GRADIENT_HALF_WINDOW)
    for c in range(taken.size):
        gradient[c] = sums[1, c] / (sums[0, c] + ridge * window)


@allocating
def _find_value(band: Floats, taken: Flags, gradient: Floats, value: Floats) -> None:
    """Value at the edge: a straight line, weighted, about every column."""
    sums = np.zeros((5, taken.size))  # n, n x, n x^2, and grey value and grey value x
    for c in range(taken.size):
        if taken[c]:
            n = band[_N, c]
            total = band[_GREY, c] - gradient[c] * band[_D, c]
            sums[0, c], sums[1, c], sums[2, c] = n, n * c, n * c * c
            sums[3, c], sums[4, c] = total, total * c
    _window(sums, _HALF_WINDOW)
    for c in range(taken.size):
        w = sums[0, c]
        if w <= 0.5:
            value[c] = np.nan
            continue
        centre, mean = sums[1, c] / w, sums[3, c] / w
        line = (sums[4, c] / w - centre * mean) / (sums[2, c] / w - centre**2 + 1.0)
        value[c] = mean + line * (c - centre)


@allocating
def _window(sums: Floats, half: int) -> None:
    """Sum along each row in a window of triangular weight (two running sums), shorter at the ends, in place."""
    n_rows, n = sums.shape
    total = np.empty(n)
    for i in range(2 * n_rows):
        row = sums[i // 2]
        acc = 0.0
        for c in range(min(half, n)):
            acc += row[c]
        for c in range(n):
            if c + half < n:
                acc += row[c + half]
            if c > half:
                acc -= row[c - half - 1]
            total[c] = acc
        row[:] = total


@allocating
def _band_sums(image: Pixels, rows: Floats, blur: Floats, begin: int, stop: int) -> Floats:
    """Sums over the bands above and below, shape [2, 6, n_columns]."""
    n_rows, n_columns = image.shape
    sums = np.zeros((2, 6, n_columns))
    begin, stop = max(begin, 0), min(stop, n_columns)
    for c in range(begin, stop):
        away = _CLEARANCE * blur[c] + 1.0
        neighbour = c + 1 if c + 1 < stop else c - 1
        for side in range(2):
            if side == 1:
                first = max(int(np.ceil(rows[c] + away)), 0)
                last = min(first + _BAND - 1, n_rows - 1)
            else:
                last = min(int(np.floor(rows[c] - away)), n_rows - 1)
                first = max(last - _BAND + 1, 0)
            n, sd, sdd, si, sid, sv = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
            for r in range(first, last + 1):
                d = r - rows[c]
                grey = image[r, c]
                step = image[r, neighbour] - grey
                n += 1.0
                sd += d
                sdd += d * d
                si += grey
                sid += grey * d
                sv += 0.5 * step * step
            sums[side, _N, c], sums[side, _D, c], sums[side, _DD, c] = n, sd, sdd
            sums[side, _GREY, c], sums[side, _GREY_D, c], sums[side, _VARIANCE, c] = si, sid, sv
    return sums
