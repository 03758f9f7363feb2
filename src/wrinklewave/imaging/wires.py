"""Probe wires that stand out of the surface: found in every frame, then joined to tracks of material points.

In a band above the surface a wire is a bar darker (or brighter) than the background. Its place is found by maximum
likelihood for a bar of known width, blurred and pixel-integrated, in two halves of the band, so that a wire that
leans can be followed down to where it leaves the surface.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.errors import InputError
from wrinklewave.imaging.appearance import Appearance
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.bars import Bar, fit_bar
from wrinklewave.imaging.strips import Greys, strip_shares

_HALF = 6  # rows of each half of the band, at most
_FEWEST_ROWS = 4  # of the band
_TOP_CLEARANCE = 3.5  # blurs between the band and the tip of the wire: on a slope the tip is seen askew
_TIP = 0.5  # of its height: where a wire ends
_LEAST_HEIGHT = 0.15  # contrasts: fainter bars are no wires
_SEARCH = 10.0  # px around a given position
_SMALLEST_SPACING = 5  # px between wires
_WIDTHS = (0.5, 12.0)  # px
_BESIDE = 6  # columns on either side that tell the background
_FAINTEST = 0.5  # of the height known from the undeformed frames


@dataclass(frozen=True)
class WireLook:
    """What the wires of a recording have in common.

    Attributes:
        columns: where they are in the undeformed frames [px], shape [n_wires], increasing.
        width: [px].
        height: in contrasts, positive if the wire is on the sample's side of grey.
        half: rows of each half of the band in which they are looked for.
    """

    columns: Floats
    width: float
    height: float
    half: int


class WireSightings(NamedTuple):
    """Wires seen in one frame, shape [n], from left to right, in pixels.

    Attributes:
        column, sigma: middle of the wire in the middle of the band, and its standard uncertainty.
        lean, lean_sigma: columns per row, and its standard uncertainty.
        distance: rows from the middle of the band down to the surface.
    """

    column: Floats
    sigma: Floats
    lean: Floats
    lean_sigma: Floats
    distance: float


def learn_wires(
    image: Pixels, appearance: Appearance, *, count: int | None = None, positions: Floats | None = None
) -> WireLook:
    """Find the wires in the mean of the undeformed frames.

    Args:
        image: mean of the undeformed frames, shape [n_rows, n_columns].
        appearance: of the recording.
        count: how many to find, or
        positions: columns where they are, to within a few pixels, shape [n_wires].

    Raises:
        InputError: if there are fewer than asked for.
    """
    rows = bridged(appearance.surface)
    band = _band(image, rows, appearance, above=2 * _HALF, n_rows=2 * _HALF)
    smooth = np.abs(_smooth(band))
    peaks = _peaks(smooth, _LEAST_HEIGHT)
    if positions is None:
        assert count is not None
        chosen = np.sort(peaks[np.argsort(-smooth[peaks.astype(int)])[:count]])
        if chosen.size < count:
            raise InputError(
                f"{chosen.size} wires are seen above the undeformed surface",
                key="wires.count",
                expected=str(count),
                cure="lower it, or give wires.positions",
            )
    else:
        chosen = np.array([_nearest(peaks, float(column)) for column in np.sort(positions)])
    half = _half_band(image, rows, appearance, chosen)
    band = _band(image, rows, appearance, above=2 * half, n_rows=2 * half)
    blur = appearance.optics.blur
    width = float(np.median([_width(band, column, blur) for column in chosen]))
    bars = [_fit(band, column, width, blur) for column in chosen]
    columns, heights = (np.array([getattr(bar, name) for bar in bars]) for name in ("position", "height"))
    return WireLook(columns, width, float(np.median(heights)), half)


def find_wires(image: Pixels, rows: Floats, appearance: Appearance, look: WireLook) -> WireSightings:
    """Find what looks like a wire above the surface of a frame.

    Args:
        image: grey values, shape [n_rows, n_columns].
        rows: row of the surface, bridged where wires hide it, NaN beside the sample, shape [n_columns].
        appearance, look: of the recording.
    """
    blur = appearance.optics.blur
    found = _find(
        image,
        rows - _gap(blur),
        look.half,
        appearance.greys,
        np.sign(look.height),
        _FAINTEST * _seen_height(look, blur),
        look.width,
        blur,
    )
    column, variance, lean, lean_variance = found[np.isfinite(found).all(axis=1)].T.copy()
    sigma = 1.0 / appearance.contrast_to_noise / np.sqrt(look.half)
    return WireSightings(
        column,
        sigma * np.sqrt(variance),
        lean,
        sigma * np.sqrt(lean_variance),
        distance=look.half + _gap(blur) - 0.5,
    )


@allocating
def _find(
    image: Pixels,
    foot: Floats,
    half: int,
    greys: Greys,
    sign: float,
    least: float,
    width: float,
    blur: float,
) -> Floats:
    """Column, lean and the variances of both for noise of variance 1 in a half of the band, shape [n, 4].

    Args:
        foot: row above which the band begins, shape [n_columns].
    """
    far = strip_shares(image, foot - 2 * half, half, greys)
    near = strip_shares(image, foot - half, half, greys)
    peaks = _peaks(sign * _smooth(0.5 * (far + near)), least)
    found = np.empty((peaks.size, 4))
    for i in range(peaks.size):
        high, low = _fit(far, peaks[i], width, blur), _fit(near, peaks[i], width, blur)
        variance = high.variance + low.variance
        found[i, 0], found[i, 1] = 0.5 * (high.position + low.position), 0.25 * variance
        found[i, 2], found[i, 3] = (low.position - high.position) / half, variance / half**2
    return found


def hidden_by_wires(sightings: WireSightings, look: WireLook, n_columns: int) -> Flags:
    """Columns of the surface that wires hide, shape [n_columns]; what the blur mixes with them is beside."""
    hidden = np.zeros(n_columns, bool)
    reach = 0.5 * look.width + 0.5
    base = sightings.column + sightings.lean * sightings.distance
    for column, foot in zip(sightings.column.tolist(), base.tolist(), strict=True):
        left, right = min(column, foot) - reach, max(column, foot) + reach
        hidden[max(int(np.ceil(left)), 0) : max(int(np.floor(right)) + 1, 0)] = True
    return hidden


NO_WIRES = WireSightings(np.zeros(0), np.zeros(0), np.zeros(0), np.zeros(0), 0.0)
"""What is seen where no wires are looked for."""


def bridged(rows: Floats) -> Floats:
    """Rows with straight lines across gaps; NaN beyond the first and the last known."""
    known = np.flatnonzero(np.isfinite(rows))
    if known.size == 0:
        return np.full(rows.size, np.nan)
    return np.interp(np.arange(rows.size), known, rows[known], left=np.nan, right=np.nan)


def _gap(blur: float) -> float:
    """Rows between the surface and the band."""
    return 1.5 * blur + 1.0


def _band(image: Pixels, rows: Floats, appearance: Appearance, *, above: int, n_rows: int) -> Floats:
    """Means of ``n_rows`` rows, the first of them ``above`` rows over the gap above the surface, as shares."""
    return appearance.strip(image, rows - _gap(appearance.optics.blur) - above, n_rows)


def _half_band(image: Pixels, rows: Floats, appearance: Appearance, columns: Floats) -> int:
    """Rows of each half of a band that the shortest of the wires at ``columns`` stands well out of."""
    highest = int(np.nanmin(rows) - _gap(appearance.optics.blur))
    places = np.rint(columns).astype(int)
    profile = np.array(
        [_band(image, rows, appearance, above=above, n_rows=1)[places] for above in range(1, highest)]
    )
    foot = np.median(profile[:_FEWEST_ROWS], axis=0)
    beyond = profile / foot < _TIP
    length = np.where(beyond.any(axis=0), beyond.argmax(axis=0), highest).min()
    n_rows = int(length - _TOP_CLEARANCE * appearance.optics.blur)
    if n_rows < _FEWEST_ROWS:
        raise InputError(
            f"the shortest wire stands {length + _gap(appearance.optics.blur):.0f} px out of the surface",
            key="wires",
            expected=f"{_FEWEST_ROWS + 5 * appearance.optics.blur + 1:.0f} px at least",
            cure="leave this wire out, or check calibration.y_axis and region.rows",
        )
    return min(n_rows // 2, _HALF)


@allocating
def _smooth(band: Floats) -> Floats:
    """Means over three columns; unknown ones count as zero."""
    n = band.size
    smooth = np.zeros(n)
    for c in range(n):
        for i in range(max(c - 1, 0), min(c + 2, n)):
            if np.isfinite(band[i]):
                smooth[c] += band[i] / 3.0
    return smooth


@allocating
def _peaks(values: Floats, least: float) -> Floats:
    """Columns of the local maxima above ``least``."""
    n = values.size
    found = np.zeros(n, np.bool_)
    for c in range(n):
        if values[c] > least:
            near = values[max(c - _SMALLEST_SPACING, 0) : min(c + _SMALLEST_SPACING + 1, n)]
            found[c] = values[c] == near.max()
    return np.flatnonzero(found).astype(np.float64)


def _nearest(peaks: Floats, column: float) -> float:
    near = peaks[np.abs(peaks - column) <= _SEARCH]
    if near.size == 0:
        raise InputError(
            f"no wire is seen within {_SEARCH:.0f} px of column {column:.0f} of the turned frame",
            key="wires.positions",
            expected="[column, row] where each wire leaves the undeformed surface",
            cure="correct it, or give wires.count",
        )
    return float(near[np.argmin(np.abs(near - column))])


@allocating
def _fit(band: Floats, column: float, width: float, blur: float) -> Bar:
    """A bar near ``column`` on the background beside it."""
    reach = 0.5 * width + 3.0 * blur + 1.0
    first, stop = max(int(column - reach), 0), min(int(column + reach) + 2, band.size)
    total, n = 0.0, 0
    for c in range(max(first - _BESIDE, 0), min(stop + _BESIDE, band.size)):
        if not first <= c < stop and np.isfinite(band[c]):
            total += band[c]
            n += 1
    return fit_bar(band[first:stop] - total / max(n, 1), first, column, width, blur)


def _width(band: Floats, column: float, blur: float) -> float:
    """Width of a bar that explains the band best."""
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        lambda width: _fit(band, column, width, blur).misfit,
        bounds=_WIDTHS,
        method="bounded",
        options={"xatol": 1e-2},
    )
    return float(found.x)


def _seen_height(look: WireLook, blur: float) -> float:
    """Height of the middle of a wire after the blur and the mean of three columns."""
    from math import erf

    total = float(np.hypot(blur, 1.0))
    return abs(look.height) * erf(0.5 * look.width / (np.sqrt(2) * total))
