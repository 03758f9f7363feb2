"""The moments of an impact: when the striker touches, when it has come to rest, when the sample leaves it."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wrinklewave.imaging.arrays import Floats

APPROACH_FRAMES = 10
"""Frames before contact (and after separation) whose gap is continued to zero by a straight line."""
FEWEST_FRAMES = 3
BRIEFLY = 2
"""Frames apart that do not end a contact: a gap of a fraction of a pixel comes and goes with the noise."""
NOTICEABLE = 5.0
"""Standard uncertainties of the struck end beyond which it has moved, where no striker is seen."""
AT_REST = 1.0
"""Pixels within which a striker is at rest."""
NEARLY = 0.99
"""Share of its way after which a striker counts as stopped: the last part of a gradual stop has no sharp end."""


GRAZING = 0.3
"""Pixels by which struck end and striker may be off while the gap between them is too narrow to be seen."""


@dataclass(frozen=True)
class Moment:
    """A time and its standard uncertainty [s]; NaN where it does not happen or cannot be known."""

    time: float
    sigma: float


NEVER = Moment(float("nan"), float("nan"))


@dataclass(frozen=True)
class Impact:
    """Moments of an impact on the recording's clock.

    Attributes:
        contact: when the striker touches the sample.
        stop: when the striker has come to rest, that is, has gone 99 % of its way.
        separation: when the struck end leaves the striker.
        stop_distance: way of the striker from contact to rest [px]; NaN if it is not seen to rest.
    """

    contact: Moment
    stop: Moment
    separation: Moment
    stop_distance: float


@dataclass(frozen=True)
class EndTrack:
    """Struck end and striker through a recording; arrays of shape [n_frames], columns in pixels.

    Attributes:
        time: [s].
        column, sigma: of the struck end at the surface, and its standard uncertainty; NaN where not seen.
        row: of the surface there, to a pixel or so.
        striker, striker_sigma: the striker's face; NaN where there is none in sight.
        touching: 1 where the striker touches, 0 where it does not, NaN where it is out of sight.
        rest: column of the struck end at rest.
    """

    time: Floats
    column: Floats
    sigma: Floats
    row: Floats
    striker: Floats
    striker_sigma: Floats
    touching: Floats
    rest: float


def find_moments(track: EndTrack, contact: float | None = None) -> Impact:
    """Find the moments of an impact; ``contact`` [s] is its time if that is known."""
    first, stop = _contact_frames(track)
    if contact is not None:
        touch = Moment(contact, 0.0)
    elif first is not None:
        touch = _gap_zero(track, np.arange(max(first - APPROACH_FRAMES, 0), first), (first - 1, first))
    else:
        touch = _first_motion(track)
    separation = NEVER
    if stop is not None:
        after = np.arange(stop, min(stop + APPROACH_FRAMES, track.time.size))
        separation = _gap_zero(track, after, (stop - 1, stop))
    halt, distance = _stop(track, touch)
    return Impact(touch, halt, separation, distance)


def with_grazing_uncertainty(track: EndTrack, impact: Impact) -> EndTrack:
    """The same with the uncertainty of frames in which the gap is about to close, or has just opened.

    A gap narrower than the blur looks like a single edge in another place: no frame by itself can tell them apart.
    """
    interval = float(np.median(np.diff(track.time)))
    near = np.zeros(track.time.size, bool)
    for moment in (impact.contact, impact.separation):
        near |= np.abs(track.time - moment.time) < interval
    extra = np.where(near & (track.touching == 1.0), GRAZING, 0.0)
    return replace(
        track, sigma=np.hypot(track.sigma, extra), striker_sigma=np.hypot(track.striker_sigma, extra)
    )


def _contact_frames(track: EndTrack) -> tuple[int | None, int | None]:
    """First frame in contact, and the first one after it; None where there is none."""
    touching = np.flatnonzero(track.touching == 1.0)
    if touching.size == 0:
        return None, None
    apart = np.flatnonzero(track.touching == 0.0)
    first = int(touching[0])
    for frame in apart[apart > first]:
        following = track.touching[frame : frame + BRIEFLY + 1]
        if following.size == BRIEFLY + 1 and not (following == 1.0).any():
            return first, int(frame)
    return first, None


def _gap_zero(track: EndTrack, frames: NDArray[np.intp], bracket: tuple[int, int]) -> Moment:
    """When the gap is zero by a straight line through some frames, near the frames of ``bracket``.

    If the line does not lead there, the middle between the two.
    """
    early, late = track.time[max(bracket[0], 0)], track.time[bracket[1]]
    interval = float(np.median(np.diff(track.time)))
    middle = Moment(float(0.5 * (early + late)), float(max(late - early, interval) / np.sqrt(12.0)))
    end = np.where(np.isfinite(track.column), track.column, track.rest)
    gap = (end - track.striker)[frames]
    known = np.isfinite(gap) & (track.touching[frames] == 0.0)
    if known.sum() < FEWEST_FRAMES:
        return middle
    time, gap = track.time[frames][known], gap[known]
    (slope, level), covariance = np.polyfit(time - early, gap, 1, cov="unscaled")
    if slope == 0.0:
        return middle
    residual = gap - level - slope * (time - early)
    spread = np.sqrt(residual @ residual / max(gap.size - 2, 1))
    zero = -level / slope
    gradient = np.array([zero, 1.0]) / slope
    sigma = float(spread * np.sqrt(gradient @ covariance @ gradient))
    if not -interval <= zero <= late - early + interval:
        return middle
    return Moment(float(early + zero), sigma)


def _first_motion(track: EndTrack) -> Moment:
    """When the struck end leaves its place, by straight lines between frames."""
    known = np.flatnonzero(np.isfinite(track.column))
    moved = np.abs(track.column[known] - track.rest) > NOTICEABLE * track.sigma[known]
    lasting = moved & np.append(moved[1:], True)
    if not lasting.any() or lasting[0]:
        return NEVER
    after = int(lasting.argmax())
    early, late = track.time[known[after - 1]], track.time[known[after]]
    return Moment(float(0.5 * (early + late)), float((late - early) / np.sqrt(12.0)))


def _stop(track: EndTrack, contact: Moment) -> tuple[Moment, float]:
    """When the striker has come to rest, and its way until then."""
    known = np.isfinite(track.striker) & (track.time >= contact.time)
    time, column = track.time[known], track.striker[known]
    last = column[-max(time.size // 5, 2 * FEWEST_FRAMES) :]
    if last.size < 2 * FEWEST_FRAMES or np.percentile(np.abs(last - np.median(last)), 80) > AT_REST:
        return NEVER, float("nan")
    rest = float(np.median(column[np.abs(column - np.median(last)) <= AT_REST]))
    distance = rest - track.rest
    there = column >= track.rest + NEARLY * distance
    if distance <= AT_REST or there[0]:
        return NEVER, float("nan")
    after = int(there.argmax())
    goal = track.rest + NEARLY * distance
    share = (goal - column[after - 1]) / (column[after] - column[after - 1])
    step = time[after] - time[after - 1]
    speed = (column[after] - column[after - 1]) / step
    sigma = float(np.hypot(track.striker_sigma[known][after] / speed, step / np.sqrt(12.0)))
    return Moment(float(time[after - 1] + share * step), sigma), distance
