"""From pixels of turned frames to metres on the sample, and back."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.errors import InputError
from wrinklewave.imaging.appearance import Appearance
from wrinklewave.imaging.arrays import Floats

if TYPE_CHECKING:
    from wrinklewave.config.experiment import Experiment


@dataclass(frozen=True)
class PixelMap:
    """Where pixels lie on the sample: x along the undeformed surface from its struck end, y out of the sample.

    Attributes:
        pixel_size: [m].
        origin: (column, row) of the struck end's corner at rest.
        tilt: angle by which the undeformed surface is turned counter-clockwise in the image [rad].
        height: y of the undeformed surface [m].
    """

    pixel_size: float
    origin: tuple[float, float]
    tilt: float
    height: float = 0.0

    def to_metres(self, column: ArrayLike, row: ArrayLike) -> tuple[Floats, Floats]:
        """x and y [m] of places in the image."""
        right = np.asarray(column, dtype=float) - self.origin[0]
        up = self.origin[1] - np.asarray(row, dtype=float)
        cos, sin = np.cos(self.tilt), np.sin(self.tilt)
        return self.pixel_size * (right * cos + up * sin), self.height + self.pixel_size * (
            up * cos - right * sin
        )

    def to_pixels(self, x: ArrayLike, y: ArrayLike) -> tuple[Floats, Floats]:
        """Column and row of places on the sample [m]."""
        along = np.asarray(x, dtype=float) / self.pixel_size
        out = (np.asarray(y, dtype=float) - self.height) / self.pixel_size
        cos, sin = np.cos(self.tilt), np.sin(self.tilt)
        return self.origin[0] + along * cos - out * sin, self.origin[1] - along * sin - out * cos


def calibrate(experiment: Experiment, appearance: Appearance, struck_end: float) -> PixelMap:
    """The map of an experiment's pixels, from its calibration and the sample at rest.

    The undeformed surface is the x-axis, wherever it points in the image.

    Args:
        experiment: with the calibration.
        appearance: of the sample at rest.
        struck_end: column of its struck end at rest; not finite if that is out of sight.

    Raises:
        InputError: if the scale is to be taken from the sample and its ends are not both seen.
    """
    row, slope = appearance.line
    tilt = -float(np.arctan(slope))
    if not np.isfinite(struck_end):
        raise InputError(
            "the struck end of the sample is not seen in the undeformed frames",
            key="region.columns",
            expected="frames that show the struck end at rest",
            cure="check calibration.x_axis and y_axis, and give more columns",
        )
    return PixelMap(
        pixel_size=_pixel_size(experiment, (struck_end, appearance.held_end), tilt),
        origin=(struck_end, row + slope * struck_end),
        tilt=tilt,
        height=0.5 * (experiment.sample.height or 0.0),
    )


def _pixel_size(experiment: Experiment, seen: tuple[float, float], tilt: float) -> float:
    calibration = experiment.calibration
    if calibration.kind != "sample-length":
        return calibration.pixel_size
    ends = calibration.ends or seen
    columns = abs(ends[1] - ends[0])
    if not np.isfinite(columns):
        raise InputError(
            "the ends of the sample are not both seen in the undeformed frames",
            key="calibration",
            expected="both ends of the sample in the frame",
            cure='give calibration.ends, or calibrate by kind = "scale" or "two-points"',
        )
    return experiment.sample.length * float(np.cos(tilt)) / columns
