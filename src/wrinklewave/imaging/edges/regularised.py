"""The edge regularised along the surface: the band-limited surface that explains all columns together.

The rows z found column by column are those of a surface y seen through the lateral blur: z = B y + noise.
The surface minimises (z - B y)' W (z - B y) + q |D^p y|^2 / (2 sin(pi/R))^(2p), with W the inverse variances
relative to those of a level edge and D the difference operator. On an even row of columns a wave exp(i k x)
passes with the gain b^2 / (b^2 + q u), u = (sin(k/2) / sin(pi/R))^(2p), where b = exp(-k^2 v/2) is what the
lateral blur leaves of it: one for wavelengths above 1.3 R, 1/(1 + 1/4) at the resolution R by the choice of
q, nothing below 0.8 R. Where columns are known better than 0.1 px, q falls with their error to the power
3/2: the better the image, the less is lost at R.
"""

from __future__ import annotations

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Floats

ORDER = 8  # p
_LOSS = 0.25  # q / b^2 at the resolution
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
) -> tuple[Floats, Floats]:
    """Best surface through the columns' rows, and the Cholesky factor of its normal equations.

    Args:
        rows: the columns' estimates [px], NaN where there is none, first and last not NaN, shape [n].
        sigma: their standard uncertainties [px], shape [n].
        level_sigma: what a level edge's would be [px].
        slope: of the surface, for straight lines beyond its ends, shape [n].
        local: lateral blur per column, shape [n, 2 reach + 1].
        stiffness: from ``penalty``.

    Returns:
        rows of the surface [px], with ``reach`` columns more on both sides; the factor for ``uncertainty``.
    """
    n, width = local.shape
    reach = width // 2
    band = max(2 * reach, ORDER)
    matrix = np.zeros((n + 2 * reach, band + 1))  # matrix[i, k] = M[i, i - k]
    right = np.zeros(n + 2 * reach)
    filled = _filled(rows)
    for i in range(n):
        weight = (level_sigma / sigma[i]) ** 2 if np.isfinite(rows[i]) else _FILL
        for j in range(width):
            wb = weight * local[i, j]
            right[i + j] += wb * filled[i]
            for k in range(j + 1):
                matrix[i + j, j - k] += wb * local[i, k]
    for i in range(reach):
        matrix[i, 0] += _FILL
        right[i] += _FILL * (filled[0] - slope[0] * (reach - i))
        matrix[n + reach + i, 0] += _FILL
        right[n + reach + i] += _FILL * (filled[n - 1] + slope[n - 1] * (i + 1))
    _add_penalty(matrix, stiffness * min(1.0, level_sigma / _USUAL_SIGMA) ** 1.5)
    _factorise(matrix)
    return _solve(matrix, right), matrix


@allocating
def uncertainty(factor: Floats, level_sigma: float) -> Floats:
    """Standard uncertainty of a surface, from the diagonal of the inverse of its normal equations' matrix.

    Takahashi's recurrence within the band: inverse[i, k] = Z[i, i + k], and for j >= i
    Z[i, j] = delta_ij / L_ii^2 - sum_(m > i) L_mi Z[m, j] / L_ii.
    """
    n, width = factor.shape
    inverse = np.zeros((n, width))
    for i in range(n - 1, -1, -1):
        reach = min(width - 1, n - 1 - i)
        pivot = factor[i, 0]
        for k in range(reach, -1, -1):
            total = 1.0 / pivot if k == 0 else 0.0
            for m in range(1, k + 1):
                total -= factor[i + m, m] * inverse[i + m, k - m]
            for m in range(k + 1, reach + 1):
                total -= factor[i + m, m] * inverse[i + k, m - k]
            inverse[i, k] = total / pivot
    return level_sigma * np.sqrt(inverse[:, 0])


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
def _add_penalty(matrix: Floats, stiffness: float) -> None:
    """Add stiffness D'D, D the differences of order ORDER with binomial coefficients."""
    n = matrix.shape[0]
    difference = np.zeros(ORDER + 1)
    difference[0] = 1.0
    for order in range(1, ORDER + 1):
        for k in range(order, 0, -1):
            difference[k] -= difference[k - 1]
    product = stiffness * np.outer(difference, difference)
    for i in range(n - ORDER):
        for j in range(ORDER + 1):
            for k in range(j + 1):
                matrix[i + j, j - k] += product[j, k]


@allocating
def _factorise(matrix: Floats) -> None:
    """Banded Cholesky in place: matrix[i, k] becomes L[i, i - k]."""
    n, width = matrix.shape
    for i in range(n):
        reach = min(i, width - 1)
        for k in range(reach, -1, -1):
            j = i - k
            total = matrix[i, k]
            for m in range(k + 1, min(reach, width - 1 + k) + 1):
                total -= matrix[i, m] * matrix[j, m - k]
            matrix[i, k] = np.sqrt(total) if k == 0 else total / matrix[j, 0]


@allocating
def _solve(factor: Floats, right: Floats) -> Floats:
    n, width = factor.shape
    x = right.copy()
    for i in range(n):
        for k in range(1, min(i, width - 1) + 1):
            x[i] -= factor[i, k] * x[i - k]
        x[i] /= factor[i, 0]
    for i in range(n - 1, -1, -1):
        x[i] /= factor[i, 0]
        for k in range(1, min(i, width - 1) + 1):
            x[i - k] -= factor[i, k] * x[i]
    return x
