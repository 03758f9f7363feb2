"""Probe wires that stand out of the surface: found in every frame, then joined to tracks of material points.

Above the surface a wire is a bar darker (or brighter) than the background, which ends at its tip. All rows of it are
used, each for as much of the wire as the blur leaves in it, in three parts one above the other, so that a wire that
leans can be followed down to where it leaves the surface. Its place in each is found by maximum likelihood for a bar
of known width, blurred and pixel-integrated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cache
from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating
from wrinklewave.errors import InputError
from wrinklewave.imaging.appearance import Appearance
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.bars import Bar, fit_bar
from wrinklewave.imaging.edges.profile import blurred_step_at
from wrinklewave.imaging.strips import Greys, strip_shares

_BAND = 12  # rows in which wires are looked for, at most
_LONGEST = 24.0  # px of a wire that are used: further up it need not be straight
_FEWEST_ROWS = 3.0  # of a wire beside what the blur takes at the surface
_PARTS = 3  # of a wire, one above the other
_TIP = 0.5  # of its height: where a wire ends
_LEAST_HEIGHT = 0.15  # contrasts: fainter bars are no wires
_SEARCH = 10.0  # px around a given position
_SMALLEST_SPACING = 5  # px between wires
_WIDTHS = (0.5, 12.0)  # px
_FIRST_WIDTH = 5.0  # px: to begin with
_BESIDE = 6  # columns on either side that tell the background
_SHARP = 5.0  # blurs beyond which a step is 0 or 1
_FAINTEST = 0.5  # of the height known from the undeformed frames
_CLEAR = 1.0  # blurs, and half a pixel: no closer to the surface is anything told of a wire


@dataclass(frozen=True)
class WireLook:
    """What the wires of a recording have in common.

    Attributes:
        columns: where they leave the surface in the undeformed frames [px], shape [n_wires], increasing.
        width: [px].
        height: in contrasts, positive if the wire is on the sample's side of grey.
        length: of the shortest above the surface [px].
    """

    columns: Floats
    width: float
    height: float
    length: float


class WireSightings(NamedTuple):
    """Wires seen in one frame, shape [n], from left to right, in pixels.

    Attributes:
        column, sigma: middle of the wire ``distance`` above the surface, and its standard uncertainty.
        lean, lean_sigma: columns per row, and its standard uncertainty.
        distance: rows from there down to the surface.
    """

    column: Floats
    sigma: Floats
    lean: Floats
    lean_sigma: Floats
    distance: Floats


def learn_wires(
    image: Pixels,
    appearance: Appearance,
    *,
    count: int | None = None,
    positions: Floats | None = None,
    names: Sequence[str] = (),
) -> WireLook:
    """Find the wires in the mean of the undeformed frames.

    Args:
        image: mean of the undeformed frames, shape [n_rows, n_columns].
        appearance: of the recording.
        count: how many to find, or
        positions: columns where they are, to within a few pixels, shape [n_wires].
        names: of the positions, for messages.

    Raises:
        InputError: if there are fewer than asked for.
    """
    rows = bridged(appearance.surface)
    band = appearance.strip(image, rows - _gap(appearance.optics.blur) - _BAND, _BAND)
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
        order = np.argsort(positions)
        chosen = np.array([_nearest(peaks, float(positions[i]), names[i] if names else "") for i in order])
        _check_distinct(chosen, [names[i] if names else "" for i in order])
    blur = appearance.optics.blur
    length = _length(image, rows, appearance, chosen)
    parts = _parts(length, blur)
    whole = [
        _profile(image, rows, appearance.greys, column, length, _FIRST_WIDTH, parts[0], parts[-1], blur)
        for column in chosen
    ]
    width = float(np.median([_width(one, column, blur) for one, column in zip(whole, chosen, strict=True)]))
    heights = [_fit(one, column, width, blur).height for one, column in zip(whole, chosen, strict=True)]
    look = WireLook(chosen, width, float(np.median(heights)), length)
    seen = _seen(image, rows, appearance, look, chosen)
    feet = seen[:, 0] + seen[:, 2] * seen[:, 4]
    return WireLook(np.where(np.isfinite(feet), feet, chosen), width, look.height, length)


def find_wires(image: Pixels, rows: Floats, appearance: Appearance, look: WireLook) -> WireSightings:
    """Find what looks like a wire above the surface of a frame.

    Args:
        image: grey values, shape [n_rows, n_columns].
        rows: row of the surface, bridged where wires hide it, NaN beside the sample, shape [n_columns].
        appearance, look: of the recording.
    """
    blur = appearance.optics.blur
    n_rows = int(min(_BAND, max(look.length - _gap(blur), _FEWEST_ROWS)))
    band = strip_shares(image, rows - _gap(blur) - n_rows, n_rows, appearance.greys)
    peaks = _peaks(np.sign(look.height) * _smooth(band), _FAINTEST * _seen_height(look, blur))
    found = _seen(image, rows, appearance, look, peaks)
    column, variance, lean, lean_variance, distance = found[np.isfinite(found).all(axis=1)].T.copy()
    noise = 1.0 / appearance.contrast_to_noise
    return WireSightings(column, noise * np.sqrt(variance), lean, noise * np.sqrt(lean_variance), distance)


def _seen(image: Pixels, rows: Floats, appearance: Appearance, look: WireLook, near: Floats) -> Floats:
    """Column, its variance, lean, its variance, and the distance above the surface, of wires ``near`` columns."""
    blur = appearance.optics.blur
    parts = _parts(look.length, blur)
    return _in_parts(image, rows, appearance.greys, near, look.length, look.width, parts, blur)


@allocating
def _in_parts(
    image: Pixels,
    rows: Floats,
    greys: Greys,
    near: Floats,
    length: float,
    width: float,
    parts: Floats,
    blur: float,
) -> Floats:
    """Fields of ``WireSightings`` for noise of variance 1, shape [n, 5]."""
    found = np.full((near.size, 5), np.nan)
    n = parts.size - 1
    place, variance, distance = np.empty(n), np.empty(n), np.empty(n)
    for i in range(near.size):
        for k in range(n):
            part = _profile(image, rows, greys, near[i], length, width, parts[k], parts[k + 1], blur)
            fit = fit_bar(part.shares, part.weights, part.first, near[i], width, blur)
            place[k], variance[k], distance[k] = fit.position, fit.variance, part.distance
        weight = 1.0 / variance
        total = weight.sum()
        middle = np.dot(weight, distance) / total
        lever = np.dot(weight, (distance - middle) ** 2)
        if not (np.isfinite(place).all() and lever > 0.0):
            continue
        found[i, 0], found[i, 1] = np.dot(weight, place) / total, 1.0 / total
        found[i, 2], found[i, 3] = -np.dot(weight * (distance - middle), place) / lever, 1.0 / lever
        found[i, 4] = middle
    return found


class _Profile(NamedTuple):
    """Some rows around a wire brought together: shares of consecutive columns, and how well each is known.

    ``weights`` are inverse variances for noise of variance 1, ``distance`` is from the surface to the rows' middle.
    """

    first: int
    shares: Floats
    weights: Floats
    distance: float


@allocating
def _profile(
    image: Pixels,
    rows: Floats,
    greys: Greys,
    column: float,
    length: float,
    width: float,
    low: float,
    high: float,
    blur: float,
) -> _Profile:
    """The rows from ``low`` to ``high`` above the surface around a wire, less the blurred surface itself.

    Rows count for as much of the wire as they show: the blur takes some of it at the surface and at the tip.
    """
    reach = int(0.5 * width + 3.0 * blur + 1.0) + _BESIDE
    middle = int(np.rint(column))
    first, stop = max(middle - reach, 0), min(middle + reach + 1, image.shape[1])
    shares, weights = np.zeros(stop - first), np.zeros(stop - first)
    total, lever = 0.0, 0.0
    own = width**2 / 12.0  # variance of the wire's columns; a column c sees those at x + share (c - x)
    share = own / (own + blur**2 + 1.0 / 12.0)
    tilt = _slope(rows, middle)
    along = np.sqrt(blur**2 + tilt**2 * share * blur**2)
    for c in range(first, stop):
        foot = rows[min(max(middle, 0), rows.size - 1)] + share * tilt * (c - column)
        if not np.isfinite(rows[c]) or not np.isfinite(foot):
            continue
        slope = _slope(rows, c)
        across = np.sqrt(blur**2 * (1.0 + slope**2) + slope**2 / 12.0)
        lowest = min(foot - low, rows[c] - clearance_of_wires(across))
        for r in range(max(int(np.ceil(foot - high)), 0), min(int(np.ceil(lowest)), image.shape[0])):
            d = foot - r
            shown = _edge(d, along) - _edge(d - length, along)
            depth = r - greys.row - greys.slope * c
            background = greys.background[c] + greys.background_gradient[c] * depth
            contrast = greys.sample[c] + greys.sample_gradient[c] * depth - background
            shares[c - first] += shown * ((image[r, c] - background) / contrast - _edge(r - rows[c], across))
            weights[c - first] += shown * shown
            if abs(c - middle) <= 0.5 * width + 1.0:
                total += shown * shown
                lever += shown * shown * d
    for i in range(shares.size):
        if weights[i] > 0.0:
            shares[i] /= weights[i]
    return _Profile(first, shares, weights, lever / total if total > 0.0 else np.nan)


@allocating
def _slope(rows: Floats, c: int) -> float:
    """Of the surface at a column; 0 where it is not known on both sides."""
    slope = 0.5 * (rows[min(max(c + 1, 0), rows.size - 1)] - rows[min(max(c - 1, 0), rows.size - 1)])
    return slope if np.isfinite(slope) else 0.0


@allocating
def _edge(u: float, blur: float) -> float:
    """A blurred, pixel-integrated unit step at the distance ``u``."""
    if abs(u) > _SHARP * blur + 0.5:  # most pixels
        return 1.0 if u > 0.0 else 0.0
    return blurred_step_at(u, blur)[0]


@allocating
def clearance_of_wires(blur: float) -> float:
    """Distance from the surface beyond which the blurred surface itself no longer matters beside a wire [px]."""
    return _CLEAR * blur + 0.5


@cache  # the same for all frames
def _parts(length: float, blur: float) -> Floats:
    """Distances from the surface that divide a wire into parts that tell as much as each other."""
    low, high = clearance_of_wires(blur), min(length + 2.0 * blur, _LONGEST)
    d = np.linspace(low, high, 257)
    told = np.cumsum([(_edge(u, blur) - _edge(u - length, blur)) ** 2 for u in d])
    inner = np.interp(np.arange(1, _PARTS) * told[-1] / _PARTS, told, d)
    return np.concatenate([[low], inner, [high]])


def hidden_by_wires(sightings: WireSightings, look: WireLook, n_columns: int) -> Flags:
    """Columns of the surface that wires hide, shape [n_columns]; what the blur mixes with them is beside."""
    hidden = np.zeros(n_columns, bool)
    reach = 0.5 * look.width + 0.5
    base = sightings.column + sightings.lean * sightings.distance
    for column, foot in zip(sightings.column.tolist(), base.tolist(), strict=True):
        left, right = min(column, foot) - reach, max(column, foot) + reach
        hidden[max(int(np.ceil(left)), 0) : max(int(np.floor(right)) + 1, 0)] = True
    return hidden


NO_WIRES = WireSightings(*np.zeros((5, 0)))
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


def _length(image: Pixels, rows: Floats, appearance: Appearance, columns: Floats) -> float:
    """How far the shortest of the wires at ``columns`` stands out of the surface, as far as that is used [px]."""
    blur = appearance.optics.blur
    highest = int(min(np.nanmin(rows), _LONGEST + 2.0 * blur))
    start = int(np.ceil(_gap(blur)))
    places = np.rint(columns).astype(int)
    profile = np.array([appearance.strip(image, rows - above, 1)[places] for above in range(start, highest)])
    if not profile.size:
        profile = np.ones((1, columns.size))
    beyond = profile / np.median(profile[:3], axis=0) < _TIP
    length = start - 0.5 + float(np.where(beyond.any(axis=0), beyond.argmax(axis=0), profile.shape[0]).min())
    needed = _gap(blur) + _FEWEST_ROWS
    if length < needed:
        raise InputError(
            f"the shortest wire stands {length:.0f} px out of the surface",
            key="wires",
            expected=f"{needed:.0f} px at least",
            cure="leave this wire out, or check calibration.y_axis and region",
        )
    return length


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


def _nearest(peaks: Floats, column: float, name: str) -> float:
    near = peaks[np.abs(peaks - column) <= _SEARCH]
    if near.size == 0:
        raise InputError(
            f"no wire is seen within {_SEARCH:.0f} px of {name or f'column {column:.0f}'}",
            key="wires.positions",
            expected="[column, row] where each wire leaves the undeformed surface",
            cure="correct it, or give wires.count",
        )
    return float(near[np.argmin(np.abs(near - column))])


def _check_distinct(chosen: Floats, names: Sequence[str]) -> None:
    same = np.flatnonzero(np.diff(chosen) == 0.0)
    if same.size:
        raise InputError(
            f"{names[same[0]]} and {names[same[0] + 1]} are the same wire",
            key="wires.positions",
            expected="one position for each wire",
            cure="correct or remove one of them",
        )


def _fit(profile: _Profile, column: float, width: float, blur: float) -> Bar:
    """A bar near ``column`` on the background beside it."""
    return fit_bar(profile.shares, profile.weights, profile.first, column, width, blur)


def _width(profile: _Profile, column: float, blur: float) -> float:
    """Width of a bar that explains the profile best."""
    from scipy.optimize import minimize_scalar

    found = minimize_scalar(
        lambda width: _fit(profile, column, width, blur).misfit,
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
