"""Where the edge is, to a pixel or so: step responses of a binned frame and the best path through them.

Robust before precise: noise is averaged over bins of 4 x 2 pixels and over 8 rows on either side of a
candidate; a shortest path from the first column to the last (dynamic programming with a truncated cost of
steps) keeps stray edges from taking over single columns, and still lets the edge jump where the sample ends.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from wrinklewave._jit import allocating, uintp, vector
from wrinklewave.imaging.arrays import Floats, Pixels

BIN_COLUMNS = 4
BIN_ROWS = 2
_REACH = 4  # bins averaged on either side of a candidate
_STEP_COST = 0.05  # per row bin between neighbouring column bins, where a full step of grey value scores 1
_JUMP_COST = 0.6  # at most: the sample ends, something hides the edge
_FARTHEST = int(_JUMP_COST / _STEP_COST)  # row bins in a step; further is a jump
_MARGIN = 8
_1, _2, _3, _4, _8 = (uintp(k) for k in (1, 2, 3, 4, 8))
_FAR = np.float32(1e30)  # costs beyond the image


@allocating
def coarse_edge(image: Pixels, sign: float) -> Floats:
    """Row of the edge in every column to about a pixel, shape [n_columns].

    Args:
        image: grey values, shape [n_rows, n_columns], the sample on the side of the larger row index.
        sign: +1 if the sample is brighter than the background, -1 if darker.
    """
    score = _scores(_step_response(_binned(image)), np.float32(sign))
    return _unbinned(_best_path(score), score, image.shape[1])


def step_contrast(image: Pixels) -> tuple[float, float]:
    """Typical height of the strongest step of a column: grey values rising and falling with the row index.

    Medians over the columns: which of the two is larger tells whether the sample is the brighter side.
    """
    response = _step_response(_binned(image))
    return float(np.median(response.max(axis=0))), float(np.median((-response).max(axis=0)))


@allocating
def _binned(image: Pixels) -> Pixels:
    """Mean grey value of bins, shape [n_row_bins, n_column_bins]; leftover rows and columns are not used."""
    binned = np.empty((image.shape[0] // BIN_ROWS, image.shape[1] // BIN_COLUMNS), np.float32)
    total = np.empty(image.shape[1], np.float32)
    for r in range(binned.shape[0]):
        _add_rows(image[BIN_ROWS * r], image[BIN_ROWS * r + 1], total)
        _add_fours(total, binned[r])
    return binned


@vector
def _add_rows(upper: Pixels, lower: Pixels, total: Pixels) -> None:
    for c in range(total.size):
        total[c] = upper[c] + lower[c]


@vector
def _add_fours(total: Pixels, mean: Pixels) -> None:
    for c in range(uintp(mean.size)):
        k = c << uintp(2)
        mean[c] = (total[k] + total[k + _1] + total[k + _2] + total[k + _3]) * np.float32(0.125)


@allocating
def _step_response(binned: Pixels) -> Pixels:
    """Mean of the next ``_REACH`` bins minus mean of the last, between row bins r - 1 and r."""
    n_rows = binned.shape[0]
    response = np.zeros(binned.shape, np.float32)
    for r in range(1, n_rows):
        above, below = max(r - _REACH, 0), min(r + _REACH, n_rows)
        for k in range(above, below):
            _add(binned[k], np.float32(1.0 / (below - r) if k >= r else -1.0 / (r - above)), response[r])
    return response


@vector
def _add(values: Pixels, weight: np.float32, total: Pixels) -> None:
    for c in range(total.size):
        total[c] += weight * values[c]


@allocating
def _scores(response: Pixels, sign: np.float32) -> Pixels:
    """Responses as scores from 0 to 1, where 1 is the median of the columns' best, columns first."""
    best = np.zeros(response.shape[1], np.float32)
    for r in range(response.shape[0]):
        _keep_largest(response[r], sign, best)
    gain = sign / np.float32(max(float(np.median(best)), 1e-6))
    score = np.empty((response.shape[1], response.shape[0]), np.float32)
    _clip_and_transpose(response, gain, score)
    return score


@vector
def _keep_largest(values: Pixels, sign: np.float32, largest: Pixels) -> None:
    for c in range(largest.size):
        largest[c] = max(largest[c], sign * values[c])


@vector
def _clip_and_transpose(response: Pixels, gain: np.float32, score: Pixels) -> None:
    for c in range(score.shape[0]):
        for r in range(score.shape[1]):
            score[c, r] = min(max(gain * response[r, c], np.float32(0.0)), np.float32(1.0))


@allocating
def _best_path(score: Pixels) -> NDArray[np.int64]:
    """Row bins of the path of largest total score less the cost of its steps, shape [n_column_bins].

    Dynamic programming: least costs up to every bin, then back from the least of all. The cost of a step is
    min(_STEP_COST |dr|, _JUMP_COST).
    """
    n_columns, n_rows = score.shape
    cost = np.empty((n_columns, n_rows), np.float32)
    step = np.full(n_rows + 2 * _MARGIN, _FAR)
    least = np.empty(n_columns, np.float32)
    _least_costs(score, step, step.copy(), cost, least)
    path = np.empty(n_columns, np.int64)
    path[-1] = np.argmin(cost[-1])
    for c in range(n_columns - 2, -1, -1):
        path[c], paid = _nearest_origin(cost[c], path[c + 1])
        if least[c] + np.float32(_JUMP_COST) < paid:
            path[c] = np.argmin(cost[c])
    return path


@vector
def _least_costs(score: Pixels, step: Pixels, other: Pixels, cost: Pixels, least: Pixels) -> None:
    """Costs of the cheapest paths from the first column to every bin, shape [n_column_bins, n_row_bins].

    Steps of all lengths are sums of those in ``_SHIFTS``: few passes, each a vector operation over all rows.
    """
    jump = np.float32(0.0)
    for c in range(uintp(score.shape[0])):
        for r in range(uintp(score.shape[1])):
            there = min(step[r + _8], jump) - score[c, r]
            cost[c, r] = there
            step[r + _8] = there
        least[c] = _least(step)
        jump = least[c] + np.float32(_JUMP_COST)
        _spread(step, _1, other)
        _spread(other, _2, step)
        _spread(step, _4, other)
        _spread(other, _8, step)


@vector
def _least(cost: Pixels) -> np.float32:
    least = _FAR
    for r in range(uintp(cost.size)):
        if cost[r] < least:
            least = cost[r]
    return least


@vector
def _spread(cost: Pixels, shift: int, spread: Pixels) -> None:
    """Least costs with or without a step of ``shift`` either way."""
    price = np.float32(np.float32(shift) * _STEP_COST)
    for r in range(uintp(_MARGIN), uintp(cost.size - _MARGIN)):
        spread[r] = min(cost[r], min(cost[r - shift], cost[r + shift]) + price)


@allocating
def _nearest_origin(cost: Pixels, row: int) -> tuple[int, float]:
    """Row bin from which ``row`` of the next column is reached at the least cost without a jump, and the cost."""
    origin, least = row, cost[row]
    for r in range(max(row - _FARTHEST, 0), min(row + _FARTHEST + 1, cost.size)):
        there = cost[r] + np.float32(_STEP_COST * abs(r - row))
        if there < least:
            origin, least = r, there
    return origin, least


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
