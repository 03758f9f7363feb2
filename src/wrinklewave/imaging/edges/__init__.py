"""The sample's edge in a frame: found roughly, then column by column, then regularised along the surface."""

from wrinklewave.imaging.edges.detect import RESOLUTION, Edge, EdgeFinder, Optics

__all__ = ["RESOLUTION", "Edge", "EdgeFinder", "Optics"]
