"""Rendering blurred edges on pixels: exact down the columns, by close sampling along the rows.

A picture is a sum of layers. A layer is one edge line ``row(column)``: it adds ``amplitude(column)`` to
all that lies below. Blurred by a Gaussian of standard deviation s and integrated over a pixel of height 1, a
step at the distance u above the pixel's centre becomes

    E(u) = s [G((u + 1/2)/s) - G((u - 1/2)/s)],  G(t) = t Phi(t) + phi(t),

with the normal distribution Phi and density phi. Along the rows, blur and pixel make the smooth kernel
K(u) = Phi((u + 1/2)/s) - Phi((u - 1/2)/s), summed over sub-columns: for smooth lines this sum converges
faster than any power of their spacing. Where an amplitude jumps (the face of the sample, a wire), the
sub-columns beside the jump carry their share, which leaves its place exact and widens its blur a little.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numba import njit
from numpy.typing import NDArray

REACH = 5.0  # blurs beyond which a step has ended: Phi(-5) = 3e-7
PHASES = 128  # positions of an edge within a pixel; linear between them, good to 2e-5 of the step at s = 0.5
ROWS_AT_ONCE = 16

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Sampling:
    """Sub-columns of an image and the tables of one blur.

    Attributes:
        columns: positions of the sub-columns [px], shape [n_sub].
        per_pixel: sub-columns in a pixel.
        weights: kernel over the sub-columns around a pixel's centre, shape [n_taps].
        profile: E at the phases of an edge, shape [PHASES + 1, n_rows]; see ``_profile``.
        reach: rows of ``profile`` before the edge's own.
    """

    columns: Array
    per_pixel: int
    weights: NDArray[np.float32]
    profile: NDArray[np.float32]
    reach: int

    def coverage(self, first: float, last: float) -> Array:
        """Share of each sub-column that lies between two columns, shape [n_sub].

        Shares are linear in the distance over two sub-columns, so that mass and centre of mass are exact.
        """
        return self._beyond(first) - self._beyond(last)

    def _beyond(self, column: float) -> Array:
        """Share of each sub-column right of ``column``: a hat, one sub-column to either side, integrated."""
        t = np.clip((self.columns - column) * self.per_pixel, -1.0, 1.0)
        return 0.5 + t * (1.0 - 0.5 * np.abs(t))


def sub_columns(columns: Array, rows: Array, blur: float) -> int:
    """Sub-columns per pixel that render an edge through the given points to 5e-6 of its step.

    Seen along the row, an edge of slope m is a step of width blur/m; found by comparison with 64 per pixel
    for blurs of 0.3 to 3 px and slopes up to 6. Faces need a spacing under 0.4 blurs.
    """
    steepest = float(np.abs(np.diff(rows) / np.diff(columns)).max())
    needed = max(2.5, 0.62 * math.hypot(1.0, steepest)) / blur
    return min(64, math.ceil(needed))


@lru_cache(maxsize=16)
def sampling(width: int, blur: float, per_pixel: int) -> Sampling:
    """Sub-columns for an image of ``width`` pixels, ``per_pixel`` of them in each."""
    from scipy.special import ndtr

    pad = int(np.ceil(REACH * blur + 0.5))
    n_sub = (width + 2 * pad) * per_pixel
    columns = -0.5 - pad + (np.arange(n_sub) + 0.5) / per_pixel
    offsets = -0.5 - pad + (np.arange((2 * pad + 1) * per_pixel) + 0.5) / per_pixel
    weights = ndtr((offsets + 0.5) / blur) - ndtr((offsets - 0.5) / blur)
    weights = (weights / weights.sum()).astype(np.float32)
    reach = math.ceil(REACH * blur + 0.5)
    return Sampling(columns, per_pixel, weights, _profile(blur, reach), reach)


def _profile(blur: float, reach: int) -> NDArray[np.float32]:
    """E in the rows from ``-reach`` on of edges at 0, 1/PHASES, ... 1; shape [PHASES + 1, n_rows].

    The rows go on after the step has ended, to a number that processors like.
    """
    from scipy.special import ndtr

    def G(t: Array) -> Array:
        return t * ndtr(t) + np.exp(-0.5 * t**2) / np.sqrt(2 * np.pi)

    n_rows = ROWS_AT_ONCE * math.ceil((2 * reach + 2) / ROWS_AT_ONCE)
    u = np.arange(n_rows)[None, :] - reach - np.arange(PHASES + 1)[:, None] / PHASES
    return (blur * (G((u + 0.5) / blur) - G((u - 0.5) / blur))).astype(np.float32)


def add_layer(image: NDArray[np.float32], rows: Array, amplitudes: Array, at: Sampling) -> None:
    """Add one layer to ``image``.

    Args:
        image: shape [width, height]: columns first, so that what is done lies together in memory.
        rows: row of the edge at each sub-column [px], shape [n_sub]; finite where the amplitude is not zero.
        amplitudes: what is added below the edge, shape [n_sub].
        at: from ``sampling``.
    """
    _add_layer(image, rows, amplitudes, at.weights, at.profile, at.reach, at.per_pixel)


@njit(cache=True, nogil=True, error_model="numpy", fastmath=True)
def _add_layer(
    image: Any, rows: Any, amplitudes: Any, weights: Any, profile: Any, before: int, per_pixel: int
) -> None:
    width, height = image.shape
    phases, n_rows = profile.shape[0] - 1, profile.shape[1]
    n_taps = weights.size
    seen = np.zeros(rows.size + 1, dtype=np.intp)  # amplitudes other than zero before each sub-column
    for sub in range(rows.size):
        seen[sub + 1] = seen[sub] + (amplitudes[sub] != 0.0)
    # a column with room for edges beyond the image, and the steps that have ended, to be summed up downwards
    top, bottom = -float(n_rows), height + float(before)
    column = np.empty(height + 2 * n_rows + before + 1, dtype=np.float32)
    ended = np.empty_like(column)
    for c in range(width):
        start = c * per_pixel
        if seen[start + n_taps] == seen[start]:
            continue
        column[:] = 0.0
        ended[:] = 0.0
        for tap in range(n_taps):
            amplitude = weights[tap] * np.float32(amplitudes[start + tap])
            if amplitude == 0.0:
                continue
            edge = min(max(rows[start + tap], top + before), bottom)
            whole = int(np.floor(edge))
            position = (edge - whole) * phases
            phase = int(position)
            far = amplitude * np.float32(position - phase)
            near = amplitude - far
            first = whole - before + n_rows
            this, following = profile[phase], profile[phase + 1]
            part = column[first : first + n_rows]
            for row in range(n_rows):
                part[row] += near * this[row] + far * following[row]
            ended[first + n_rows] += amplitude
        total = np.float32(0.0)
        for row in range(n_rows):
            total += ended[row]
        for row in range(height):
            total += ended[row + n_rows]
            image[c, row] += column[row + n_rows] + total


@njit(cache=True, nogil=True, error_model="numpy", fastmath=True)
def digitise(light: Any, noise: Any, read_variance: float, shot: float, levels: Any, grey: Any) -> None:
    """Grey values of the sensor: noise of variance ``read_variance + shot * light``, rounded and clipped.

    Args:
        light: brightness from 0 to 1, shape [height, width].
        noise: standard normal numbers; for the shot noise they stand for Poisson's, near enough above some
            twenty electrons.
        read_variance, shot: see above, of the brightness.
        levels: black and white level.
        grey: the result, same shape.
    """
    black, white = np.float32(levels[0]), np.float32(levels[1])
    height, width = light.shape
    for row in range(height):
        for column in range(width):
            value = light[row, column]
            spread = np.sqrt(np.float32(read_variance) + np.float32(shot) * max(value, np.float32(0.0)))
            value = black + (white - black) * (value + spread * noise[row, column])
            grey[row, column] = int(min(max(value, np.float32(0.0)), white) + np.float32(0.5))
