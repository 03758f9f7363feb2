"""Fig. 1A to C: the sample below and above the critical strain, and at the largest, with the surface that was found."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.compression.registry import CompressionInputs, compression_figure
from wrinklewave.figures.style import BOUNDARY_COLOUR

if TYPE_CHECKING:
    from matplotlib.figure import Figure

WIDTH, GAP, CAPTION = 6.8, 0.08, 0.24  # inches


@compression_figure(
    "fig_1abc_images",
    number="1A-C",
    caption="The side with the film, compressed slowly; red: the surface that was found. Strains are those along the "
    "arc.",
    possible=lambda inputs: bool(inputs.images),
)
def compressed_images(inputs: CompressionInputs) -> Figure:
    """Images one above the other, each with its strain."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = inputs.images[0].image.shape
    each = (WIDTH - 2 * GAP) * height / width + CAPTION
    total = each * len(inputs.images) + GAP
    figure = Figure(figsize=(WIDTH, total))
    FigureCanvasAgg(figure)
    for place, (shown, letter) in enumerate(zip(inputs.images, "ABCDEF", strict=False)):
        bottom = total - (place + 1) * each
        axes = figure.add_axes((GAP / WIDTH, bottom / total, 1 - 2 * GAP / WIDTH, (each - CAPTION) / total))
        low, high = np.percentile(shown.image, [0.1, 99.9])
        axes.imshow(shown.image, cmap="gray", vmin=low, vmax=high, interpolation="antialiased")
        axes.plot(np.arange(width), shown.rows, color=BOUNDARY_COLOUR, lw=0.8)
        axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))
        axes.set_axis_off()
        axes.set_title(f"{letter}   $\\epsilon$ = {shown.strain:.3f}", loc="left", pad=2)
    return figure
