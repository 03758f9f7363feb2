"""What stands before the camera at any moment: the surface, the struck end, the striker, the wires."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wrinklewave.errors import InputError

if TYPE_CHECKING:
    import xarray as xr

Array = NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Striker:
    """A plate that flies at the sample, pushes it, and is stopped.

    Attributes:
        velocity: in flight [m/s].
        stop_distance: travel after contact at which the stoppers halt it [m].
        rise_time: time after contact in which its speed rises again from nothing to ``velocity``, along
            half a cosine as in the striker drive [s].
        height: how far it reaches above the undeformed surface [m].
    """

    velocity: float
    stop_distance: float
    rise_time: float = 0.0
    height: float = 1e-3

    def position(self, time: float) -> float:
        """Position of its face [m] at a time after contact [s]; before contact it flies at full speed."""
        if time <= 0:
            return self.velocity * time
        rising = min(time, self.rise_time)
        travel = self.velocity * (time - 0.5 * rising)
        if time < self.rise_time:
            travel -= (
                self.velocity * self.rise_time / (2 * math.pi) * math.sin(math.pi * time / self.rise_time)
            )
        return min(travel, self.stop_distance)


@dataclass(frozen=True, kw_only=True)
class Wires:
    """Thin wires that stand out of the surface at material points.

    Attributes:
        X: undeformed positions [m].
        width, length: of each [m].
    """

    X: tuple[float, ...]
    width: float = 0.15e-3
    length: float = 0.8e-3


@dataclass(frozen=True)
class Moment:
    """The scene at one time, in metres: x from the struck end's first place, y from the undeformed surface.

    Attributes:
        x, y: the visible surface, from the struck end to the held end, shape [n_samples], x increasing.
        striker: position of the striker's face.
        wire_x: positions of the wires, shape [n_wires].
    """

    x: Array
    y: Array
    striker: float
    wire_x: Array


class Scene:
    """A surface motion made continuous in space and time.

    Between the recorded times, heights and positions are cubic (four neighbours); left of the struck end and
    in gaps the surface is continued in a straight line, so that the moving end can be interpolated.

    Args:
        surface: a surface motion (its ``time`` 0 is the contact).
        striker: None for a sample that nothing touches.
        wires: None for none.

    Raises:
        InputError: if the surface cannot be seen at some time, or a wire lies outside the material points.
    """

    def __init__(self, surface: xr.Dataset, striker: Striker | None, wires: Wires | None) -> None:
        self.time = surface["time"].values
        self.length = float(surface.attrs["length"])
        self.striker, self.wires = striker, wires
        self._x = surface["x"].values
        heights = surface["y"].values - _undeformed_height(surface)
        self._y = np.stack([_continued(self._x, row, at) for row, at in zip(heights, self.time, strict=True)])
        self._end = self._x[np.flatnonzero(np.isfinite(heights).any(axis=0))[-1]]
        self._boundary = surface["x_boundary"].values
        if not np.isfinite(self._boundary).all():
            raise InputError("is not known at all times", key="x_boundary", expected="finite values")
        self._wire_x = _wire_paths(surface, wires)

    def at(self, time: float) -> Moment:
        """The scene at ``time`` [s]; before the first and after the last recorded time it stands still."""
        near, shares = _neighbours(self.time, time)
        boundary = float(shares @ self._boundary[near])
        heights = shares @ self._y[near]
        inside = (self._x > boundary + 0.1 * (self._x[1] - self._x[0])) & (self._x <= self._end)
        x = np.concatenate([[boundary], self._x[inside]])
        y = np.concatenate([[np.interp(boundary, self._x, heights)], heights[inside]])
        striker = self.striker.position(time) if self.striker else -math.inf
        return Moment(x, y, min(striker, boundary), shares @ self._wire_x[near])

    def speed(self, time: float, duration: float) -> float:
        """Greatest distance [m] that anything in the scene moves in ``duration`` around ``time``."""
        early, late = time - duration / 2, time + duration / 2
        (near_1, shares_1), (near_2, shares_2) = _neighbours(self.time, early), _neighbours(self.time, late)
        rise = np.abs(shares_2 @ self._y[near_2] - shares_1 @ self._y[near_1])[
            self._x > self._boundary[near_2].max()
        ]
        end = abs(shares_2 @ self._boundary[near_2] - shares_1 @ self._boundary[near_1])
        plate = abs(self.striker.position(late) - self.striker.position(early)) if self.striker else 0.0
        return float(max(rise.max(initial=0.0), end, plate))


def _undeformed_height(surface: xr.Dataset) -> float:
    """Height of the surface before it moves [m]: ``y`` less ``u_y``, wherever both are known."""
    return float(np.nanmedian((surface["y"] - surface["u_y"]).values))


def _continued(x: Array, heights: Array, at: float) -> Array:
    """Heights on the whole grid: gaps bridged, ends continued with their slope over their last few points."""
    known = np.flatnonzero(np.isfinite(heights))
    if known.size < 4:
        raise InputError(
            f"no surface is seen at {at * 1e3:.6g} ms", key="y", expected="heights along the sample"
        )
    first, last = known[0], known[-1]
    filled = np.interp(x, x[known], heights[known])
    slope = (heights[known[1]] - heights[first]) / (x[known[1]] - x[first])
    filled[:first] = heights[first] + slope * (x[:first] - x[first])
    slope = (heights[last] - heights[known[-2]]) / (x[last] - x[known[-2]])
    filled[last + 1 :] = heights[last] + slope * (x[last + 1 :] - x[last])
    return filled


def _wire_paths(surface: xr.Dataset, wires: Wires | None) -> Array:
    """Positions of the wires at the recorded times [m], shape [n_times, n_wires]."""
    if wires is None:
        return np.empty((surface.sizes["time"], 0))
    X = surface["X"].values
    for wire in wires.X:
        if not X[0] <= wire <= X[-1]:
            raise InputError(
                f"{wire * 1e3:.6g} mm",
                key="wires",
                expected=f"undeformed positions from {X[0] * 1e3:.6g} to {X[-1] * 1e3:.6g} mm",
            )
    return np.stack([np.interp(wires.X, X, row) for row in surface["x_p"].values])


def _neighbours(times: Array, time: float) -> tuple[slice, Array]:
    """Up to four recorded times around ``time`` and their shares in it (Lagrange's polynomial)."""
    if time <= times[0] or times.size == 1:
        return slice(0, 1), np.ones(1)
    if time >= times[-1]:
        return slice(times.size - 1, times.size), np.ones(1)
    after = int(np.searchsorted(times, time))
    first = max(0, min(after - 2, times.size - 4))
    near = times[first : first + 4]
    shares = np.ones(near.size)
    for i in range(near.size):
        for j in range(near.size):
            if i != j:
                shares[i] *= (time - near[j]) / (near[i] - near[j])
    return slice(first, first + near.size), shares
