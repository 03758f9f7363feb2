"""The struck end of the sample and the face of the striker in one frame.

Both are steps along the row. A strip deep in the body shows them roughly, and whether the striker touches: one step
(striker, sample) in contact, two (striker, gap, sample) apart. Then one step is fitted to each of four strips close
below the surface's corner, whatever stands beside the sample there; they tell how the end is inclined, so that it
can be followed up to the surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.appearance import STRIP_ROWS, Appearance
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.steps import Steps, fit_steps
from wrinklewave.imaging.strips import Greys, strip_shares

_STRIPS = 4  # depths
_FACE_ROWS = 64  # of all strips together
_RUN = 3  # columns unlike the sample that end it
_END_BLURS = 2.0  # left of the end, over which it passes through the striker's grey by itself
_REACH = 4.0  # blurs that a step reaches to either side
_MARGIN = 4  # columns more that are fitted
_LEVEL_COLUMNS = 10  # columns that tell the level beside a step
_NO_PLATE = 0.15  # shares of the contrast by which a plate differs from the background
_GAP_CERTAIN = 16.0  # gain in chi squared from which a gap is believed: four standard deviations


class StruckEnd(NamedTuple):
    """Struck end and striker in a frame [px]; NaN where not seen.

    Attributes:
        column, sigma: the struck end in the middle of the strips below the corner, and its standard uncertainty.
        row: middle of the strips.
        corner_row: where the surface ends, roughly.
        slope, slope_sigma: columns per row of the end's face, and its standard uncertainty.
        striker, striker_sigma: the striker's face, and its standard uncertainty.
        contact: 1 if the striker touches, 0 if not, NaN if no striker is in sight.
    """

    column: float
    sigma: float
    row: float
    corner_row: float
    slope: float
    slope_sigma: float
    striker: float
    striker_sigma: float
    contact: float


class _Faces(NamedTuple):
    """Struck end and striker's face in the deep strip, with their standard uncertainties; NaN where not seen."""

    end: float
    end_sigma: float
    striker: float
    striker_sigma: float
    contact: float


class _View(NamedTuple):
    """What the kernels have to know of a recording: ``striker`` is NaN if there is none."""

    blur: float
    striker: float
    clearance: float
    last: int
    contrast_to_noise: float


def find_struck_end(image: Pixels, coarse: Floats, appearance: Appearance) -> StruckEnd:
    """Find the struck end, and the striker where there is one.

    Args:
        image: grey values, shape [n_rows, n_columns].
        coarse: row of the surface in every column to about a pixel, shape [n_columns].
        appearance: of the recording.
    """
    view = _View(
        blur=appearance.optics.blur,
        striker=np.nan if appearance.striker is None else appearance.striker,
        clearance=appearance.clearance,
        last=int(min(appearance.held_end - appearance.clearance, image.shape[1] - 1)),
        contrast_to_noise=appearance.contrast_to_noise,
    )
    return StruckEnd(*_find(image, coarse, appearance.greys, appearance.strip_depth, view))


@allocating
def _find(image: Pixels, coarse: Floats, greys: Greys, strip_depth: float, view: _View) -> Floats:
    """Fields of ``StruckEnd``."""
    found = np.full(9, np.nan)
    n_columns = image.shape[1]
    top = greys.row + strip_depth + greys.slope * np.arange(n_columns)
    body = strip_shares(image, top, STRIP_ROWS, greys)
    rough = _rough_end(body, view)
    if not np.isfinite(rough):
        return found
    faces = _faces(body, 1.0 / view.contrast_to_noise / np.sqrt(STRIP_ROWS), rough, view)
    beside = coarse[int(rough) + 2 : int(rough + _REACH * view.blur) + 2 * _LEVEL_COLUMNS + 2]
    if beside.size == 0 or not np.isfinite(faces.end):
        return found
    uppermost = beside.max() + 3.5 * view.blur + 2.0
    n_rows = min(_FACE_ROWS, int(image.shape[0] - uppermost)) // _STRIPS
    if n_rows < 1:
        return found
    sigma = 1.0 / view.contrast_to_noise / np.sqrt(n_rows)
    rows, columns, sigmas = np.empty(_STRIPS), np.empty(_STRIPS), np.empty(_STRIPS)
    for k in range(_STRIPS):
        strip = strip_shares(image, np.full(n_columns, uppermost + k * n_rows), n_rows, greys)
        rows[k] = uppermost + n_rows * (k + 0.5) - 0.5
        columns[k], sigmas[k] = _end_in_strip(strip, sigma, faces, view)
    column, column_sigma, slope, slope_sigma = _line(rows, columns, sigmas)
    found[0], found[1], found[2], found[3] = column, column_sigma, rows.mean(), beside[0]
    found[4], found[5] = slope, slope_sigma
    touches = faces.contact == 1.0
    found[6] = column if touches else faces.striker
    found[7] = column_sigma if touches else faces.striker_sigma
    found[8] = faces.contact
    return found


@allocating
def _rough_end(body: Floats, view: _View) -> float:
    """Column of the struck end to a pixel or two in the strip of the body; NaN if it is out of sight."""
    limit = 0.5
    if np.isfinite(view.striker):
        limit = 0.5 * min(1.0, abs(1.0 - view.striker))
    return _last_run(~(np.abs(body[: view.last + 1] - 1.0) < limit))


@allocating
def _faces(body: Floats, sigma: float, rough: float, view: _View) -> _Faces:
    """Struck end and striker in the strip of the body, whose columns have the noise ``sigma``."""
    reach = _REACH * view.blur
    face = _rough_face(body, rough - _END_BLURS * view.blur, view.striker)
    if not face > view.clearance:
        end, end_sigma = _step(body, rough, view.blur, sigma)
        return _Faces(end, end_sigma, np.nan, np.nan, np.nan)
    if rough - face > 2.0 * reach + 2 * _LEVEL_COLUMNS:
        end, end_sigma = _step(body, rough, view.blur, sigma)
        front, front_sigma = _step(body, face, view.blur, sigma)
        return _Faces(end, end_sigma, front, front_sigma, 0.0)
    plate, sample = _level_left(body, face - reach), _level_right(body, rough + reach)
    first, window = _window(body, face, rough, view.blur)
    heights = np.array([-plate, sample])
    touching = fit_steps(window, first, np.array([rough]), np.array([sample - plate]), plate, view.blur)
    apart = fit_steps(window, first, np.array([min(face, rough - 1.0), rough]), heights, plate, view.blur)
    gap = apart.positions[1] - apart.positions[0]
    if not (gap > 0.0 and touching.misfit - apart.misfit > _GAP_CERTAIN * sigma**2):
        end, end_sigma = _certain(touching, 0, sample - plate, sigma)
        return _Faces(end, end_sigma, end, end_sigma, 1.0)
    return _Faces(
        apart.positions[1],
        sigma * np.sqrt(apart.covariance[1, 1]),
        apart.positions[0],
        sigma * np.sqrt(apart.covariance[0, 0]),
        0.0,
    )


@allocating
def _end_in_strip(body: Floats, sigma: float, faces: _Faces, view: _View) -> tuple[float, float]:
    """Struck end in a strip near the corner: the last step before the sample."""
    reach = _REACH * view.blur
    plate = _level_left(body, faces.striker - reach) if faces.contact == 0.0 else 0.0
    if abs(plate) < _NO_PLATE or faces.end - faces.striker > 2.0 * reach + 2 * _LEVEL_COLUMNS:
        return _step(body, faces.end, view.blur, sigma)
    first, window = _window(body, faces.striker, faces.end, view.blur)
    heights = np.array([-plate, _level_right(body, faces.end + reach)])
    apart = fit_steps(window, first, np.array([faces.striker, faces.end]), heights, plate, view.blur)
    return _certain(apart, 1, heights[1], sigma)


@allocating
def _line(rows: Floats, columns: Floats, sigmas: Floats) -> tuple[float, float, float, float]:
    """Column in the middle of the rows and slope of the line through the strips, with standard uncertainties."""
    s0, s1, s2, c0, c1, n = 0.0, 0.0, 0.0, 0.0, 0.0, 0
    middle = rows.mean()
    for k in range(rows.size):
        if np.isfinite(columns[k]) and np.isfinite(sigmas[k]):
            weight, away = 1.0 / sigmas[k] ** 2, rows[k] - middle
            s0 += weight
            s1 += weight * away
            s2 += weight * away * away
            c0 += weight * columns[k]
            c1 += weight * away * columns[k]
            n += 1
    if n < 2:
        return np.nan, np.nan, np.nan, np.nan
    determinant = s0 * s2 - s1 * s1
    column, slope = (s2 * c0 - s1 * c1) / determinant, (s0 * c1 - s1 * c0) / determinant
    return column, np.sqrt(s2 / determinant), slope, np.sqrt(s0 / determinant)


@allocating
def _step(body: Floats, column: float, blur: float, sigma: float) -> tuple[float, float]:
    """One step near ``column`` between the levels beside it, and its standard uncertainty."""
    left, right = _level_left(body, column - _REACH * blur), _level_right(body, column + _REACH * blur)
    first, window = _window(body, column, column, blur)
    fit = fit_steps(window, first, np.array([column]), np.array([right - left]), left, blur)
    return _certain(fit, 0, right - left, sigma)


@allocating
def _certain(fit: Steps, k: int, height: float, sigma: float) -> tuple[float, float]:
    """Position k and its standard uncertainty, that of the levels beside the step included.

    A level that is off by d moves a step of sensitivities t by d/2 / (h sum t^2), where sum t^2 = 1/(h^2 C_kk).
    """
    variance = fit.covariance[k, k]
    levels = 0.25 * (1.0 / _LEVEL_COLUMNS + 0.5 / _LEVEL_COLUMNS) * height**2 * variance
    return fit.positions[k], sigma * np.sqrt(variance * (1.0 + levels))


@allocating
def _window(body: Floats, left: float, right: float, blur: float) -> tuple[int, Floats]:
    """Columns around one or two steps: the first, and the body there, cut at the image."""
    reach = _REACH * blur + _MARGIN
    first, last = max(int(left - reach), 0), min(int(right + reach) + 1, body.size)
    return first, body[first:last]


@allocating
def _level_left(body: Floats, column: float) -> float:
    """Mean of the columns that end at ``column``."""
    stop = min(max(int(np.rint(column)), 0), body.size - 1) + 1
    return body[max(stop - _LEVEL_COLUMNS, 0) : stop].mean()


@allocating
def _level_right(body: Floats, column: float) -> float:
    """Mean of twice as many columns, from ``column`` on."""
    start = min(max(int(np.rint(column)), 0), body.size - 1)
    return body[start : min(start + 2 * _LEVEL_COLUMNS, body.size)].mean()


@allocating
def _rough_face(body: Floats, end: float, striker: float) -> float:
    """Column of the striker's face, seen from ``end`` to the left; NaN if it is out of sight."""
    if not np.isfinite(striker):
        return np.nan
    left = body[: max(int(end), 0)]
    return _last_run(np.abs(left - striker) < np.abs(left))


@allocating
def _last_run(marked: Flags) -> float:
    """Where the last ``_RUN`` marked columns in a row end; NaN if there are none."""
    length = 0
    for c in range(marked.size - 1, -1, -1):
        length = length + 1 if marked[c] else 0
        if length == _RUN:
            return c + _RUN - 0.5
    return np.nan
