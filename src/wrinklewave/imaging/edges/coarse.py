"""Where the edge is, to a pixel or so: step responses of a binned frame and the best path through them.

Robust before precise: noise is averaged over bins of 4 x 2 pixels and over 8 rows on either side of a
candidate; a shortest path from the first column to the last (dynamic programming with a truncated cost of
steps) keeps stray edges from taking over single columns, and still lets the edge jump where the sample ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats, Pixels

BIN_COLUMNS = 4
BIN_ROWS = 2
_REACH = 4  # bins averaged on either side of a candidate
_STEP_COST = 0.05  # per row bin between neighbouring column bins, where a full step of grey value scores 1
_JUMP_COST = 0.6  # at most: the sample ends, something hides the edge


def coarse_edge(image: Pixels, sign: float) -> Floats:
    """Row of the edge in every column to about a pixel, shape [n_columns].

    Args:
        image: grey values, shape [n_rows, n_columns], the sample on the side of the larger row index.
        sign: +1 if the sample is brighter than the background, -1 if darker.
    """
    score = _step_response(_binned(image))
    _score(score, np.float32(sign))
    return _unbinned(_best_path(score), score, image.shape[1])


def step_contrast(image: Pixels) -> tuple[float, float]:
    """Typical height of the strongest step of a column: grey values rising and falling with the row index.

    Medians over the columns: which of the two is larger tells whether the sample is the brighter side.
    """
    response = _step_response(_binned(image))
    return float(np.median(response.max(axis=1))), float(np.median((-response).max(axis=1)))


@allocating
def _binned(image: Pixels) -> Pixels:
    """Mean grey value of bins, shape [n_column_bins, n_row_bins]; leftover rows and columns are not used."""
    n_rows, n_columns = image.shape[0] // BIN_ROWS, image.shape[1] // BIN_COLUMNS
    binned = np.empty((n_columns, n_rows), np.float32)
    total = np.empty(image.shape[1], np.float32)
    for r in range(n_rows):
        for c in range(image.shape[1]):
            total[c] = image[BIN_ROWS * r, c] + image[BIN_ROWS * r + 1, c]
        for c in range(n_columns):
            k = BIN_COLUMNS * c
            binned[c, r] = (total[k] + total[k + 1] + total[k + 2] + total[k + 3]) * np.float32(0.125)
    return binned


@allocating
def _step_response(binned: Pixels) -> Pixels:
    """Mean of the next ``_REACH`` bins minus mean of the last, between row bins r - 1 and r."""
    n_columns, n_rows = binned.shape
    response = np.zeros((n_columns, n_rows), np.float32)
    total = np.zeros(n_rows + 1)
    for c in range(n_columns):
        for r in range(n_rows):
            total[r + 1] = total[r] + binned[c, r]
        for r in range(1, n_rows):
            above, below = max(r - _REACH, 0), min(r + _REACH, n_rows)
            response[c, r] = (total[below] - total[r]) / (below - r) - (total[r] - total[above]) / (r - above)
    return response


@allocating
def _score(response: Pixels, sign: np.float32) -> None:
    """Make the responses scores from 0 to 1, in place: 1 is the median of the columns' best."""
    n_columns, n_rows = response.shape
    best = np.empty(n_columns)
    for c in range(n_columns):
        largest = sign * response[c, 0]
        for r in range(1, n_rows):
            largest = max(largest, sign * response[c, r])
        best[c] = largest
    gain = sign / np.float32(max(np.median(best), 1e-6))
    for c in range(n_columns):
        for r in range(n_rows):
            response[c, r] = min(max(gain * response[c, r], np.float32(0.0)), np.float32(1.0))


@allocating
def _best_path(score: Pixels) -> NDArray[np.int64]:
    """Row bins of the path of largest total score less the cost of its steps, shape [n_column_bins].

    The cost of a step, min(_STEP_COST |dr|, _JUMP_COST), is minimised in linear time: a pass forward and a
    pass backward for the linear part, one global minimum for the jumps.
    """
    n_columns, n_rows = score.shape
    origin = np.empty((n_columns, n_rows), np.int16)
    cost = -score[0].astype(np.float64)
    step = np.empty(n_rows)
    for c in range(1, n_columns):
        cheapest = 0
        for r in range(n_rows):
            step[r] = cost[r]
            origin[c, r] = r
            if cost[r] < cost[cheapest]:
                cheapest = r
        for r in range(1, n_rows):
            if step[r - 1] + _STEP_COST < step[r]:
                step[r] = step[r - 1] + _STEP_COST
                origin[c, r] = origin[c, r - 1]
        for r in range(n_rows - 2, -1, -1):
            if step[r + 1] + _STEP_COST < step[r]:
                step[r] = step[r + 1] + _STEP_COST
                origin[c, r] = origin[c, r + 1]
        jump = cost[cheapest] + _JUMP_COST
        for r in range(n_rows):
            if jump < step[r]:
                step[r] = jump
                origin[c, r] = cheapest
            cost[r] = step[r] - score[c, r]
    path = np.empty(n_columns, np.int64)
    path[-1] = np.argmin(cost)
    for c in range(n_columns - 1, 0, -1):
        path[c - 1] = origin[c, path[c]]
    return path


@allocating
def _unbinned(path: NDArray[np.int64], score: Pixels, n_columns: int) -> Floats:
    """Rows per column: the parabola through three scores at each bin, and straight lines between bins."""
    centre = np.empty(path.size)
    for c in range(path.size):
        r = path[c]
        shift = 0.0
        if 0 < r < score.shape[1] - 1:
            left, mid, right = score[c, r - 1], score[c, r], score[c, r + 1]
            bend = left - 2.0 * mid + right
            if bend < 0.0:
                shift = min(max(0.5 * (left - right) / bend, -0.5), 0.5)
        centre[c] = BIN_ROWS * (r + shift) - 0.5
    rows = np.empty(n_columns)
    for x in range(n_columns):
        position = (x - 0.5 * (BIN_COLUMNS - 1)) / BIN_COLUMNS
        c = min(max(int(np.floor(position)), 0), path.size - 2)
        rows[x] = centre[c] + (position - c) * (centre[c + 1] - centre[c])
    return rows
