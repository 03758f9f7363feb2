"""The struck end of the sample and the face of the striker in one frame.

Both are steps along the row. A strip deep in the body shows them roughly, and whether the striker touches: one step
(striker, sample) in contact, two (striker, gap, sample) apart. Then one step is fitted to each of four strips close
below the surface's corner, whatever stands beside the sample there; they tell how the end is inclined, so that it
can be followed up to the surface.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave.imaging.appearance import STRIP_ROWS, Appearance
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.steps import Steps, fit_steps

_STRIPS = 4  # depths
_FACE_ROWS = 64  # of all strips together
_RUN = 3  # columns unlike the sample that end it
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


NOT_SEEN = StruckEnd(*[float("nan")] * len(StruckEnd._fields))


class _Faces(NamedTuple):
    """Struck end and striker's face in the deep strip, with their standard uncertainties."""

    end: float
    end_sigma: float
    striker: float = float("nan")
    striker_sigma: float = float("nan")
    contact: float = float("nan")


def find_struck_end(image: Pixels, coarse: Floats, appearance: Appearance) -> StruckEnd:
    """Find the struck end, and the striker where there is one.

    Args:
        image: grey values, shape [n_rows, n_columns].
        coarse: row of the surface in every column to about a pixel, shape [n_columns].
        appearance: of the recording.
    """
    body = appearance.body(image)
    rough = rough_struck_end(body, appearance)
    if not np.isfinite(rough):
        return NOT_SEEN
    faces = _faces(body, 1.0 / appearance.contrast_to_noise / np.sqrt(STRIP_ROWS), rough, appearance)
    beside = coarse[int(rough) + 2 : int(rough + _REACH * appearance.optics.blur) + 2 * _LEVEL_COLUMNS + 2]
    if beside.size == 0 or not np.isfinite(faces.end):
        return NOT_SEEN
    top = float(beside.max()) + 3.5 * appearance.optics.blur + 2.0
    n_rows = min(_FACE_ROWS, int(image.shape[0] - top)) // _STRIPS
    if n_rows < 1:
        return NOT_SEEN
    sigma = 1.0 / appearance.contrast_to_noise / np.sqrt(n_rows)
    rows = (top + n_rows * (np.arange(_STRIPS) + 0.5) - 0.5).astype(np.float64)
    ends = np.array(
        [
            _end_in_strip(
                appearance.strip(image, np.full(coarse.size, top + k * n_rows), n_rows),
                sigma,
                faces,
                appearance,
            )
            for k in range(_STRIPS)
        ]
    )
    column, column_sigma, slope, slope_sigma = _line(rows, ends[:, 0], ends[:, 1])
    touches = faces.contact == 1.0
    return StruckEnd(
        column=column,
        sigma=column_sigma,
        row=float(rows.mean()),
        corner_row=float(beside[0]),
        slope=slope,
        slope_sigma=slope_sigma,
        striker=column if touches else faces.striker,
        striker_sigma=column_sigma if touches else faces.striker_sigma,
        contact=faces.contact,
    )


def rough_struck_end(body: Floats, appearance: Appearance) -> float:
    """Column of the struck end to a pixel or two in the strip of the body; NaN if it is out of sight."""
    last = int(min(appearance.held_end - appearance.clearance, body.size - 1))
    limit = 0.5 if appearance.striker is None else 0.5 * min(1.0, abs(1.0 - appearance.striker))
    run = _runs(~(np.abs(body[: last + 1] - 1.0) < limit))
    return float(run[-1] + _RUN - 0.5) if run.size else float("nan")


def _faces(body: Floats, sigma: float, rough: float, appearance: Appearance) -> _Faces:
    """Struck end and striker in the strip of the body, whose columns have the noise ``sigma``."""
    blur, striker = appearance.optics.blur, appearance.striker
    reach = _REACH * blur
    face = float("nan") if striker is None else _rough_face(body, rough, striker)
    if not face > appearance.clearance:
        return _Faces(*_step(body, rough, blur, sigma))
    if rough - face > 2.0 * reach + 2 * _LEVEL_COLUMNS:
        end, front = _step(body, rough, blur, sigma), _step(body, face, blur, sigma)
        return _Faces(*end, *front, 0.0)
    plate, sample = _level(body, face - reach, -1), _level(body, rough + reach, +2)
    first, window = _window(body, face, rough, blur)
    start = np.array([min(face, rough - 1.0), rough])
    touching = fit_steps(window, first, np.array([rough]), np.array([sample - plate]), plate, blur)
    apart = fit_steps(window, first, start, np.array([-plate, sample]), plate, blur)
    gap = apart.positions[1] - apart.positions[0]
    if not (gap > 0.0 and touching.misfit - apart.misfit > _GAP_CERTAIN * sigma**2):
        end = _certain(touching, 0, sample - plate, sigma)
        return _Faces(*end, *end, 1.0)
    sigmas = sigma * np.sqrt(np.diag(apart.covariance))
    return _Faces(
        float(apart.positions[1]), float(sigmas[1]), float(apart.positions[0]), float(sigmas[0]), 0.0
    )


def _end_in_strip(body: Floats, sigma: float, faces: _Faces, appearance: Appearance) -> tuple[float, float]:
    """Struck end in a strip near the corner: the last step before the sample."""
    blur = appearance.optics.blur
    reach = _REACH * blur
    plate = _level(body, faces.striker - reach, -1) if faces.contact == 0.0 else 0.0
    if abs(plate) < _NO_PLATE or faces.end - faces.striker > 2.0 * reach + 2 * _LEVEL_COLUMNS:
        return _step(body, faces.end, blur, sigma)
    first, window = _window(body, faces.striker, faces.end, blur)
    heights = np.array([-plate, _level(body, faces.end + reach, +2)])
    apart = fit_steps(window, first, np.array([faces.striker, faces.end]), heights, plate, blur)
    return _certain(apart, 1, float(heights[1]), sigma)


def _line(rows: Floats, columns: Floats, sigmas: Floats) -> tuple[float, float, float, float]:
    """Column in the middle of the rows and slope of the line through the strips, with standard uncertainties."""
    known = np.isfinite(columns) & np.isfinite(sigmas)
    if known.sum() < 2:
        return float("nan"), float("nan"), float("nan"), float("nan")
    weight = 1.0 / sigmas[known] ** 2
    away = rows[known] - rows.mean()
    normal = np.array([[weight.sum(), weight @ away], [weight @ away, weight @ away**2]])
    covariance = np.linalg.inv(normal)
    column, slope = covariance @ np.array([weight @ columns[known], weight @ (away * columns[known])])
    return float(column), float(np.sqrt(covariance[0, 0])), float(slope), float(np.sqrt(covariance[1, 1]))


def _step(body: Floats, column: float, blur: float, sigma: float) -> tuple[float, float]:
    """One step near ``column`` between the levels beside it, and its standard uncertainty."""
    left, right = _level(body, column - _REACH * blur, -1), _level(body, column + _REACH * blur, +2)
    first, window = _window(body, column, column, blur)
    fit = fit_steps(window, first, np.array([column]), np.array([right - left]), left, blur)
    return _certain(fit, 0, right - left, sigma)


def _certain(fit: Steps, k: int, height: float, sigma: float) -> tuple[float, float]:
    """Position k and its standard uncertainty, that of the levels beside the step included.

    A level that is off by d moves a step of sensitivities t by d/2 / (h sum t^2), where sum t^2 = 1/(h^2 C_kk).
    """
    variance = fit.covariance[k, k]
    levels = 0.25 * (1.0 / _LEVEL_COLUMNS + 0.5 / _LEVEL_COLUMNS) * height**2 * variance
    return float(fit.positions[k]), float(sigma * np.sqrt(variance * (1.0 + levels)))


def _window(body: Floats, left: float, right: float, blur: float) -> tuple[int, Floats]:
    """Columns around one or two steps: the first, and the body there, cut at the image."""
    reach = _REACH * blur + _MARGIN
    first, last = max(int(left - reach), 0), min(int(right + reach) + 1, body.size)
    return first, body[first:last]


def _level(body: Floats, column: float, direction: int) -> float:
    """Mean of columns from ``column`` on to the left (-1) or, twice as many, to the right (+2)."""
    start = int(np.clip(round(column), 0, body.size - 1))
    stop = int(np.clip(start + direction * _LEVEL_COLUMNS, 0, body.size))
    part = body[start:stop] if direction > 0 else body[stop : start + 1]
    return float(np.mean(part)) if part.size else float(body[start])


def _rough_face(body: Floats, end: float, striker: float) -> float:
    """Column of the striker's face, seen from the struck end to the left; NaN if it is out of sight."""
    left = body[: max(int(end), 0)]
    run = _runs(np.abs(left - striker) < np.abs(left))
    return float(run[-1] + _RUN - 0.5) if run.size else float("nan")


def _runs(marked: Flags) -> Floats:
    """Where ``_RUN`` marked columns in a row begin."""
    if marked.size < _RUN:
        return np.zeros(0)
    return np.flatnonzero(np.convolve(marked, np.ones(_RUN), mode="valid") == _RUN).astype(np.float64)
