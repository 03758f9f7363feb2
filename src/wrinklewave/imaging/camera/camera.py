"""What the synthetic camera is: where it looks, how sharp, how long, how noisy."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wrinklewave.errors import InputError
from wrinklewave.units import engineering

if TYPE_CHECKING:
    import xarray as xr

MOST_PIXELS = 40_000_000
"""Of a frame, which is rendered as a whole; far beyond what high-speed cameras have."""
SMALLEST_BLUR = 0.3
LARGEST_TILT = math.radians(3.0)
POSITIVE = "a positive number"


@dataclass(frozen=True)
class Levels:
    """Brightness of what is in the picture, as fractions of the way from black to white level."""

    background: float = 0.70
    sample: float = 0.25
    striker: float = 0.45
    wire: float = 0.06


@dataclass(frozen=True, kw_only=True)
class Camera:
    """A camera that looks along the film at the edge of the surface.

    Attributes:
        shape: (height, width) of the image in pixels.
        scale: pixels per metre.
        origin: (column, row) where the upper corner of the struck end is before impact.
        tilt: angle by which the image of the sample is turned counter-clockwise [rad], at most 3 degrees. The
            faces of striker, sample end and wires stay along the columns.
        frame_rate: frames per second. exposure: time for which each frame collects light [s].
        blur: standard deviation of the optics' Gaussian blur [px], at least 0.3.
        levels: brightness of background, sample, striker and wires.
        gradient: relative change of the lighting across the image, along columns and along rows.
        full_well: electrons of a white pixel, which make the shot noise; infinite for none.
        read_noise: standard deviation of the sensor's own noise, as a fraction of black to white.
        bit_depth, black_level: of the grey values.
        seed: of the noise; the same seed gives the same frames, in any order.
    """

    shape: tuple[int, int]
    scale: float
    origin: tuple[float, float]
    tilt: float = 0.0
    frame_rate: float = 50e3
    exposure: float = 5e-6
    blur: float = 1.2
    levels: Levels = Levels()
    gradient: tuple[float, float] = (0.1, -0.05)
    full_well: float = 12e3
    read_noise: float = 0.0025
    bit_depth: int = 12
    black_level: int = 64
    seed: int = 0

    def __post_init__(self) -> None:
        for name, (holds, found, expected) in self._rules().items():
            if not holds:
                raise InputError(found, file="camera", key=name, expected=expected)

    def _rules(self) -> dict[str, tuple[bool, str, str]]:
        """By attribute: whether it holds, its value in words, what is expected."""
        height, width = self.shape
        between = 1 / self.frame_rate if self.frame_rate > 0 else 0.0
        return {
            "scale": _positive(self.scale, f"{self.scale * 1e-3:g} pixels per mm"),
            "shape": (
                min(self.shape) >= 8 and math.prod(self.shape) <= MOST_PIXELS,
                f"frames of {width} x {height} pixels",
                f"from 8 x 8 to {MOST_PIXELS / 1e6:g} million pixels: choose another scale",
            ),
            "blur": (
                self.blur >= SMALLEST_BLUR,
                f"{self.blur:g} px",
                f"at least {SMALLEST_BLUR} px: no lens is sharper",
            ),
            "tilt": (
                abs(self.tilt) <= LARGEST_TILT,
                f"{math.degrees(self.tilt):g} degrees",
                "at most 3 degrees",
            ),
            "frame_rate": _positive(self.frame_rate, f"{self.frame_rate:g} frames per second"),
            "exposure": (
                0 <= self.exposure <= between,
                engineering(self.exposure, "s"),
                f"from 0 to the time between frames, {engineering(between, 's')}",
            ),
            "bit_depth": (8 <= self.bit_depth <= 16, f"{self.bit_depth} bits", "8 to 16"),
            "black_level": (
                0 <= self.black_level < 2**self.bit_depth // 2,
                f"{self.black_level}",
                "well below the white level",
            ),
            "full_well": _positive(self.full_well, f"{self.full_well:g} electrons"),
            "read_noise": (self.read_noise >= 0, f"{self.read_noise:g}", "not negative"),
            "seed": (self.seed >= 0, f"{self.seed}", "not negative"),
        }

    @classmethod
    def framing(cls, surface: xr.Dataset, *, scale: float, margin: float = 2e-3, **others: object) -> Self:
        """A camera that sees all of a surface motion, with a margin [m] around it and the body below.

        Args:
            surface: the surface motion.
            scale: pixels per metre.
            others: further attributes of the camera.
        """
        if not 0 < scale < math.inf:
            raise InputError(f"{scale * 1e-3:g} pixels per mm", file="camera", key="scale", expected=POSITIVE)
        rise = float(np.nanmax(surface["u_y"].values, initial=0.0))
        fall = -float(np.nanmin(surface["u_y"].values, initial=0.0))
        width = (float(surface.attrs["length"]) + 2 * margin) * scale
        height = (rise + fall + 3 * margin) * scale
        shape = (8 * math.ceil(height / 8), 8 * math.ceil(width / 8))
        origin = (margin * scale, (rise + margin) * scale)
        return cls(shape=shape, scale=scale, origin=origin, **others)  # type: ignore[arg-type]

    @property
    def white_level(self) -> int:
        """Grey value at which pixels clip."""
        return (1 << self.bit_depth) - 1

    @property
    def contrast(self) -> float:
        """Step of brightness at the surface, as a fraction of black to white."""
        return abs(self.levels.sample - self.levels.background)

    @property
    def contrast_to_noise(self) -> float:
        """Step at the surface over the noise there (root mean square of both sides')."""
        return self.contrast / math.sqrt(self._edge_variance)

    def at_contrast_to_noise(self, ratio: float) -> Self:
        """The same camera with even noise (no shot noise) of the given contrast-to-noise ratio."""
        if not ratio > 0:
            raise InputError(f"{ratio:g}", file="camera", key="contrast_to_noise", expected=POSITIVE)
        return replace(self, full_well=math.inf, read_noise=self.contrast / ratio)

    def to_pixels(self, x: ArrayLike, y: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Column and row of points [m]: ``x`` from the struck end at rest, ``y`` from the surface at rest."""
        x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
        cos, sin = math.cos(self.tilt), math.sin(self.tilt)
        column = self.origin[0] + self.scale * (x * cos - y * sin)
        row = self.origin[1] - self.scale * (x * sin + y * cos)
        return column, row

    @property
    def _edge_variance(self) -> float:
        shot = 0.5 * (self.levels.sample + self.levels.background) / self.full_well
        return self.read_noise**2 + shot


def _positive(value: float, found: str) -> tuple[bool, str, str]:
    return value > 0, found, POSITIVE
