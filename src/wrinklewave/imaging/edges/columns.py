"""The edge in each column by maximum likelihood: the unbiased estimate that reaches the Cramér-Rao bound.

With levels, noise and blur known, the row y of the edge is the only unknown of a column: Gauss-Newton steps
minimise sum_j (I_j - I_above - (I_below - I_above) E(j - y))^2 / sigma_j^2 over a fixed window about the
edge, with E as in ``profile`` and sigma_j^2 between the two sides' in proportion (shot noise makes the
brighter side noisier).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.edges.levels import Levels, with_neighbours
from wrinklewave.imaging.edges.profile import normal_distribution

_REACH = 3.0  # blurs on either side that carry information on the position
_MARGIN = 1.5  # pixels added for the error of the starting row
_MAX_STEPS = 12
_LARGEST_STEP = 1.0  # px
_MISFIT = 0.06  # contrasts: what the model of the profile may miss, beyond noise
_MISFIT_SIGMAS = 5.0  # of the residual's root mean square


@dataclass(frozen=True)
class Columns:
    """The edge column by column, shape [n_columns].

    Attributes:
        rows: row of the edge [px], NaN where no edge of the expected shape was found.
        sigma: its standard uncertainty [px], infinite where there is none.
    """

    rows: Floats
    sigma: Floats

    @property
    def found(self) -> Flags:
        """Where there is an edge."""
        return np.isfinite(self.rows)

    def only(self, kept: Flags) -> Columns:
        """The same without the columns that are not ``kept``."""
        return Columns(np.where(kept, self.rows, np.nan), np.where(kept, self.sigma, np.inf))


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
    rows, sigma = _find(
        image,
        start,
        levels.origin,
        blur,
        levels.value,
        levels.gradient,
        levels.noise,
        levels.contrast,
        levels.blocked,
        usable,
        tolerance,
    )
    return Columns(rows, sigma)


@allocating
def _find(
    image: Pixels,
    start: Floats,
    origin: Floats,
    blur: Floats,
    value: Floats,
    gradient: Floats,
    noise: Floats,
    contrast: float,
    blocked: Flags,
    usable: Flags,
    tolerance: float,
) -> tuple[Floats, Floats]:
    """Rows and standard uncertainties without columns that have another shape, and what the blur mixes with them."""
    rows, sigma, residual, count = _locate(
        image, start, origin, blur, value, gradient, noise, usable, tolerance
    )
    mean_noise = np.sqrt(0.5 * (noise[0] ** 2 + noise[1] ** 2))
    strange = blocked.copy()
    for c in range(rows.size):
        if count[c] > 0:
            expected = mean_noise * (1.0 + _MISFIT_SIGMAS / np.sqrt(2.0 * count[c]))
            strange[c] = strange[c] or residual[c] > expected + _MISFIT * contrast
    strange = with_neighbours(strange, blur)
    for c in range(rows.size):
        if strange[c]:
            rows[c], sigma[c] = np.nan, np.inf
    return rows, sigma


@allocating
def _locate(
    image: Pixels,
    start: Floats,
    origin: Floats,
    blur: Floats,
    value: Floats,
    gradient: Floats,
    noise: Floats,
    usable: Flags,
    tolerance: float,
) -> tuple[Floats, Floats, Floats, NDArray[np.int64]]:
    """Rows and standard uncertainties; root mean square of the residual grey values and number of pixels."""
    n_rows, n_columns = image.shape
    rows = np.full(n_columns, np.nan)
    sigma = np.full(n_columns, np.inf)
    residual = np.full(n_columns, np.inf)
    count = np.zeros(n_columns, np.int64)
    for c in range(n_columns):
        if not usable[c] or not np.isfinite(start[c] + value[0, c] + value[1, c]):
            continue
        reach = _REACH * blur[c] + _MARGIN
        first, last = int(np.floor(start[c] - reach)), int(np.ceil(start[c] + reach))
        if first < 0 or last >= n_rows:
            if start[c] - 1.5 * blur[c] < 0 or start[c] + 1.5 * blur[c] > n_rows - 1:
                continue
            first, last = max(first, 0), min(last, n_rows - 1)
        count[c] = last - first + 1
        row, moved, proposed = start[c], 0.0, 0.0
        for iteration in range(_MAX_STEPS):
            slope, information, squares = _step(
                image, c, first, last, row, origin[c], blur[c], value, gradient, noise
            )
            if iteration == 0:
                residual[c] = np.sqrt(squares / count[c])  # for columns where nothing is found
            if information <= 0.0:
                break
            step = slope / information
            gain = 1.0
            if moved != 0.0 and proposed != step:  # the secant between two proposals, within reason
                gain = min(max(moved / (proposed - step), 0.3), 2.5)
            moved, proposed = min(max(gain * step, -_LARGEST_STEP), _LARGEST_STEP), step
            row += moved
            if abs(row - start[c]) > reach:
                break
            if abs(moved) < tolerance:
                rows[c] = row
                sigma[c] = 1.0 / np.sqrt(information)
                residual[c] = np.sqrt(squares / count[c])
                break
    return rows, sigma, residual, count


@allocating
def _step(
    image: Pixels,
    c: int,
    first: int,
    last: int,
    row: float,
    origin: float,
    blur: float,
    value: Floats,
    gradient: Floats,
    noise: Floats,
) -> tuple[float, float, float]:
    """Sums over the window: t r / s^2, t^2 / s^2 and r^2; sensitivity t = dI/dy, residual r, noise s."""
    above, below = value[0, c], value[1, c]
    slope, information, squares = 0.0, 0.0, 0.0
    per_blur = 1.0 / blur
    lower, lower_integral = normal_distribution((first - 0.5 - row) * per_blur)
    for r in range(first, last + 1):
        upper, upper_integral = normal_distribution((r + 0.5 - row) * per_blur)
        share = blur * (upper_integral - lower_integral)
        dark = above + gradient[0, c] * (r - origin)
        bright = below + gradient[1, c] * (r - origin)
        difference = image[r, c] - dark - (bright - dark) * share
        sensitivity = -(bright - dark) * (upper - lower)
        weight = 1.0 / (noise[0] * noise[0] * (1.0 - share) + noise[1] * noise[1] * share)
        slope += weight * sensitivity * difference
        information += weight * sensitivity * sensitivity
        squares += difference * difference
        lower, lower_integral = upper, upper_integral
    return slope, information, squares
