"""Fig. 1A to C: the sample below and above the critical strain, and at the largest, with the surface that was found."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.figures.compression.inputs import COMPRESSION_FIGURES, CompressionInputs
from wrinklewave.figures.detections import detections_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@COMPRESSION_FIGURES.figure(
    "fig_1abc_images",
    number="1A-C",
    caption="The side with the film, compressed slowly: below the critical strain, above it, and most of all. Orange: "
    "the surface that was found; dashed red: the end that moves. Strains are those along the arc.",
    possible=lambda inputs: bool(inputs.images),
)
def compressed_images(inputs: CompressionInputs) -> Figure:
    """Images one above the other."""
    return detections_figure(inputs.images)
