"""Strips of an image averaged down the columns: profiles along the row, with little noise."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats, Pixels


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
    mean = np.full(width, np.nan)
    for c in range(width):
        if not np.isfinite(top[c]):
            continue
        first = int(np.rint(top[c]))
        last = min(first + n_rows, height)
        first = max(first, 0)
        total = 0.0
        for r in range(first, last):
            total += image[r, c]
        if last > first:
            mean[c] = total / (last - first)
    return mean


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
