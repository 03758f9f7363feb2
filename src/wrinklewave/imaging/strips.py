"""Strips of an image averaged down the columns: profiles along the row, with little noise."""

from __future__ import annotations

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats, Pixels


def strip_mean(image: Pixels, top: Floats, n_rows: int) -> Floats:
    """Mean grey value of ``n_rows`` rows per column.

    Args:
        image: shape [n_rows, n_columns].
        top: first row of the strip in every column, shape [n_columns]; it is rounded, and cut at the image.

    Returns:
        Shape [n_columns]; NaN where nothing of the strip lies in the image or ``top`` is not known.
    """
    return _strip_mean(image, top, n_rows)


@allocating
def _strip_mean(image, top, n_rows):  # type: ignore[no-untyped-def]
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
