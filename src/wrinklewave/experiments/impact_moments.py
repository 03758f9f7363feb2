"""The moments of an impact: when the striker touches, when it has come to rest, when the sample leaves and returns."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wrinklewave.imaging.arrays import Floats

APPROACH_FRAMES = 10
"""Frames before contact (and after separation) whose gap is continued to zero by a line."""
CURVED = 9.0
"""Gain in chi squared from which that line is a parabola: three standard deviations. A line that misses the frames by
so much is fitted to fewer of them."""
FEWEST_FRAMES = 3
BRIEFLY = 2
"""Frames apart that do not end a contact: a gap of a fraction of a pixel comes and goes with the noise."""
NOTICEABLE = 5.0
"""Standard uncertainties of the struck end beyond which it has moved, where no striker is seen."""
AT_REST = 1.0
"""Pixels within which a striker is at rest."""
NEARLY = 0.99
"""Share of its way after which a striker counts as stopped: the last part of a gradual stop has no sharp end."""


@dataclass(frozen=True)
class Moment:
    """A time and its standard uncertainty [s]; NaN where it does not happen or cannot be known.

    ``rate`` is that of the gap at this moment [px/s]; 0 if there is none or it cannot be known.
    """

    time: float
    sigma: float
    rate: float = 0.0


NEVER = Moment(float("nan"), float("nan"))


@dataclass(frozen=True)
class Impact:
    """Moments of an impact on the recording's clock.

    Attributes:
        contact: when the striker touches the sample.
        stop: when the striker has come to rest, that is, has gone 99 % of its way.
        separation: when the struck end leaves the striker.
        recontact: when it meets the striker again.
        stop_distance: way of the striker from contact to rest [px]; NaN if it is not seen to rest.
    """

    contact: Moment
    stop: Moment
    separation: Moment
    recontact: Moment
    stop_distance: float


@dataclass(frozen=True)
class EndTrack:
    """Struck end and striker through a recording; arrays of shape [n_frames], columns in pixels.

    Attributes:
        time: [s].
        column, sigma: of the struck end at the surface, and its standard uncertainty; NaN where not seen.
        row, row_sigma: of the surface there, and its standard uncertainty.
        striker, striker_sigma: the striker's face; NaN where there is none in sight.
        gap, gap_sigma: between the two, zero where the striker touches; NaN where there is none in sight.
        touching: 1 where the striker touches, 0 where it does not, NaN where it is out of sight.
        rest: column of the struck end at rest.
    """

    time: Floats
    column: Floats
    sigma: Floats
    row: Floats
    row_sigma: Floats
    striker: Floats
    striker_sigma: Floats
    gap: Floats
    gap_sigma: Floats
    touching: Floats
    rest: float


def find_moments(track: EndTrack, contact: float | None = None) -> Impact:
    """Find the moments of an impact; ``contact`` [s] is its time if that is known.

    Where no striker is in sight, or touches in the first frame already, contact is when the struck end begins to move.
    """
    first, stop = _contact_frames(track)
    touch = Moment(contact, 0.0) if contact is not None else NEVER
    if contact is None:
        touch = _closing(track, 0, first) if first else _first_motion(track)
    separation = recontact = NEVER
    if stop is not None:
        again = np.flatnonzero(track.touching[stop:] == 1.0) + stop
        last = int(again[0]) if again.size else track.time.size
        separation = _gap_zero(track, np.arange(stop, min(stop + APPROACH_FRAMES, last)), (stop - 1, stop))
        recontact = _closing(track, stop, last) if again.size else NEVER
    halt, distance = _stop(track, touch)
    return Impact(touch, halt, separation, recontact, distance)


def with_exposure_uncertainty(track: EndTrack, impact: Impact) -> EndTrack:
    """The same with the uncertainty of frames during whose exposure the faces may meet or part.

    Such a frame is a mixture. How long it was exposed is not known: at most for the whole interval, over which a gap
    that opens in its middle is an eighth of rate times interval wide on average.
    """
    interval = float(np.median(np.diff(track.time)))
    extra = np.zeros(track.time.size)
    for moment in (impact.contact, impact.separation, impact.recontact):
        near = np.abs(track.time - moment.time) < 0.5 * interval
        extra[near] = 0.125 * abs(moment.rate) * interval
    return replace(
        track, sigma=np.hypot(track.sigma, extra), striker_sigma=np.hypot(track.striker_sigma, extra)
    )


def _closing(track: EndTrack, after: int, first: int) -> Moment:
    """When the gap closes that was open from frame ``after`` on, and is not in frame ``first`` any more."""
    return _gap_zero(track, np.arange(max(first - APPROACH_FRAMES, after), first), (first - 1, first))


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
    """When the gap is zero by a line through some frames, near the frames of ``bracket``.

    If the line does not lead there, the middle between the two.
    """
    early, late = track.time[max(bracket[0], 0)], track.time[bracket[1]]
    interval = float(np.median(np.diff(track.time)))
    middle = Moment(float(0.5 * (early + late)), float(max(late - early, interval) / np.sqrt(12.0)))
    known = frames[np.isfinite(track.gap[frames]) & (track.touching[frames] == 0.0)]
    if known.size < FEWEST_FRAMES:
        return middle
    nearest = known[np.abs(known - bracket[1]).argsort()]
    for n in range(nearest.size, FEWEST_FRAMES - 1, -1):
        line, covariance, spread = _line(track, nearest[:n], early, interval)
        if spread < CURVED:
            break
    roots = np.roots(line)
    roots = roots[np.isreal(roots)].real
    share = (late - early) / interval
    near = roots[(roots >= -1.0) & (roots <= share + 1.0)]
    if near.size == 0:
        return middle
    zero = float(near[np.abs(near - 0.5 * share).argmin()])
    rate = float(np.polyval(np.polyder(line), zero))
    gradient = zero ** np.arange(line.size - 1, -1, -1) / rate
    sigma = float(np.sqrt(spread * gradient @ covariance @ gradient))
    return Moment(float(early + zero * interval), sigma * interval, rate / interval)


def _line(
    track: EndTrack, frames: NDArray[np.intp], early: float, interval: float
) -> tuple[Floats, Floats, float]:
    """Straight line through the gap in some frames, or a parabola where that is much better.

    Returns:
        Coefficients over (time - early)/interval, their covariance, and chi squared per degree of freedom, at least 1.
    """
    at, gap, weight = (
        (track.time[frames] - early) / interval,
        track.gap[frames],
        1.0 / track.gap_sigma[frames],
    )
    fits = []
    for degree in (1, 2) if frames.size > FEWEST_FRAMES + 1 else (1,):
        line, covariance = np.polyfit(at, gap, degree, w=weight, cov="unscaled")
        misfit = float(np.sum((weight * (gap - np.polyval(line, at))) ** 2))
        fits.append((line, covariance, misfit))
    line, covariance, misfit = fits[-1] if fits[0][2] - fits[-1][2] > CURVED else fits[0]
    return line, covariance, max(misfit / (frames.size - line.size), 1.0)


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
