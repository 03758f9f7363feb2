"""Columns side by side: two steps towards the edge of each, in vector instructions.

Single precision is enough, because rows are counted from the first pixel looked at: with the approximations of
``normal_distribution`` it moves an edge by less than 1e-4 px.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from wrinklewave._jit import allocating, in_single_precision, uintp, vector
from wrinklewave.imaging.arrays import Floats, Pixels
from wrinklewave.imaging.edges.profile import normal_distribution

LANES = 64
_LARGEST_STEP = 1.0  # px
_GAINS = 0.3, 2.5  # of a secant's step over a Gauss-Newton step, at least and at most
_LEAST = 1e-12  # against division by zero


class Lanes(NamedTuple):
    """Columns side by side, shape [LANES], in single precision: rows are counted from the first pixel looked at.

    Attributes:
        greys: of the pixels, shape [depth, LANES].
        depth: number of pixels. blur: down the column [px]. at: row of the edge. moved, proposed: the last step [px].
        dark, dark_slope: grey value above the edge, at the first pixel and per pixel.
        height, height_slope: grey value below the edge less that above, likewise.
        slope, information, squares: sums over the pixels of t r / s^2, t^2 / s^2 and r^2; sensitivity t = dI/dy,
            residual r, noise s. first_squares: before the first step.
        lower, lower_integral: Phi and G at the upper end of a pixel.
    """

    greys: Pixels
    depth: Pixels
    blur: Pixels
    at: Pixels
    moved: Pixels
    proposed: Pixels
    dark: Pixels
    dark_slope: Pixels
    height: Pixels
    height_slope: Pixels
    slope: Pixels
    information: Pixels
    squares: Pixels
    first_squares: Pixels
    lower: Pixels
    lower_integral: Pixels


@allocating
def empty_lanes(depth: int) -> Lanes:
    """For columns of at most ``depth`` pixels."""
    greys, rest = np.zeros((depth, LANES), np.float32), np.ones((15, LANES), np.float32)
    return Lanes(
        greys,
        rest[0],
        rest[1],
        rest[2],
        rest[3],
        rest[4],
        rest[5],
        rest[6],
        rest[7],
        rest[8],
        rest[9],
        rest[10],
        rest[11],
        rest[12],
        rest[13],
        rest[14],
    )


@allocating
def take_two_steps(lanes: Lanes, depth: int, noise: Floats) -> None:
    """Of ``depth`` pixels or fewer; ``noise`` above and below the edge, shape [2]."""
    _two_steps_in_single_precision(
        lanes.greys[:depth],
        lanes.depth,
        lanes.blur,
        lanes.at,
        lanes.moved,
        lanes.proposed,
        lanes.dark,
        lanes.dark_slope,
        lanes.height,
        lanes.height_slope,
        lanes.slope,
        lanes.information,
        lanes.squares,
        lanes.first_squares,
        lanes.lower,
        lanes.lower_integral,
        np.float32(noise[0] ** 2),
        np.float32(noise[1] ** 2 - noise[0] ** 2),
    )


@vector
def _two_steps(
    greys: Pixels,
    depth: Pixels,
    blur: Pixels,
    at: Pixels,
    moved: Pixels,
    proposed: Pixels,
    dark: Pixels,
    dark_slope: Pixels,
    height: Pixels,
    height_slope: Pixels,
    slope: Pixels,
    information: Pixels,
    squares: Pixels,
    first_squares: Pixels,
    lower: Pixels,
    lower_integral: Pixels,
    variance: float,
    variance_step: float,
) -> None:
    """A Gauss-Newton step, and one whose length is the secant's between two proposals, within reason."""
    for turn in range(2):
        for c in range(uintp(LANES)):
            slope[c], information[c], squares[c] = 0.0, 0.0, 0.0
            lower[c], lower_integral[c] = normal_distribution((-0.5 - at[c]) / blur[c])
        y = 0.0
        for j in range(uintp(greys.shape[0])):
            for c in range(uintp(LANES)):
                upper, upper_integral = normal_distribution((y + 0.5 - at[c]) / blur[c])
                share = blur[c] * (upper_integral - lower_integral[c])
                contrast = height[c] + height_slope[c] * y
                difference = greys[j, c] - dark[c] - dark_slope[c] * y - contrast * share
                difference = difference if y < depth[c] else 0.0
                sensitivity = contrast * (lower[c] - upper)
                sensitivity = sensitivity if y < depth[c] else 0.0
                weighted = sensitivity / (variance + variance_step * share)
                slope[c] += weighted * difference
                information[c] += weighted * sensitivity
                squares[c] += difference * difference
                lower[c], lower_integral[c] = upper, upper_integral
            y += 1.0
        for c in range(uintp(LANES)):
            step = slope[c] / max(information[c], _LEAST)
            if turn == 0:
                first_squares[c] = squares[c]
                gain = 1.0
            else:
                change = proposed[c] - step
                gain = min(max(moved[c] * change / (change * change + _LEAST), _GAINS[0]), _GAINS[1])
            moved[c] = min(max(gain * step, -_LARGEST_STEP), _LARGEST_STEP)
            at[c] += moved[c]
            proposed[c] = step


_two_steps_in_single_precision = in_single_precision(_two_steps)
