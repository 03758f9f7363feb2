"""The edge in each column by maximum likelihood: the unbiased estimate that reaches the Cramér-Rao bound.

With levels, noise and blur known, the row y of the edge is the only unknown of a column: Gauss-Newton steps
minimise sum_j (I_j - I_above - (I_below - I_above) E(j - y))^2 / sigma_j^2 over a fixed window about the
edge, with E as in ``profile`` and sigma_j^2 between the two sides' in proportion (shot noise makes the
brighter side noisier).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wrinklewave._jit import allocating, strict
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.edges.lanes import LANES, Lanes, empty_lanes, take_two_steps
from wrinklewave.imaging.edges.levels import Levels, with_neighbours

_REACH = 3.0  # blurs on either side that carry information on the position
_MARGIN = 1.5  # pixels added for the error of the starting row
_TURNS = 6  # of two steps
_MISFIT = 0.06  # contrasts: what the model of the profile may miss, beyond noise
_MISFIT_SIGMAS = 5.0  # of the residual's root mean square


class Columns(NamedTuple):
    """The edge column by column, shape [n_columns].

    Attributes:
        rows: row of the edge [px], NaN where no edge of the expected shape was found.
        sigma: its standard uncertainty [px], infinite where there is none.
    """

    rows: Floats
    sigma: Floats


@allocating
def find_columns(
    image: Pixels, start: Floats, blur: Floats, levels: Levels, usable: Flags, tolerance: float
) -> Columns:
    """Maximum-likelihood row of the edge in every column that shows an edge of the expected shape.

    Args:
        image: grey values, shape [n_rows, n_columns].
        start: rows to start from, within about two blurs of the edge, shape [n_columns].
        blur: standard deviation of the blur down each column without the pixel's height [px], [n_columns].
        levels: the grey values beside the edge.
        usable: columns to look at, shape [n_columns].
        tolerance: the last step taken is smaller [px].
    """
    rows, sigma, residual, count = _locate(image, start, blur, levels, usable, tolerance)
    mean_noise = np.sqrt(np.mean(levels.noise**2))
    strange = levels.blocked.copy()
    for c in range(rows.size):
        if count[c] > 0:
            expected = mean_noise * (1.0 + _MISFIT_SIGMAS / np.sqrt(2.0 * count[c]))
            strange[c] = strange[c] or residual[c] > expected + _MISFIT * levels.contrast
    strange = with_neighbours(strange, blur)
    for c in range(rows.size):
        if strange[c]:
            rows[c], sigma[c] = np.nan, np.inf
    return Columns(rows, sigma)


@allocating
def _locate(
    image: Pixels, start: Floats, blur: Floats, levels: Levels, usable: Flags, tolerance: float
) -> tuple[Floats, Floats, Floats, NDArray[np.int64]]:
    """Rows and standard uncertainties; root mean square of the residual grey values and number of pixels.

    ``LANES`` columns at a time take two steps side by side; those that need more, few, take turns again.
    """
    rows, sigma = np.full(start.size, np.nan), np.full(start.size, np.inf)
    residual = np.full(start.size, np.inf)
    known = usable & np.isfinite(start + levels.value[0] + levels.value[1])
    first, count = _windows(image.shape[0], start, blur, known)
    at, left = start.copy(), np.flatnonzero(count)
    lanes = empty_lanes(count.max())
    for turn in range(_TURNS):
        n_left = 0
        for begin in range(0, left.size, LANES):
            columns = left[begin : begin + LANES]
            _fill(lanes, image, columns, first, count, at, blur, levels)
            take_two_steps(lanes, count[columns].max(), levels.noise)
            for i in range(columns.size):
                c = columns[i]
                at[c] = first[c] + lanes.at[i]
                if turn == 0:
                    residual[c] = np.sqrt(lanes.first_squares[i] / count[c])  # where nothing is found
                if not lanes.information[i] > 0.0 or abs(at[c] - start[c]) > _reach(blur[c]):
                    continue
                if abs(lanes.moved[i]) >= tolerance:
                    left[n_left] = c
                    n_left += 1
                    continue
                rows[c], sigma[c] = at[c], 1.0 / np.sqrt(lanes.information[i])
                residual[c] = np.sqrt(lanes.squares[i] / count[c])
        left = left[:n_left]
    return rows, sigma, residual, count


@strict
def _reach(blur: float) -> float:
    """Pixels on either side that are looked at."""
    return _REACH * blur + _MARGIN


@allocating
def _windows(
    n_rows: int, start: Floats, blur: Floats, known: Flags
) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """First pixel and number of pixels to look at, shape [n_columns]; none where the edge is not in sight."""
    first, count = np.zeros(start.size, np.int64), np.zeros(start.size, np.int64)
    for c in range(start.size):
        if known[c] and start[c] - 1.5 * blur[c] >= 0 and start[c] + 1.5 * blur[c] <= n_rows - 1:
            reach = _reach(blur[c])
            first[c] = max(int(np.floor(start[c] - reach)), 0)
            count[c] = min(int(np.ceil(start[c] + reach)), n_rows - 1) - first[c] + 1
    return first, count


@allocating
def _fill(
    lanes: Lanes,
    image: Pixels,
    columns: NDArray[np.int64],
    first: NDArray[np.int64],
    count: NDArray[np.int64],
    at: Floats,
    blur: Floats,
    levels: Levels,
) -> None:
    """What is known of ``columns`` in the first lanes; the others keep what they had."""
    value, gradient = levels.value, levels.gradient
    for i in range(columns.size):
        c = columns[i]
        lanes.depth[i], lanes.blur[i], lanes.at[i] = count[c], blur[c], at[c] - first[c]
        depth = first[c] - levels.origin[c]
        dark, dark_slope = value[0, c] + gradient[0, c] * depth, gradient[0, c]
        lanes.dark[i], lanes.dark_slope[i] = dark, dark_slope
        lanes.height[i] = value[1, c] + gradient[1, c] * depth - dark
        lanes.height_slope[i] = gradient[1, c] - dark_slope
        for j in range(count[c]):
            lanes.greys[j, i] = image[first[c] + j, c]
