"""The row in which the surface meets the struck end's face, with its standard uncertainty.

The regularised surface begins where nothing that stands beside the sample is mixed into it any more, three to ten
pixels from the face. From there on a Kalman filter follows the surface to the face column by column. Its model is that
of a cubic smoothing spline, a slope that does a random walk (second differences are white noise, as large as those of
the surface nearby), so that value and uncertainty at the face come out of one model. Columns nearer than a few blurs
to the face still show the surface, as a lower step between levels of their own: the column c sees the mean of the
surface over the part of the lateral blur N(c, v) that lies on the sample, which is its row at

    x = c + sqrt(v) phi(u)/Phi(u),   u = (c - e)/sqrt(v),   v = blur^2 + 1/12,

e the face, where the surface is straight over a blur.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating, strict
from wrinklewave.imaging.appearance import Appearance
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.boundary import StruckEnd
from wrinklewave.imaging.contact import GAP_GAIN
from wrinklewave.imaging.edges import Edge
from wrinklewave.imaging.edges.profile import blurred_step_at, normal_distribution

_FEWEST, _MOST = 6, 12  # columns of the surface from which it is followed
_FARTHEST = 25.0  # px between these and the face
_CURVED = 24  # columns whose second differences count
_LEAST_CURVATURE = 0.02  # per px: that a surface may always have
_CURVATURE_GAIN = 2.0  # of their mean square: they are smoothed, and the nearest may be the largest
_SLOPE_KNOWN = 1.0  # beforehand
_REACH, _MARGIN = 3.0, 1.5  # blurs, and pixels, on either side of the edge in a column
_CLEAR = 3.0  # lateral blurs between the striker's face and the columns that tell what it looks like
_COLUMNS_BESIDE = 6
_NOWHERE = -1e6  # px: of a striker that is not there
_LEVEL_ROWS = 10  # that tell the level on a side
_STEPS = 4
_LARGEST_STEP = 1.5  # px
_CONVERGED = 0.01  # px
_LOWEST_STEP = 0.15  # contrasts
_MISFIT, _MISFIT_NOISE = 0.03, 1.5  # contrasts and noises: largest root mean square of residual grey values
_UNKNOWN = 0.02  # px: what the model of a column may miss


class _State(NamedTuple):
    """What is known of the surface at ``column``: row, columns' slope, and their covariance."""

    column: float
    row: float
    slope: float
    row_row: float
    row_slope: float
    slope_slope: float


def with_corner(end: StruckEnd, image: Pixels, edge: Edge, appearance: Appearance) -> StruckEnd:
    """The struck end with the row of its corner, where the surface is seen near it; else as it is.

    Args:
        end: in a frame.
        image: the frame, shape [n_rows, n_columns].
        edge: its surface.
        appearance: of the recording.
    """
    face, striker = end.column, end.striker
    if end.gain < GAP_GAIN or not np.isfinite(face):
        face = striker = end.touch
    if not np.isfinite(face):
        return end
    optics = appearance.optics
    row, sigma = follow_to_face(
        image,
        edge.rows,
        edge.column_rows,
        edge.column_sigma,
        edge.valid & edge.column_valid,
        face,
        striker if np.isfinite(striker) else _NOWHERE,
        optics.blur,
        edge.contrast if optics.sample_brighter else -edge.contrast,
        edge.noise,
    )
    return end._replace(corner_row=row, corner_sigma=sigma) if np.isfinite(row) else end


@allocating
def follow_to_face(
    image: Pixels,
    rows: Floats,
    own: Floats,
    own_sigma: Floats,
    known: Flags,
    face: float,
    striker: float,
    blur: float,
    contrast: float,
    noise: float,
) -> tuple[float, float]:
    """Row of the surface at the face and its standard uncertainty [px]; NaN where no surface is seen near it.

    Args:
        image: grey values, shape [n_rows, n_columns].
        rows: the regularised surface, shape [n_columns].
        own, own_sigma: the columns' own rows and their standard uncertainties, shape [n_columns].
        known: the columns that show the surface undisturbed, shape [n_columns].
        face: column of the face, left of the surface.
        striker: column of the face of what stands left of it, far outside the image for nothing.
        blur: standard deviation of the optical blur [px].
        contrast: of grey values, sample less background.
        noise: standard deviation of a pixel's grey value.
    """
    first = max(int(np.floor(face)) + 1, 0)
    columns = first + np.flatnonzero(known[first:])[:_MOST]
    if columns.size < _FEWEST or columns[0] - face > _FARTHEST:
        return np.nan, np.nan
    curvature = _mean_square_curvature(rows[columns[0] : columns[0] + _CURVED])
    wander = _LEAST_CURVATURE**2 + _CURVATURE_GAIN * curvature
    c = columns[-1]
    state = _State(float(c), own[c], 0.0, own_sigma[c] ** 2, 0.0, _SLOPE_KNOWN**2)
    for c in columns[-2::-1]:
        state = _seen(_moved(state, float(c), wander), own[c], own_sigma[c] ** 2)
    lateral = np.sqrt(blur**2 + 1.0 / 12.0)
    beside = _beside(image, striker - _CLEAR * lateral)
    for c in range(columns[0] - 1, int(np.ceil(face)) - 1, -1):
        share, integral = normal_distribution((c - face) / lateral)
        there = _moved(state, min(face + lateral * integral / share, state.column), wander)
        of_striker = 1.0 - normal_distribution((c - striker) / lateral)[0]
        seen_blur = np.sqrt(blur**2 * (1.0 + there.slope**2) + there.slope**2 / 12.0)
        first, stop = _window(there.row, seen_blur, image.shape[0])
        if stop == 0:
            break
        greys = image[first:stop, c] - of_striker * beside[first:stop]
        row, variance = _edge_in(greys, there.row - first, seen_blur, contrast, noise)
        if not np.isfinite(row):
            break
        state = _seen(there, first + row, variance)
    state = _moved(state, face, wander)
    return state.row, np.sqrt(state.row_row)


@allocating
def _beside(image: Pixels, stop: float) -> Floats:
    """Grey values down the columns left of ``stop``, shape [n_rows]; zeros if there are none."""
    mean = np.zeros(image.shape[0])
    if not stop >= _COLUMNS_BESIDE:
        return mean
    last = int(stop)
    for r in range(mean.size):
        for c in range(last - _COLUMNS_BESIDE, last):
            mean[r] += image[r, c]
        mean[r] /= _COLUMNS_BESIDE
    return mean


@strict
def _moved(state: _State, column: float, wander: float) -> _State:
    """The state at a column to the left, the slope's variance having grown by ``wander`` per column."""
    d = state.column - column
    return _State(
        column,
        state.row - d * state.slope,
        state.slope,
        state.row_row - 2.0 * d * state.row_slope + d * d * state.slope_slope + wander * d**3 / 3.0,
        state.row_slope - d * state.slope_slope - 0.5 * wander * d * d,
        state.slope_slope + wander * d,
    )


@strict
def _seen(state: _State, row: float, variance: float) -> _State:
    """The state after its row has been seen."""
    total = state.row_row + variance + _UNKNOWN**2
    gain, slope_gain = state.row_row / total, state.row_slope / total
    away = row - state.row
    return _State(
        state.column,
        state.row + gain * away,
        state.slope + slope_gain * away,
        (1.0 - gain) * state.row_row,
        (1.0 - gain) * state.row_slope,
        state.slope_slope - slope_gain * state.row_slope,
    )


@strict
def _mean_square_curvature(rows: Floats) -> float:
    """Of second differences; zero where there are none."""
    total, n = 0.0, 0
    for c in range(1, rows.size - 1):
        bend = rows[c - 1] - 2.0 * rows[c] + rows[c + 1]
        if np.isfinite(bend):
            total += bend * bend
            n += 1
    return total / max(n, 1)


@strict
def _window(row: float, blur: float, n_rows: int) -> tuple[int, int]:
    """First row, and one past the last, of an edge and the levels beside it; zeros if they reach beyond the image."""
    reach = _REACH * blur + _MARGIN
    if not (row - reach >= _LEVEL_ROWS and row + reach < n_rows - _LEVEL_ROWS - 1):
        return 0, 0
    return int(np.floor(row - reach)) - _LEVEL_ROWS, int(np.ceil(row + reach)) + 1 + _LEVEL_ROWS


@allocating
def _edge_in(greys: Floats, start: float, blur: float, contrast: float, noise: float) -> tuple[float, float]:
    """Row of the edge between levels at either end, and its variance; NaN if there is no edge of the usual shape.

    Gauss-Newton steps as in ``edges.columns``. An error of a level moves the row by its share in the profile.
    """
    n = greys.size
    above, below = greys[:_LEVEL_ROWS].mean(), greys[n - _LEVEL_ROWS :].mean()
    step = below - above
    if step * contrast < _LOWEST_STEP * contrast**2:
        return np.nan, np.nan
    at, information, by_above, by_below, squares = start, 0.0, 0.0, 0.0, 0.0
    for _ in range(_STEPS):
        information, by_above, by_below, squares, pull = 0.0, 0.0, 0.0, 0.0, 0.0
        for r in range(_LEVEL_ROWS, n - _LEVEL_ROWS):
            share, density = blurred_step_at(r - at, blur)
            away = (greys[r] - above) / step - share
            information += density * density
            by_above += (1.0 - share) * density
            by_below += share * density
            pull += away * density
            squares += away * away
        move = -pull / information
        at += min(max(move, -_LARGEST_STEP), _LARGEST_STEP)
        if abs(move) < _CONVERGED:
            break
    misfit = np.sqrt(squares / (n - 2 * _LEVEL_ROWS)) * abs(step)
    if abs(at - start) > _REACH * blur or misfit > _MISFIT * abs(contrast) + _MISFIT_NOISE * noise:
        return np.nan, np.nan
    levels = (by_above**2 + by_below**2) / (information**2 * _LEVEL_ROWS)
    return at, (noise / step) ** 2 * (1.0 / information + levels)
