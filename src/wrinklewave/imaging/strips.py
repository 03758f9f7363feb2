"""Strips of an image averaged down the columns: profiles along the row, with little noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating, uintp, vector
from wrinklewave.imaging.arrays import Floats, Pixels

_BLOCK = 64  # columns whose pixels are summed together


class Greys(NamedTuple):
    """Grey values that background and sample would have anywhere in an image.

    Attributes:
        row, slope: the straight line that they are known at: row at column 0, and rows per column.
        background, sample: there, shape [n_columns].
        background_gradient, sample_gradient: per pixel down the column, shape [n_columns].
    """

    row: float
    slope: float
    background: Floats
    sample: Floats
    background_gradient: Floats
    sample_gradient: Floats


@allocating
def strip_mean(image: Pixels, top: Floats, n_rows: int) -> Floats:
    """Mean grey value of ``n_rows`` rows per column.

    Args:
        image: shape [n_rows, n_columns].
        top: first row of the strip in every column, shape [n_columns]; it is rounded, and cut at the image.

    Returns:
        Shape [n_columns]; NaN where nothing of the strip lies in the image or ``top`` is not known.
    """
    height, width = image.shape
    first, stop = np.full(width, np.float32(height)), np.zeros(width, np.float32)
    for c in range(width):
        if np.isfinite(top[c]):
            first[c] = max(np.rint(top[c]), 0.0)
            stop[c] = max(min(np.rint(top[c]) + n_rows, height), 0.0)
    total = np.zeros(width, np.float32)
    for left in range(0, width, _BLOCK):
        right = min(left + _BLOCK, width)
        _add_rows(
            image, first, stop, left, right, int(first[left:right].min()), int(stop[left:right].max()), total
        )
    mean = np.full(width, np.nan)
    for c in range(width):
        if stop[c] > first[c]:
            mean[c] = total[c] / (stop[c] - first[c])
    return mean


@vector
def _add_rows(
    image: Pixels, first: Pixels, stop: Pixels, left: int, right: int, top: int, bottom: int, total: Pixels
) -> None:
    """Add the pixels from ``first`` to ``stop`` of some columns, row by row; those outside count as zeros.

    Single precision holds the sums of 64 rows of 16-bit grey values exactly.
    """
    for r in range(uintp(top), uintp(bottom)):
        row = np.float32(r)
        for c in range(uintp(left), uintp(right)):
            grey = np.float32(image[r, c])
            total[c] += grey if (row >= first[c]) & (row < stop[c]) else np.float32(0.0)


@allocating
def strip_shares(image: Pixels, top: Floats, n_rows: int, greys: Greys) -> Floats:
    """The same as shares of the way from the background (0) to the sample (1)."""
    shares = strip_mean(image, top, n_rows)
    for c in range(shares.size):
        depth = top[c] + 0.5 * (n_rows - 1) - greys.row - greys.slope * c
        background = greys.background[c] + greys.background_gradient[c] * depth
        sample = greys.sample[c] + greys.sample_gradient[c] * depth
        shares[c] = (shares[c] - background) / (sample - background)
    return shares
