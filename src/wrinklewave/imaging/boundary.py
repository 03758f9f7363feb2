"""The struck end of the sample and the face of the striker in one frame.

A strip deep in the body shows both roughly. Then both are fitted together, as straight faces across four strips close
below the surface's corner, once with a gap between them and once without: a frame by itself does not always tell
which is the case. Where the gap is wide, or the sample's corner has risen above the striker, the end is seen alone in
these strips, and the striker in the deep one. A striker as bright as the sample hides the end while they touch: then
both are found by the step between their upper edges, as long as one of them is higher.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.imaging.appearance import NOT_LIKE, STRIP_ROWS, Appearance
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.faces import END, GAP, SLOPE, SPREAD, Faces, fit_faces, gap_of_square
from wrinklewave.imaging.strips import Greys, strip_shares

_STRIPS = 4  # depths
_FACE_ROWS = 64  # of all strips together
_RUN = 3  # columns unlike the sample that end it
_END_BLURS = 2.0  # left of the end, over which it passes through the striker's grey by itself
_REACH = 4.0  # blurs that a step reaches to either side
_LEVEL_COLUMNS = 14  # columns beyond, that tell the levels
_LEDGE = 4.0  # rows by which the surface leaves the striker's top
_LEAN = 0.02  # columns per row: how much a face may be inclined where that is not seen
_ROUGH = 3.0  # px: standard uncertainty of the surface's coarse row beside the end
_STRAIGHT = 4.0  # blurs: of a wider gap it is seen whether the faces are parallel


class StruckEnd(NamedTuple):
    """Struck end and striker in a frame [px], in the middle of strips; NaN where not seen.

    Attributes:
        column, sigma: the struck end if there is a gap, or no striker in sight, and its standard uncertainty.
        slope, slope_sigma: columns per row of the end's face then, and its standard uncertainty.
        striker, striker_sigma: the striker's face if there is a gap, and its standard uncertainty.
        gap, gap_sigma: between the two, and its standard uncertainty.
        touch, touch_sigma: both faces if there is no gap, and their standard uncertainty.
        touch_slope, touch_slope_sigma: columns per row of the faces then, and its standard uncertainty.
        gain: by how much chi squared is smaller with a gap than without.
        row: middle of the strips.
        striker_row: middle of those that show the striker.
        corner_row, corner_sigma: where the surface ends, and its standard uncertainty.
    """

    column: float
    sigma: float
    slope: float
    slope_sigma: float
    striker: float
    striker_sigma: float
    gap: float
    gap_sigma: float
    touch: float
    touch_sigma: float
    touch_slope: float
    touch_slope_sigma: float
    gain: float
    row: float
    striker_row: float
    corner_row: float
    corner_sigma: float


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


_APART, _STRIKER, _GAP, _TOUCH, _GAIN = 0, 4, 6, 8, 12
_ROW, _STRIKER_ROW, _CORNER_ROW, _CORNER_SIGMA = 13, 14, 15, 16
"""Where in the fields of ``StruckEnd`` something begins: four of the end apart and touching, two of striker and gap."""


@allocating
def _find(image: Pixels, coarse: Floats, greys: Greys, strip_depth: float, view: _View) -> Floats:
    """Fields of ``StruckEnd``."""
    found = np.full(_CORNER_SIGMA + 1, np.nan)
    n_columns = image.shape[1]
    top = greys.row + strip_depth + greys.slope * np.arange(n_columns)
    body = strip_shares(image, top, STRIP_ROWS, greys)
    rough = _rough_end(body, view)
    if not np.isfinite(rough):
        if abs(1.0 - view.striker) < NOT_LIKE:
            _at_corner(image, coarse, body, greys, view, found)
        return found
    face = _rough_face(body, rough - _END_BLURS * view.blur, view.striker)
    in_sight = face > view.clearance
    beside = coarse[int(rough) + 2 : int(rough + _REACH * view.blur) + 2 * _LEVEL_COLUMNS + 2]
    if beside.size == 0:
        return found
    uppermost = beside.max() + 3.5 * view.blur + 2.0
    n_rows = min(_FACE_ROWS, int(image.shape[0] - uppermost)) // _STRIPS
    if n_rows < 1:
        return found
    first, last = _window(face if in_sight else rough, rough, view.blur, n_columns)
    strips, rows = _strips(image, uppermost, n_rows, first, last, greys), n_rows * (np.arange(_STRIPS) - 1.5)
    found[_ROW] = uppermost + 0.5 * (_STRIPS * n_rows - 1)
    found[_STRIKER_ROW] = found[_ROW]
    found[_CORNER_ROW], found[_CORNER_SIGMA] = beside[0], _ROUGH
    noise, reach = 1.0 / view.contrast_to_noise, _REACH * view.blur
    sigma, start = noise / np.sqrt(n_rows), np.array([rough, 0.0, rough - face, 0.0])
    narrow = in_sight and rough - face < 2.0 * reach
    if narrow and _plate_beside(strips[_STRIPS - 1], first, face, view.blur):
        _both(strips, first, rows, start, view.blur, sigma, found)
        return found
    if in_sight:
        deep = body[first:last].copy().reshape((1, last - first))
        _both(deep, first, np.zeros(1), start, view.blur, noise / np.sqrt(STRIP_ROWS), found)
        found[_STRIKER_ROW] = greys.row + greys.slope * rough + strip_depth + 0.5 * (STRIP_ROWS - 1)
    alone = max(first, int(rough - reach) - _LEVEL_COLUMNS)
    if in_sight and not narrow:
        alone = max(alone, int(face + reach))
    strips = np.ascontiguousarray(strips[:, alone - first :])
    _keep(fit_faces(strips, alone, rows, start, _LINE.copy(), view.blur, sigma), _APART, found)
    found[_TOUCH : _TOUCH + 4] = found[_APART : _APART + 4]
    return found


@allocating
def _strips(image: Pixels, top: float, n_rows: int, first: int, last: int, greys: Greys) -> Floats:
    """Shares of some columns in the strips from ``top`` downwards."""
    strips, tops = np.empty((_STRIPS, last - first)), np.full(image.shape[1], np.nan)
    for k in range(_STRIPS):
        tops[first:last] = top + k * n_rows
        strips[k] = strip_shares(image, tops, n_rows, greys)[first:last]
    return strips


_LINE = np.array([1.0, 1.0, 0.0, 0.0])
"""Only END and SLOPE are free."""


@allocating
def _both(
    strips: Floats, first: int, rows: Floats, start: Floats, blur: float, sigma: float, found: Floats
) -> None:
    """End and striker with a gap and without, into the fields of ``StruckEnd``."""
    free = np.ones(4)
    free[GAP], free[SPREAD] = 0.0, 0.0
    free[SLOPE] = 1.0 if rows.size > 1 else 0.0
    without = np.inf
    if start[GAP] < 2.0 * _REACH * blur:
        touch = fit_faces(strips, first, rows, start, free, blur, sigma)
        if np.isfinite(touch.at[END]):
            _keep(touch, _TOUCH, found)
            without = touch.misfit
    free[GAP] = 1.0
    apart = fit_faces(strips, first, rows, start, free, blur, sigma)
    if rows.size > 1 and apart.at[GAP] > _STRAIGHT * blur:
        free[SPREAD] = 1.0
        apart = fit_faces(strips, first, rows, apart.at, free, blur, sigma)
    if np.isfinite(apart.at[END]):
        _keep_gap(apart, found)
        found[_GAIN] = without - apart.misfit
    elif np.isfinite(without):
        found[_GAIN] = 0.0


@allocating
def _keep(fit: Faces, there: int, found: Floats) -> None:
    """The end and its slope, each with its standard uncertainty."""
    found[there], found[there + 1] = fit.at[END], np.sqrt(fit.covariance[END, END])
    found[there + 2], found[there + 3] = fit.at[SLOPE], np.sqrt(fit.covariance[SLOPE, SLOPE])


@allocating
def _keep_gap(fit: Faces, found: Floats) -> None:
    """Both faces and the gap, which is not negative, each with its standard uncertainty."""
    _keep(fit, _APART, found)
    C = fit.covariance
    gap, sigma = gap_of_square(fit.square, 2.0 * fit.at[GAP] * np.sqrt(C[GAP, GAP]))
    by_gap = C[END, GAP] / C[GAP, GAP]  # how the end follows from the gap, all else fitted
    rest = C[END, END] - by_gap * C[END, GAP]
    end = fit.at[END] + by_gap * (gap - fit.at[GAP])
    found[_APART], found[_APART + 1] = end, np.sqrt(rest + (by_gap * sigma) ** 2)
    found[_STRIKER], found[_STRIKER + 1] = end - gap, np.sqrt(rest + ((by_gap - 1.0) * sigma) ** 2)
    found[_GAP], found[_GAP + 1] = gap, sigma


@allocating
def _at_corner(image: Pixels, coarse: Floats, body: Floats, greys: Greys, view: _View, found: Floats) -> None:
    """End and striker where both look alike and hide what is between them, by the step between their upper edges.

    Between the rows of the two edges there is the striker, or the sample, on one side and the background on the other.
    A gap too narrow to be found in the body lets through as much background as it is wide.
    """
    reach = _REACH * view.blur
    top = np.median(coarse[:_LEVEL_COLUMNS])
    ledge = _first_run(np.abs(coarse - top) > _LEDGE)
    beside = coarse[ledge + 2 : ledge + 2 + int(reach) + _LEVEL_COLUMNS]
    first, last = _window(float(ledge), float(ledge), view.blur, image.shape[1])
    if ledge < _LEVEL_COLUMNS or beside.size == 0 or last > view.last:
        return
    striker_is_higher = np.median(beside) > top
    highest = (top if striker_is_higher else beside.max()) + 0.5 + 2.5 * view.blur
    lowest = (beside.min() if striker_is_higher else top) - 0.5 - 2.5 * view.blur
    n_rows = int(lowest) - int(np.ceil(highest)) + 1
    if n_rows < 2:
        return
    noise = 1.0 / view.contrast_to_noise
    tops = np.full(image.shape[1], np.ceil(highest))
    strip = strip_shares(image, tops, n_rows, greys)[first:last].copy().reshape((1, last - first))
    start = np.array([float(ledge), 0.0, 0.0, 0.0])
    only_end = np.array([1.0, 0.0, 0.0, 0.0])
    step = fit_faces(strip, first, np.zeros(1), start, only_end, view.blur, noise / np.sqrt(n_rows))
    if not np.isfinite(step.at[END]):
        return
    gap, gap_sigma = _background_between(body, step.at[END], view.blur, noise / np.sqrt(STRIP_ROWS))
    at, sigma = step.at[END], np.sqrt(step.covariance[END, END])
    seen, other = sigma, np.sqrt(sigma**2 + gap_sigma**2)
    width = max(gap, 0.0)
    found[_APART], found[_APART + 1] = (at + width, other) if striker_is_higher else (at, seen)
    found[_STRIKER], found[_STRIKER + 1] = (at, seen) if striker_is_higher else (at - width, other)
    found[_GAP], found[_GAP + 1] = width, gap_sigma
    found[_TOUCH], found[_TOUCH + 1] = at, seen
    for slope in (_APART + 2, _TOUCH + 2):
        found[slope], found[slope + 1] = 0.0, _LEAN
    found[_GAIN] = (width / gap_sigma) ** 2
    found[_ROW] = found[_STRIKER_ROW] = np.ceil(highest) + 0.5 * (n_rows - 1)
    found[_CORNER_ROW], found[_CORNER_SIGMA] = beside[0], _ROUGH


@allocating
def _background_between(body: Floats, column: float, blur: float, sigma: float) -> tuple[float, float]:
    """Width of a gap between two faces that look alike, by the background that it lets through, and its uncertainty."""
    inner, outer = int(_REACH * blur) + 1, int(_REACH * blur) + 1 + _LEVEL_COLUMNS
    c = int(np.rint(column))
    beside = np.concatenate(
        (body[max(c - outer, 0) : max(c - inner, 0)], body[c + inner + 1 : c + outer + 1])
    )
    middle = body[max(c - inner, 0) : c + inner + 1]
    level = beside.mean()
    return (level - middle).sum() / level, sigma * np.sqrt(middle.size * (1.0 + middle.size / beside.size))


@allocating
def _first_run(marked: Flags) -> int:
    """Where the first ``_RUN`` marked elements in a row begin; 0 if there are none."""
    length = 0
    for c in range(marked.size):
        length = length + 1 if marked[c] else 0
        if length == _RUN:
            return c + 1 - _RUN
    return 0


@allocating
def _plate_beside(strip: Floats, first: int, face: float, blur: float) -> bool:
    """Whether there is a striker left of its face in a strip, not only deeper in the image."""
    stop = max(int(face - first - _REACH * blur), 1)
    return abs(strip[max(stop - _LEVEL_COLUMNS, 0) : stop].mean()) > NOT_LIKE


@allocating
def _window(face: float, end: float, blur: float, n_columns: int) -> tuple[int, int]:
    """First column that is fitted, and one past the last."""
    reach = _REACH * blur + _LEVEL_COLUMNS
    return max(int(face - reach), 0), min(int(end + reach) + 2, n_columns)


@allocating
def _rough_end(body: Floats, view: _View) -> float:
    """Column of the struck end to a pixel or two in the strip of the body; NaN if it is out of sight."""
    limit = 0.5
    if abs(1.0 - view.striker) >= NOT_LIKE:
        limit = 0.5 * min(1.0, abs(1.0 - view.striker))
    return _last_run(~(np.abs(body[: view.last + 1] - 1.0) < limit))


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
