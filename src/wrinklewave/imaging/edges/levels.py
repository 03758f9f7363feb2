"""Grey values on both sides of the edge, and the noise: what the profile of the edge stands on.

On either side the pixels of a band beside the edge are described by I = value(x) + gradient(x) d, d the
distance from the edge down the column: the gradient pooled over a wide window of columns, the value by a
straight line in a window of triangular weight about each column. Pooling makes the levels so certain that
the edge can be found in each column as if they were known; gradient and line keep uneven lighting from
moving it.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

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
_LOWEST_CONTRAST = 0.4  # of the median: columns with less have no edge


class _Band(NamedTuple):
    """Sums over the band of each column on one side, shape [n_columns]; d is the distance from the edge."""

    n: Floats
    d: Floats
    dd: Floats
    grey: Floats
    grey_d: Floats
    variance: Floats

    @property
    def mean(self) -> Floats:
        return self.grey / np.maximum(self.n, 1.0)


@dataclass(frozen=True)
class Levels:
    """Grey values beside the edge.

    Attributes:
        origin: rows at which ``value`` holds, shape [n_columns].
        blur: down the columns [px], shape [n_columns].
        bands: sums over the pixels beside the edge, above and below.
        value: above (background) and below (sample), shape [2, n_columns]; NaN where unknown.
        gradient: the same per pixel down the column, shape [2, n_columns].
        noise: standard deviation of a pixel's noise above and below, shape [2].
        usable: whether the column shows a step of the usual contrast, shape [n_columns].
        blocked: whether it was looked at and does not, shape [n_columns].
        contrast: median height of the step.
    """

    origin: Floats
    blur: Floats
    bands: tuple[_Band, _Band]
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
    bands = (
        _Band(*_band_sums(image, rows, blur, False, first, stop)),
        _Band(*_band_sums(image, rows, blur, True, first, stop)),
    )
    step = bands[1].mean - bands[0].mean
    seen = (bands[0].n >= _FEWEST) & (bands[1].n >= _FEWEST)
    typical = float(np.median(step[seen])) if seen.any() else 0.0
    usable = seen & (step * typical > _LOWEST_CONTRAST * typical**2)
    return _levels(rows, blur, bands, usable, _looked_at(first, stop, rows.size) & ~usable)


def _levels(rows: Floats, blur: Floats, bands: tuple[_Band, _Band], usable: Flags, blocked: Flags) -> Levels:
    step = (bands[1].mean - bands[0].mean)[usable]
    contrast = abs(float(np.median(step))) if usable.any() else 0.0
    noise = np.array([_pooled_noise(band, usable) for band in bands])
    sides = [_side(bands[i], usable, contrast, float(noise[i]), blur) for i in (0, 1)]
    return Levels(
        origin=rows,
        blur=blur,
        bands=bands,
        value=np.array([value for value, _ in sides]),
        gradient=np.array([gradient for _, gradient in sides]),
        noise=noise,
        usable=usable,
        blocked=blocked,
        contrast=contrast,
    )


def with_neighbours(marked: Flags, blur: Floats) -> Flags:
    """Marked columns and those that the blur mixes with them, shape [n_columns]."""
    width = int(np.ceil(_SPOILT * float(np.min(blur))))
    count = np.cumsum(np.concatenate([np.zeros(width + 1), marked, np.zeros(width)]))
    return count[2 * width + 1 :] > count[: -2 * width - 1]


def _looked_at(first: int, stop: int, n_columns: int) -> Flags:
    columns = np.arange(n_columns)
    return (columns >= first) & (columns < stop)


def _side(band: _Band, usable: Flags, contrast: float, noise: float, blur: Floats) -> tuple[Floats, Floats]:
    """Value and gradient on one side; again without columns unlike their neighbours (a wire, a shadow)."""
    ridge = (noise / max(_GRADIENT_PRIOR * contrast, 1e-9)) ** 2
    gradient = _gradient(band, usable, ridge)
    value = _value(band, usable, gradient)
    n = np.maximum(band.n, 1.0)
    limit = _OUTLIER * noise / np.sqrt(n) + 0.1 * contrast
    unlike = usable & ~(np.abs(band.mean - value - gradient * band.d / n) <= limit)
    if not unlike.any():
        return value, gradient
    alike = usable & ~with_neighbours(unlike, blur)
    gradient = _gradient(band, alike, ridge)
    return _value(band, alike, gradient), gradient


def _pooled_noise(band: _Band, usable: Flags) -> float:
    """Median over columns of the bands' variances, brought to the mean (Wilson and Hilferty)."""
    if not usable.any():
        return _LEAST_NOISE
    n = float(np.median(band.n[usable]))
    median = float(np.median(band.variance[usable] / band.n[usable]))
    return max(float(np.sqrt(median / (1.0 - 2.0 / (9.0 * n)) ** 3)), _LEAST_NOISE)


def _gradient(band: _Band, taken: Flags, ridge: float) -> Floats:
    """Gradient down the columns, from what varies within each column, in the wide window."""
    n = np.maximum(band.n, 1.0)
    spread = np.where(taken, band.dd - band.d**2 / n, 0.0)
    covariance = np.where(taken, band.grey_d - band.d * band.grey / n, 0.0)
    window = (2.0 * _GRADIENT_HALF_WINDOW + 1.0) ** 2 / (2.0 * _HALF_WINDOW + 1.0)
    spread, covariance = _windowed(np.stack([spread, covariance]), _GRADIENT_HALF_WINDOW)
    return covariance / (spread + ridge * window)


def _value(band: _Band, taken: Flags, gradient: Floats) -> Floats:
    """Value at the edge: a straight line, weighted, about every column."""
    x = np.arange(band.n.size, dtype=float)
    n = np.where(taken, band.n, 0.0)
    total = np.where(taken, band.grey - gradient * band.d, 0.0)
    w, wx, wxx, wv, wxv = _windowed(np.stack([n, n * x, n * x * x, total, total * x]), _HALF_WINDOW)
    known = w > 0.5
    w = np.where(known, w, 1.0)
    centre, mean = wx / w, wv / w
    line = (wxv / w - centre * mean) / (wxx / w - centre**2 + 1.0)
    return np.where(known, mean + line * (x - centre), np.nan)


@allocating
def _windowed(values: Floats, half: int) -> Floats:
    """Sums along each row in a window of triangular weight (two running sums), shorter at the ends."""
    n_rows, n = values.shape
    total = np.empty(n)
    sums = values.copy()
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
    return sums


@allocating
def _band_sums(
    image: Pixels, rows: Floats, blur: Floats, below: bool, begin: int, stop: int
) -> tuple[Floats, Floats, Floats, Floats, Floats, Floats]:
    """The sums of ``_Band``; the variance comes from differences between neighbouring columns."""
    n_rows, n_columns = image.shape
    n, sd, sdd = np.zeros(n_columns), np.zeros(n_columns), np.zeros(n_columns)
    si, sid, sv = np.zeros(n_columns), np.zeros(n_columns), np.zeros(n_columns)
    for c in range(begin, stop):
        away = _CLEARANCE * blur[c] + 1.0
        if below:
            first = max(int(np.ceil(rows[c] + away)), 0)
            last = min(first + _BAND - 1, n_rows - 1)
        else:
            last = min(int(np.floor(rows[c] - away)), n_rows - 1)
            first = max(last - _BAND + 1, 0)
        neighbour = c + 1 if c + 1 < stop else c - 1
        for r in range(first, last + 1):
            d = r - rows[c]
            grey = image[r, c]
            step = image[r, neighbour] - grey
            n[c] += 1.0
            sd[c] += d
            sdd[c] += d * d
            si[c] += grey
            sid[c] += grey * d
            sv[c] += 0.5 * step * step
    return n, sd, sdd, si, sid, sv
