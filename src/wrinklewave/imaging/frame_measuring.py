"""Everything that is measured in one frame, in pixels, from the frame alone."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from wrinklewave.imaging.appearance import Appearance
from wrinklewave.imaging.boundary import StruckEnd, find_struck_end
from wrinklewave.imaging.corner import with_corner
from wrinklewave.imaging.edges import RESOLUTION, Edge, EdgeFinder
from wrinklewave.imaging.edges.locking import PixelLocking
from wrinklewave.imaging.frames import Image
from wrinklewave.imaging.wires import NO_WIRES, WireLook, WireSightings, find_wires, hidden_by_wires


@dataclass(frozen=True)
class FrameMeasurement:
    """What one frame shows.

    Attributes:
        edge: the free surface.
        end: struck end and striker.
        wires: probe wires; none if none are asked for.
        locking: residuals of the columns against the sub-pixel phase.
    """

    edge: Edge
    end: StruckEnd
    wires: WireSightings
    locking: PixelLocking


class FrameMeasurer:
    """Measures frames of one recording, each on its own, from any number of threads.

    Args:
        appearance: of the recording at rest.
        wires: what its wires look like; None if there are none.
        resolution: shortest wavelength to keep along the surface [px].
    """

    def __init__(
        self, appearance: Appearance, *, wires: WireLook | None = None, resolution: float = RESOLUTION
    ) -> None:
        self.appearance, self.wires = appearance, wires
        self.finder = EdgeFinder(appearance.optics, resolution=resolution)

    def measure(self, frame: Image) -> FrameMeasurement:
        """Measure a frame, shape [height, width], the sample below its surface and the struck end on the left."""
        image = np.ascontiguousarray(frame, dtype=np.float32)
        look = self.appearance
        coarse = self.finder.coarse(image)
        end = find_struck_end(image, coarse, look)
        first = int(np.ceil(end.column + look.clearance)) if np.isfinite(end.column) else 0
        stop = int(min(look.held_end - look.clearance + 1, image.shape[1]))
        rough = self.finder.rough(image, coarse, first=first, stop=stop)
        wires, hidden = NO_WIRES, None
        if self.wires is not None and np.isfinite(rough.rows).any():
            wires = find_wires(image, rough.rows, look, self.wires)
            hidden = hidden_by_wires(wires, self.wires, image.shape[1])
        edge = self.finder.fine(image, rough, hidden)
        locking = PixelLocking.of(edge.rows, np.where(edge.valid, edge.column_rows - edge.rows, np.nan))
        return FrameMeasurement(edge, with_corner(end, image, edge, look), wires, locking)
