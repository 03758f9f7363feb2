"""The edge regularised along the surface: the band-limited surface that explains all columns together.

The rows z found column by column are those of a surface y seen through the lateral blur: z = B y + noise.
The surface minimises (z - B y)' W (z - B y) + q |D^p y|^2 / (2 sin(pi/R))^(2p), with W the inverse variances
relative to those of a level edge and D the difference operator; then once more, with the penalty on the change
only, which gives back most of what the penalty took. On an even row of columns a wave exp(i k x) passes with the
gain 1 - h^2, h = q u / (b^2 + q u), u = (sin(k/2) / sin(pi/R))^(2p), where b = exp(-k^2 v/2) is what the lateral
blur leaves of it: one for wavelengths above 1.2 R, 0.8 at the resolution R by the choice of q, nothing below
0.75 R. Where columns are known better than 0.1 px, q falls with their error: the better the image, the less is
lost at R.
"""

from __future__ import annotations

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats
from wrinklewave.imaging.edges.banded import Band, factorise, inverse_diagonal, normal_equations, solve

ORDER = 8  # p
_LOSS = 0.81  # q / b^2 at the resolution: h^2 = 0.2
_USUAL_SIGMA = 0.1  # px: standard uncertainty of a column below which q falls
_FILL = 1e-3  # weight of columns without an edge, against curves across gaps: keeps the equations regular
_BESIDE = 8  # columns on either side of a gap that say how the surface goes into it
_WIDEST_CURVE = 32  # columns of a gap; wider ones are crossed in a straight line


def penalty(resolution: float, blur: float) -> float:
    """Weight q / (2 sin(pi/R))^(2p) of the squared differences for a resolution R and a blur s [px]."""
    passed = np.exp(-((2 * np.pi / resolution) ** 2) * (blur**2 + 1 / 12))
    return float(_LOSS * passed / (2 * np.sin(np.pi / resolution)) ** (2 * ORDER))


@allocating
def band_limited_surface(
    rows: Floats, sigma: Floats, level_sigma: float, slope: Floats, local: Floats, stiffness: float
) -> tuple[Floats, Band]:
    """Best surface through the columns' rows, and the factors of its normal equations.

    Args:
        rows: the columns' estimates [px], NaN where there is none, first and last not NaN, shape [n].
        sigma: their standard uncertainties [px], shape [n].
        level_sigma: what a level edge's would be [px].
        slope: of the surface, for straight lines beyond its ends, shape [n].
        local: lateral blur per column, shape [2 reach + 1, n].
        stiffness: from ``penalty``.

    Returns:
        rows of the surface [px], with ``reach`` columns more on both sides; the factor for ``uncertainty``.
    """
    width, n = local.shape
    reach = width // 2
    filled, weights = _filled(rows), np.full(n, _FILL)
    for i in range(n):
        if np.isfinite(rows[i]):
            weights[i] = (level_sigma / sigma[i]) ** 2
    matrix, right = normal_equations(weights, filled, local, ORDER)
    for i in range(reach):
        matrix.diagonal[i] += _FILL
        right[i] += _FILL * (filled[0] - slope[0] * (reach - i))
        matrix.diagonal[n + reach + i] += _FILL
        right[n + reach + i] += _FILL * (filled[n - 1] + slope[n - 1] * (i + 1))
    stiffness *= min(1.0, level_sigma / _USUAL_SIGMA)
    _add_penalty(matrix, right.size, stiffness)
    factorise(matrix)
    surface = solve(matrix, right)
    return surface + solve(matrix, _pull(surface, stiffness)), matrix


@allocating
def uncertainty(factors: Band, level_sigma: float) -> Floats:
    """Standard uncertainty of a surface, from the diagonal of the inverse of its normal equations' matrix.

    That diagonal goes with the gain 1 - h, the random error with (1 - h^2)^2: their sums over all waves agree to 1 %.
    """
    return level_sigma * np.sqrt(inverse_diagonal(factors))


@allocating
def _filled(rows: Floats) -> Floats:
    """Cubics across gaps, by the straight lines through the columns beside them; straight across wide ones."""
    filled = rows.copy()
    last = 0
    for i in range(1, rows.size):
        if np.isfinite(rows[i]):
            gap = i - last
            if gap > 1:
                left, left_slope = _line_beside(rows, last, -1)
                right, right_slope = _line_beside(rows, i, 1)
                if gap > _WIDEST_CURVE:
                    left_slope = right_slope = (right - left) / gap
                for j in range(last + 1, i):
                    t = (j - last) / gap
                    filled[j] = (
                        left * (1.0 + 2.0 * t) * (1.0 - t) ** 2
                        + right * t * t * (3.0 - 2.0 * t)
                        + gap * t * (1.0 - t) * (left_slope * (1.0 - t) - right_slope * t)
                    )
            last = i
    return filled


@allocating
def _line_beside(rows: Floats, column: int, direction: int) -> tuple[float, float]:
    """Row at ``column`` and slope of the straight line through the known columns from there on in a direction."""
    n, sx, sxx, sy, sxy = 0.0, 0.0, 0.0, 0.0, 0.0
    for k in range(_BESIDE):
        i = column + direction * k
        if i < 0 or i >= rows.size or not np.isfinite(rows[i]):
            break
        x = float(direction * k)
        n += 1.0
        sx += x
        sxx += x * x
        sy += rows[i]
        sxy += x * rows[i]
    if n < 4.0:
        return rows[column], 0.0
    slope = (n * sxy - sx * sy) / (n * sxx - sx * sx)
    return (sy - slope * sx) / n, slope


@allocating
def _difference() -> Floats:
    """A row of D, the differences of order ORDER: binomial coefficients of alternating sign."""
    difference = np.zeros(ORDER + 1)
    difference[0] = 1.0
    for order in range(1, ORDER + 1):
        for k in range(order, 0, -1):
            difference[k] -= difference[k - 1]
    return difference


@allocating
def _pull(surface: Floats, stiffness: float) -> Floats:
    """stiffness D'D y, with which the penalty pulls at a surface y.

    The equations of the change x of a surface y that solves (N + stiffness D'D) y = r are (N + stiffness D'D) x =
    r - N y, and the right side is this.
    """
    difference = _difference()
    pull = np.zeros(surface.size)
    for i in range(surface.size - ORDER):
        bend = 0.0
        for j in range(ORDER + 1):
            bend += difference[j] * surface[i + j]
        for j in range(ORDER + 1):
            pull[i + j] += stiffness * bend * difference[j]
    return pull


@allocating
def _add_penalty(matrix: Band, n: int, stiffness: float) -> None:
    """Add stiffness D'D for n numbers."""
    difference = _difference()
    row = np.empty(ORDER + 1)
    for i in range(n):
        if i <= ORDER or i >= n - ORDER:  # further inside all rows are the same
            for k in range(ORDER + 1):
                row[k] = 0.0
                for j in range(max(i - n + ORDER + 1, 0), min(i, ORDER - k) + 1):
                    row[k] += stiffness * difference[j] * difference[j + k]
        matrix.diagonal[i] += row[0]
        for k in range(ORDER):
            matrix.beyond[i, k] += row[k + 1]
