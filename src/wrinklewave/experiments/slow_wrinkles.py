"""A resolved film in slow compression between frictionless guides: onset, amplitude and period doubling.

Between guides a film of length L holds the modes cos(n pi X / L). Each of them grows by itself until wrinkles become
large, and diverges at the critical strain of its own wavelength: 1/A falls linearly to zero there.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.laboratory_frame import Array

NEAR_ONSET = (0.8, 0.96)
"""Strains over the smallest critical one, found without it, at which the growth of the modes is extrapolated."""
WRINKLED = 0.06
"""Strain from which on there are wrinkles beside which others can be measured."""
DOUBLING = 0.1
"""A mode of twice the wavelength is there when it has this part of the wrinkles' amplitude."""


@dataclass(frozen=True)
class Modes:
    """Wrinkles between guides, mode by mode.

    Args:
        strain: nominal, compression > 0, shape [n_times].
        amplitudes: of the modes cos(n pi X / L), n = 0, 1, ... [m], shape [n_modes, n_times].
        length: L [m].
    """

    strain: Array
    amplitudes: Array
    length: float

    def loading(self) -> Modes:
        """The part up to the largest strain."""
        last = int(self.strain.argmax()) + 1
        return Modes(self.strain[:last], self.amplitudes[:, :last], self.length)

    def wavelength(self, mode: float) -> float:
        """Undeformed [m]."""
        return 2 * self.length / mode


def modes(surface: xr.Dataset, *, most: int = 24) -> Modes:
    """Modes of the surface up to number ``most``."""
    X, height = surface["X"].values, surface["y_p"].values
    length = float(X[-1])
    shapes = np.cos(np.pi * np.arange(most + 1)[:, np.newaxis] * X / length)
    amplitudes = 2 / length * np.trapezoid((height - height[:1].mean()) * shapes[:, np.newaxis], X, axis=-1)
    return Modes(surface["x_p"].values[:, 0] / length, amplitudes, length)


def critical_strains(wrinkles: Modes, numbers: Array, *, near: float) -> Array:
    """Critical strain of the modes ``numbers``, by extrapolation of 1/A from strains just below ``near``."""
    low, high = (part * near for part in NEAR_ONSET)
    used = (wrinkles.strain > low) & (wrinkles.strain < high)
    found = []
    for number in numbers.astype(int):
        slope, offset = np.polyfit(wrinkles.strain[used], 1.0 / wrinkles.amplitudes[number, used], 1)
        found.append(-offset / slope)
    return np.array(found)


def onset(numbers: Array, strains: Array) -> tuple[float, float]:
    """Smallest critical strain and its mode number, by a parabola through the three smallest."""
    lowest = int(np.clip(strains.argmin(), 1, strains.size - 2))
    near = slice(lowest - 1, lowest + 2)
    a, b, c = np.polyfit(numbers[near], strains[near], 2)
    mode = -b / (2 * a)
    return float(c + mode * (b + a * mode)), float(mode)


def doubling_strains(wrinkles: Modes, mode: int) -> tuple[float, float]:
    """Strains at which wrinkles of twice the wavelength of ``mode`` appear in loading, and are gone in unloading.

    NaN for what does not happen.
    """
    share = np.abs(wrinkles.amplitudes[mode // 2]) > DOUBLING * np.abs(wrinkles.amplitudes[mode])
    share &= wrinkles.strain > WRINKLED
    there = np.flatnonzero(share)
    if not there.size:
        return float("nan"), float("nan")
    gone = there[-1] + 1
    last = float(wrinkles.strain[gone]) if gone < share.size else float("nan")
    return float(wrinkles.strain[there[0]]), last
