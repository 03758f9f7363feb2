"""How a recording looks at rest: which side is the sample, its ends, its surface, blur and grey values.

Learnt once, from the undeformed frames and a few others, and then the same for every frame: what is measured in a
frame does not depend on the frames beside it.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.imaging.arrays import Flags, Floats, Pixels
from wrinklewave.imaging.edges import Edge, EdgeFinder, Optics
from wrinklewave.imaging.edges.coarse import coarse_edge, step_contrast
from wrinklewave.imaging.edges.levels import Levels, find_levels
from wrinklewave.imaging.edges.profile import blurred_step
from wrinklewave.imaging.faces import END, fit_faces
from wrinklewave.imaging.frames import Image
from wrinklewave.imaging.strips import Greys, strip_mean, strip_shares

STRIP_ROWS = 48
"""Rows of the strip in the sample's body in which the ends are looked for."""

NOT_LIKE = 0.15
"""Shares of the contrast by which a striker differs from sample and background."""

_FEWEST_ROWS = 8
_FIRST_BLUR = 1.5  # px, where it matters little
_FIRST_BLURS = (0.5, 1.0, 2.0, 4.0)  # px, to begin with
_BLURS = (0.3, 6.0)  # px, between which it is looked for
_PROFILE_REACH = 12.0  # px on either side of the edge
_BINS_PER_PIXEL = 10
_END_SPAN = 6  # columns averaged on either side of a candidate for an end
_END_STEP = 0.15  # contrasts: smallest step of an end
_BLUR_FRAMES = 8
_LEAST_LEDGE = 4.0  # px
_LINE_STEPS = 20


@dataclass(frozen=True)
class Appearance:
    """A recording at rest; columns and rows in pixels, arrays of shape [n_columns].

    Attributes:
        optics: blur, and which side is brighter.
        surface: row of the undeformed surface, mean of the undeformed frames; NaN beside the sample.
        surface_sigma: its standard uncertainty.
        line: (row at column 0, slope) of the straight line through it.
        background, sample: grey values above and below the surface, continued beyond the sample.
        background_gradient, sample_gradient: the same per pixel down the column.
        struck_end, held_end: columns of the sample's ends; infinite if out of sight.
        strip_depth: rows between ``line`` and the strip in the sample's body.
        noise: standard deviation of a pixel's noise [grey values].
        striker: what the striker looks like between background (0) and sample (1); None if there is none.
    """

    optics: Optics
    surface: Floats
    surface_sigma: Floats
    line: tuple[float, float]
    background: Floats
    sample: Floats
    background_gradient: Floats
    sample_gradient: Floats
    struck_end: float
    held_end: float
    strip_depth: float
    noise: float
    striker: float | None = None

    @property
    def clearance(self) -> float:
        """Distance from an end, or a wire, at which the surface is no longer disturbed by it [px]."""
        return clearance(self.optics.blur)

    @property
    def striker_alike(self) -> bool:
        """Whether the striker looks like the sample."""
        return self.striker is not None and abs(self.striker - 1.0) < NOT_LIKE

    @property
    def contrast(self) -> float:
        """Difference of grey values across the surface."""
        return float(np.median(np.abs(self.sample - self.background)))

    @property
    def contrast_to_noise(self) -> float:
        """Step of grey values across the surface over the noise of a pixel."""
        return self.contrast / self.noise

    @cached_property
    def greys(self) -> Greys:
        """What background and sample look like anywhere in the image."""
        row, slope = self.line
        return Greys(row, slope, self.background, self.sample, self.background_gradient, self.sample_gradient)

    def strip(self, image: Pixels, top: Floats, n_rows: int) -> Floats:
        """Means of ``n_rows`` rows from ``top`` [n_columns] down as shares between background (0) and sample (1)."""
        return strip_shares(image, top, n_rows, self.greys)

    def body(self, image: Pixels) -> Floats:
        """Shares in the strip of the sample's body, shape [n_columns]."""
        columns = np.arange(image.shape[1], dtype=np.float64)
        return self.strip(image, self.line[0] + self.line[1] * columns + self.strip_depth, STRIP_ROWS)


def clearance(blur: float) -> float:
    """Distance at which blur and pixels no longer mix what lies beside each other [px]."""
    return float(2.5 * np.hypot(blur, 12**-0.5) + 1.0)


def learn_appearance(undeformed: Sequence[Image], others: Sequence[Image]) -> Appearance:
    """Learn from the undeformed frames, and from some others that show the striker.

    Args:
        undeformed: frames of the sample at rest, shape [n_rows, n_columns], the sample below its surface.
        others: frames spread over the recording.

    Raises:
        InputError: if no surface is seen, or less of the sample than is needed.
    """
    images = [np.ascontiguousarray(image, dtype=np.float32) for image in undeformed]
    mean = np.asarray(np.mean(images, axis=0, dtype=np.float64), dtype=np.float32)
    brighter = _sample_is_brighter(mean)
    start = coarse_edge(mean, 1.0 if brighter else -1.0)
    levels = find_levels(mean, start, np.full(start.size, _FIRST_BLUR), 0, start.size)
    _check_contrast(levels)
    struck, held = _ends(mean, start, levels)
    first, stop = _columns(struck, held, start.size, margin=4.0)
    blur = float(np.median([_blur(image, brighter, first, stop) for image in images[:_BLUR_FRAMES]]))
    optics = Optics(blur, brighter)
    first, stop = _columns(struck, held, start.size, margin=clearance(blur))
    finder = EdgeFinder(optics)
    edges = [finder.find(image, first=first, stop=stop) for image in images]
    surface, sigma = _mean_surface(edges)
    line = _line(surface)
    levels = find_levels(mean, start, np.full(start.size, blur), first, stop)
    background, sample, background_gradient, sample_gradient = (
        _continued(values, levels.usable) for values in (*levels.value, *levels.gradient)
    )
    appearance = Appearance(
        optics=optics,
        surface=surface,
        surface_sigma=sigma,
        line=line,
        background=background,
        sample=sample,
        background_gradient=background_gradient,
        sample_gradient=sample_gradient,
        struck_end=struck,
        held_end=held,
        strip_depth=_strip_depth(mean.shape[0], line, start.size, blur),
        noise=float(np.median([edge.noise for edge in edges])),
    )
    return replace(appearance, striker=_striker(appearance, others))


def _sample_is_brighter(image: Pixels) -> bool:
    rising, falling = step_contrast(image)
    return rising >= falling


def _check_contrast(levels: Levels) -> None:
    if levels.contrast < 1.5 * levels.mean_noise or levels.usable.mean() < 0.25:
        raise InputError(
            f"no surface is seen (contrast {levels.contrast:.3g} grey values, noise {levels.mean_noise:.3g})",
            key="video.file",
            expected="the undeformed sample below its surface, along most of the region's width",
            cure="check calibration.x_axis and y_axis, and give region.columns and region.rows",
        )


def _ends(image: Pixels, rows: Floats, levels: Levels) -> tuple[float, float]:
    """Columns of the sample's ends: the widest stretch without steps in the strip below the surface."""
    below = rows + 4.0 * _FIRST_BLUR + 4.0
    profile = strip_mean(image, np.full(rows.size, np.median(below)), STRIP_ROWS)
    if not np.isfinite(profile).all():
        raise InputError(
            "the image ends just below the surface",
            key="region.rows",
            expected=f"at least {_FEWEST_ROWS} rows of the sample's body",
            cure="give more rows on the side of the sample, or check calibration.x_axis and y_axis",
        )
    limit = max(_END_STEP * levels.contrast, 10.0 * levels.mean_noise / np.sqrt(_END_SPAN * STRIP_ROWS))
    found = _strongest_steps(profile, limit)
    bounds = [0, *found, profile.size]
    widest = int(np.argmax(np.diff(bounds)))
    struck = _refined_end(profile, bounds[widest]) if widest > 0 else -np.inf
    held = _refined_end(profile, bounds[widest + 1]) if widest + 1 < len(bounds) - 1 else _ledge(rows)
    return struck, held


def _ledge(rows: Floats) -> float:
    """Column at which the surface steps to the top of a support that looks like the sample; infinite if it does not."""
    off = rows - _straight(rows)
    top = float(np.median(off[-_END_SPAN:]))
    column = int(np.flatnonzero(np.abs(off - top) > _LEAST_LEDGE)[-1:].sum()) + 1
    before = off[max(column - 2 * _END_SPAN, 0) : max(column - _END_SPAN, 1)]
    if abs(top) < 1.5 * _LEAST_LEDGE or np.median(np.abs(before)) > 0.5 * abs(top):
        return np.inf
    return column - 0.5


def _straight(rows: Floats) -> Floats:
    """A straight line that a smaller part of the columns may be far away from: least absolute distances."""
    columns, weights = np.arange(rows.size), np.ones(rows.size)
    line: Floats = np.full(rows.size, np.median(rows))
    for _ in range(_LINE_STEPS):
        slope, row = np.polyfit(columns, rows, 1, w=np.sqrt(weights))
        line = row + slope * columns
        weights = 1.0 / np.maximum(np.abs(rows - line), 0.1)
    return line


def _strongest_steps(profile: Floats, limit: float) -> list[int]:
    """Columns where the means of the columns before and after differ most, and by more than ``limit``."""
    span = _END_SPAN
    total = np.concatenate([[0.0], np.cumsum(profile)])
    centre = np.arange(span, profile.size - span + 1)
    step = np.abs(total[centre + span] - 2 * total[centre] + total[centre - span]) / span
    peak = [
        i
        for i in range(step.size)
        if step[i] > limit and step[i] == step[max(i - span, 0) : i + span + 1].max()
    ]
    return [int(centre[i]) for i in peak]


def _refined_end(profile: Floats, column: int) -> float:
    """Position of a step near ``column`` to a fraction of a pixel."""
    first, last = max(column - 3 * _END_SPAN, 0), min(column + 3 * _END_SPAN, profile.size)
    window = profile[first:last]
    start, only_end = np.array([column - 0.5, 0.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0, 0.0])
    fit = fit_faces(window[None, :], first, np.zeros(1), start, only_end, _FIRST_BLUR, 1.0)
    return float(fit.at[END]) if np.isfinite(fit.at[END]) else column - 0.5


def _columns(struck: float, held: float, n_columns: int, *, margin: float) -> tuple[int, int]:
    """First column and one past the last that lie on the sample, ``margin`` pixels from its ends."""
    return int(max(np.ceil(struck + margin), 0)), int(min(np.floor(held - margin) + 1, n_columns))


def _blur(image: Pixels, brighter: bool, first: int, stop: int) -> float:
    """Blur of one frame: begun with the guess that finds most of the edge, and refined."""
    guesses = [
        EdgeFinder(Optics(guess, brighter)).find(image, first=first, stop=stop) for guess in _FIRST_BLURS
    ]
    edge = max(guesses, key=lambda edge: int(edge.column_valid.sum()))
    if not edge.valid.any():
        raise InputError(
            "no surface is seen in an undeformed frame",
            key="video.undeformed_frames",
            expected="the sample at rest, its surface across most of the region's width, in all of them",
            cure="lower it, begin later with video.frames, or check region and calibration",
        )
    blur = _profile_blur(image, edge)
    return _profile_blur(image, EdgeFinder(Optics(blur, brighter)).find(image, first=first, stop=stop))


def _profile_blur(image: Pixels, edge: Edge) -> float:
    """Blur that describes the profile of the edge best, all columns of a frame together.

    Every pixel within ``_PROFILE_REACH`` of the surface is a sample of one finely resolved profile: a blurred step
    between two sides whose grey values are linear in the distance.
    """
    from scipy.optimize import minimize_scalar

    u, grey, count = _fine_profile(image, edge)

    def misfit(blur: float) -> float:
        step = blurred_step(u, blur)
        terms = np.stack([1 - step, step, u * (1 - step), u * step], axis=1) * np.sqrt(count)[:, None]
        return float(np.linalg.lstsq(terms, grey * np.sqrt(count), rcond=None)[1][0])

    found = minimize_scalar(misfit, bounds=_BLURS, method="bounded", options={"xatol": 1e-3})
    rows_variance = float(np.mean(edge.sigma[edge.valid] ** 2))
    return float(np.sqrt(max(found.x**2 - rows_variance, _BLURS[0] ** 2)))


def _fine_profile(image: Pixels, edge: Edge) -> tuple[Floats, Floats, Floats]:
    """Distances from the surface in fine bins [px], the mean grey values there, and the number of pixels."""
    rows = np.arange(image.shape[0])[:, None]
    distance = (rows - edge.rows)[:, edge.valid]
    near = np.abs(distance) < _PROFILE_REACH
    bins = ((distance[near] + _PROFILE_REACH) * _BINS_PER_PIXEL).astype(int)
    count = np.bincount(bins).astype(float)
    total_u, total = np.bincount(bins, distance[near]), np.bincount(bins, image[:, edge.valid][near])
    filled = count > 0
    return total_u[filled] / count[filled], total[filled] / count[filled], count[filled]


def _mean_surface(edges: Sequence[Edge]) -> tuple[Floats, Floats]:
    """Mean of the frames' surfaces and its standard uncertainty; NaN where no frame has one."""
    rows = np.array([np.where(edge.valid, edge.rows, np.nan) for edge in edges])
    count = np.isfinite(rows).sum(axis=0)
    known = count > 0
    mean = np.divide(np.nansum(rows, axis=0), count, out=np.full(count.shape, np.nan), where=known)
    variance = np.sum([np.where(edge.valid, edge.sigma**2, 0.0) for edge in edges], axis=0)
    sigma = np.sqrt(np.divide(variance, count**2, out=np.full(count.shape, np.inf), where=known))
    return mean, sigma


def _line(surface: Floats) -> tuple[float, float]:
    known = np.flatnonzero(np.isfinite(surface))
    slope, row = np.polyfit(known, surface[known], 1)
    return float(row), float(slope)


def _continued(values: Floats, known: Flags) -> Floats:
    """Values where they are known, the nearest known one elsewhere."""
    columns = np.flatnonzero(known & np.isfinite(values))
    return np.interp(np.arange(values.size), columns, values[columns])


def _strip_depth(n_rows: int, line: tuple[float, float], n_columns: int, blur: float) -> float:
    """Depth of the strip: a quarter of the way down, as the surface may sink ahead of a pulse."""
    lowest = max(line[0], line[0] + line[1] * n_columns)
    room = n_rows - lowest
    depth = max(4.0 * blur + 4.0, 0.25 * room)
    if room - depth < _FEWEST_ROWS:
        raise InputError(
            f"the image ends {max(room, 0.0):.0f} px below the undeformed surface",
            key="region.rows",
            expected=f"at least {4.0 * blur + 4.0 + _FEWEST_ROWS:.0f} px of the sample's body",
            cure="give more rows on the side of the sample, or check calibration.x_axis and y_axis",
        )
    return depth


def _striker(appearance: Appearance, frames: Sequence[Image]) -> float | None:
    """Likeness of what stands left of the sample and is not background; None if nothing does.

    What looks like the sample itself is believed to be a striker only where the sample never is.
    """
    unlike_both: list[float] = []
    alike: list[float] = []
    outside = int(max(appearance.struck_end - 2 * appearance.clearance - _END_SPAN, 0.0))
    for image in frames:
        body = appearance.body(np.ascontiguousarray(image, dtype=np.float32))
        unlike = np.abs(body - 1.0) > NOT_LIKE
        last = int(min(appearance.held_end, body.size) - appearance.clearance)
        beside = np.flatnonzero(unlike[:last])
        left = body[: max(beside[-1] - _END_SPAN, 0)] if beside.size else body[:0]
        unlike_both.extend(left[(np.abs(left) > NOT_LIKE) & (np.abs(left - 1.0) > NOT_LIKE)])
        alike.extend(body[:outside][~unlike[:outside]])
    seen = max(unlike_both, alike, key=len)  # the blurred faces of a bright one are unlike both, and few
    return float(np.median(seen)) if len(seen) > 2 * _END_SPAN else None
