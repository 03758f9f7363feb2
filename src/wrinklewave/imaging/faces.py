"""The sample's end and the striker's face along a few strips, by maximum likelihood: one model for all frames.

Along a row stand the striker (level P), the background that shows through the gap (B), and the sample (S):

    I(x) = P [1 - E(x - s)] + B [E(x - s) - E(x - e)] + S E(x - e),

E a blurred, pixel-integrated unit step, s and e the places of the two faces. Faces are straight over the strips:
e = c + m (r - r_0) and s = e - g - n (r - r_0) in the row r. The levels are fitted in every strip; B is known to be
that of the background.

While a gap is narrower than the blur, the image changes with its square only,

    dI = -g^2/2 (P - B)(S - B)/(S - P) E''(x - u),

about the place u where a single step would be seen. So u and g^2 are what a frame tells, each with a Gaussian
uncertainty, g^2 negative as often as not where the gap is closed; and what is not known of the blur looks the same.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.arrays import Flags, Floats
from wrinklewave.imaging.edges.profile import normal_distribution

END, SLOPE, GAP, SPREAD = 0, 1, 2, 3
"""Parameters: c [px], m [columns per row], g [px], n [columns per row]."""

_BLUR = 4  # one more: how much larger the variance of the blur is than it is taken for [px^2]
_N = 5
_BLUR_KNOWN = 0.08  # of its variance: 4 % of the blur, or a pixel of motion at 1.2 px
_BACKGROUND_KNOWN = 0.02  # contrasts
_LEAST_GAP = 0.25  # blurs: below, the image is taken to be linear in the square of the gap
_MAX_STEPS = 40
_LARGEST_STEP = 1.0  # px
_LARGEST_SLOPE = 0.5  # columns per row
_CONVERGED = 1e-4  # px
_NOTHING = 1e-9  # of a column: what keeps a level finite that no column shows
_DENSITY = 1.0 / np.sqrt(2.0 * np.pi)
_POINTS = 48  # of the quadrature over a gap
_TAILS = 5.0  # standard deviations of the square of a gap


class Faces(NamedTuple):
    """Faces fitted to strips.

    Attributes:
        at: the parameters END, SLOPE, GAP, SPREAD; NaN if the fit failed. Those that were not free are zero.
        covariance: of them, shape [4, 4].
        misfit: sum of squared residuals over the variance of the noise.
        square: of the gap [px^2]; negative where one that is narrower than nothing would fit better.
    """

    at: Floats
    covariance: Floats
    misfit: float
    square: float


@allocating
def fit_faces(
    profiles: Floats,
    first: int,
    rows: Floats,
    start: Floats,
    free: Floats,
    blur: float,
    sigma: float,
) -> Faces:
    """Fit the end, or end and striker.

    Args:
        profiles: shares of consecutive columns, shape [n_strips, n_columns].
        first: column of the first of them.
        rows: of the strips, counted from the row for which END and GAP are given, shape [n_strips].
        start: END, SLOPE, GAP, SPREAD to begin with.
        free: 1 for the parameters that are fitted, 0 for the others, shape [4]. Without GAP there is one step, from
            whatever is on the left to the sample.
        blur: standard deviation of the optical blur [px].
        sigma: standard deviation of the noise of a column.
    """
    apart = free[GAP] > 0.0
    least = _LEAST_GAP * blur if apart else 0.0
    at, ready = np.zeros(_N), False
    at[:4] = start
    at[GAP] = max(at[GAP], least)
    is_free = np.ones(_N, np.bool_)
    is_free[:4] = free > 0.0
    if not apart:
        is_free[GAP], is_free[SPREAD] = False, False
    step, covariance = np.zeros(_N), np.zeros((_N, _N))
    misfit = np.inf
    for _ in range(_MAX_STEPS):
        normal, gradient, misfit = _linearised(profiles, first, rows, at, apart, blur, sigma)
        covariance = _inverse(normal, is_free)
        step = covariance @ gradient
        if not np.isfinite(step).all():
            break
        move = step.copy()
        if apart:
            move[GAP] = _next_gap(at[GAP], step[GAP], blur) - at[GAP]
        if apart and at[GAP] + move[GAP] < least:
            held = is_free.copy()
            held[GAP] = False
            move = _inverse(normal, held) @ gradient
            move[GAP] = least - at[GAP]
        share = min(1.0, _LARGEST_STEP / max(abs(move[END]), abs(move[GAP]), 1e-12))
        at += share * move
        if (
            max(np.abs(at[SLOPE]), np.abs(at[SPREAD])) > _LARGEST_SLOPE
            or abs(at[END] - start[END]) > profiles.shape[1]
        ):
            break
        furthest = np.abs(rows).max()
        shift = max(abs(move[END]), abs(move[GAP]), furthest * abs(move[SLOPE]), furthest * abs(move[SPREAD]))
        if shift < _CONVERGED:
            ready = True
            break
    square = at[GAP] ** 2 + 2.0 * at[GAP] * step[GAP]
    found, spread = at[:4].copy(), covariance[:4, :4].copy()
    if not ready:
        found[:] = np.nan
        spread[:] = np.inf
    return Faces(found, spread, misfit, square)


@allocating
def _next_gap(gap: float, step: float, blur: float) -> float:
    """Newton's step for the gap, for its square where it is narrow."""
    return gap + step if gap > blur else np.sqrt(max(gap**2 + 2.0 * gap * step, 0.0))


@allocating
def _linearised(
    profiles: Floats, first: int, rows: Floats, at: Floats, apart: bool, blur: float, sigma: float
) -> tuple[Floats, Floats, float]:
    """Normal matrix and gradient of the parameters, the levels of every strip eliminated, and the misfit."""
    n = profiles.shape[1]
    normal, gradient = np.zeros((_N, _N)), np.zeros(_N)
    normal[_BLUR, _BLUR] = 1.0 / (_BLUR_KNOWN * blur**2) ** 2
    gradient[_BLUR] = -normal[_BLUR, _BLUR] * at[_BLUR]
    misfit = normal[_BLUR, _BLUR] * at[_BLUR] ** 2
    seen = np.sqrt(max(blur**2 + at[_BLUR], 0.25 * blur**2))
    face, end = np.zeros((n, 3)), np.zeros((n, 3))
    shapes, terms = np.empty(3), np.empty(_N)
    squares, products = np.empty((3, 3)), np.empty(3)
    own, mixed, pull = np.empty((_N, _N)), np.empty((_N, 3)), np.empty(_N)
    for k in range(rows.size):
        column = at[END] + at[SLOPE] * rows[k]
        _step(first, column, seen, end)
        if apart:
            _step(first, column - at[GAP] - at[SPREAD] * rows[k], seen, face)
        squares[:], products[:] = 0.0, 0.0
        for i in range(n):
            shapes[2] = end[i, 0]
            shapes[1] = face[i, 0] - end[i, 0] if apart else 0.0
            shapes[0] = 1.0 - shapes[1] - shapes[2]
            for a in range(3):
                products[a] += shapes[a] * profiles[k, i]
                for b in range(a + 1):
                    squares[a, b] += shapes[a] * shapes[b]
        known = (sigma / _BACKGROUND_KNOWN) ** 2
        squares[1, 1] += known
        inverse = _inverse(_symmetric(squares, _NOTHING), np.ones(3, np.bool_))
        levels = inverse @ products
        at_face, at_end = levels[1] - levels[0], levels[2] - levels[1]
        own[:], mixed[:], pull[:] = 0.0, 0.0, 0.0
        squared = 0.0
        for i in range(n):
            shapes[2] = end[i, 0]
            shapes[1] = face[i, 0] - end[i, 0] if apart else 0.0
            shapes[0] = 1.0 - shapes[1] - shapes[2]
            near = face[i] if apart else end[i]
            residual = profiles[k, i] - levels[0] * shapes[0] - levels[1] * shapes[1] - levels[2] * shapes[2]
            squared += residual * residual
            terms[GAP] = at_face * near[1]
            terms[END] = -terms[GAP] - at_end * end[i, 1]
            terms[SLOPE], terms[SPREAD] = rows[k] * terms[END], rows[k] * terms[GAP]
            terms[_BLUR] = at_face * near[2] + at_end * end[i, 2]
            for a in range(_N):
                pull[a] += terms[a] * residual
                for b in range(a + 1):
                    own[a, b] += terms[a] * terms[b]
                for b in range(3):
                    mixed[a, b] += terms[a] * shapes[b]
        misfit += squared / sigma**2 + (levels[1] / _BACKGROUND_KNOWN) ** 2
        normal += (_symmetric(own, 0.0) - mixed @ inverse @ mixed.T) / sigma**2
        gradient += pull / sigma**2
    return normal, gradient, misfit


@allocating
def _symmetric(lower: Floats, more: float) -> Floats:
    """The matrix of which a lower triangle is given, with ``more`` on its diagonal."""
    whole = lower.copy()
    for a in range(lower.shape[0]):
        whole[a, a] += more
        for b in range(a):
            whole[b, a] = lower[a, b]
    return whole


@allocating
def _step(first: int, column: float, blur: float, step: Floats) -> None:
    """A unit step at ``column``: E, its derivative along the row, and that with respect to the blur's variance."""
    t = (first - 0.5 - column) / blur
    lower, lower_integral = normal_distribution(t)
    lower_density = np.exp(-0.5 * t * t)
    for i in range(step.shape[0]):
        t = (first + i + 0.5 - column) / blur
        upper, upper_integral = normal_distribution(t)
        density = np.exp(-0.5 * t * t) if abs(t) < 6.0 else 0.0
        step[i, 0] = blur * (upper_integral - lower_integral)
        step[i, 1] = upper - lower
        step[i, 2] = 0.5 * _DENSITY * (density - lower_density) / blur
        lower, lower_integral, lower_density = upper, upper_integral, density


@allocating
def _inverse(matrix: Floats, free: Flags) -> Floats:
    """Inverse of the rows and columns that are free, by elimination; zero in the others, infinite if there is none."""
    n = free.size
    left, inverse = matrix.copy(), np.zeros((n, n))
    for a in range(n):
        inverse[a, a] = 1.0 if free[a] else 0.0
    for a in range(n):
        if not free[a]:
            continue
        pivot = left[a, a]
        if not pivot > 1e-12 * matrix[a, a]:
            return np.full((n, n), np.inf)
        left[a] /= pivot
        inverse[a] /= pivot
        for b in range(n):
            if free[b] and b != a:
                factor = left[b, a]
                left[b] -= factor * left[a]
                inverse[b] -= factor * inverse[a]
    return inverse


@allocating
def gap_of_square(square: float, sigma: float) -> tuple[float, float]:
    """Mean and standard deviation of a gap g >= 0 whose square is known as ``square`` with a Gaussian ``sigma``.

    Every gap is as likely beforehand. Where the square is well known they are sqrt(square) and sigma/(2 g).
    """
    most = np.sqrt(max(square, 0.0) + _TAILS * sigma)
    least = np.sqrt(max(square - _TAILS * sigma, 0.0))
    top = max(square, 0.0)
    total, first, second = 0.0, 0.0, 0.0
    for i in range(_POINTS):
        g = least + (most - least) * (i + 0.5) / _POINTS
        away, at_top = (g * g - square) / sigma, (top - square) / sigma
        weight = np.exp(-0.5 * (away * away - at_top * at_top))
        total += weight
        first += weight * g
        second += weight * g * g
    mean = first / total
    return mean, np.sqrt(max(second / total - mean * mean, 0.0))
