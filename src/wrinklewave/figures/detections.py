"""What was detected, drawn on the frames it was detected in; and whether edges are drawn towards the pixels."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wrinklewave.figures.style import BOUNDARY_COLOUR, RC, new_figure
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, CAPTION, GAP = 10.0, 0.42, 0.08  # inches
CAPTION_SIZE = 14.0  # points: a page shows these wide figures smaller than others
SURFACE_COLOUR, WIRE_COLOUR = "#ffb000", "#4db8ff"


@dataclass(frozen=True)
class Detection:
    """A frame and what was found in it; columns and rows in pixels.

    Attributes:
        image: grey values, shape [height, width].
        caption: which frame it is.
        surface: columns and rows of the free surface, shape [2, n].
        struck_end: its column; NaN if not seen.
        wires: columns and rows where wires leave the surface, shape [2, n_wires].
    """

    image: NDArray[np.uint8] | NDArray[np.uint16]
    caption: str
    surface: Array
    struck_end: float
    wires: Array


def detections_figure(detections: Sequence[Detection]) -> Figure:
    """Frames below each other with the detected surface, struck end and wires."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    height, width = detections[0].image.shape
    each = (WIDTH - 2 * GAP) * height / width + CAPTION
    total = each * len(detections) + GAP
    low, high = np.percentile([d.image for d in detections], (0.1, 99.9))
    with matplotlib.rc_context(RC):
        figure = Figure(figsize=(WIDTH, total))
        FigureCanvasAgg(figure)
        for place, detection in enumerate(detections):
            bottom = total - (place + 1) * each
            box = (GAP / WIDTH, bottom / total, 1 - 2 * GAP / WIDTH, (each - CAPTION) / total)
            axes = figure.add_axes(box)
            axes.imshow(detection.image, cmap="gray", vmin=low, vmax=high, interpolation="antialiased")
            axes.set_title(detection.caption, loc="left", fontsize=CAPTION_SIZE, pad=4)
            axes.set_axis_off()
            _draw(axes, detection)
    return figure


def _draw(axes: Axes, detection: Detection) -> None:
    axes.plot(*detection.surface, color=SURFACE_COLOUR, lw=1.2)
    if np.isfinite(detection.struck_end):
        axes.axvline(detection.struck_end, color=BOUNDARY_COLOUR, lw=1.2, ls="--")
    axes.plot(*detection.wires, "o", ms=6, mfc="none", color=WIRE_COLOUR)
    height, width = detection.image.shape
    axes.set(xlim=(-0.5, width - 0.5), ylim=(height - 0.5, -0.5))


def locking_figure(mean: Array, sigma: Array) -> Figure:
    """Mean residual of the columns against where between two rows of pixels the surface lies.

    Args:
        mean, sigma: residual and its standard uncertainty in even bins of the phase [px], shape [n_bins].
    """
    import matplotlib

    phase = (np.arange(mean.size) + 0.5) / mean.size
    with matplotlib.rc_context(RC):
        drawing, axes = new_figure(5.2, 2.6)
        axes.errorbar(phase, 1e3 * mean, 1e3 * sigma, fmt="o", ms=4, color="black", capsize=2)
        axes.axhline(0.0, color="0.7", lw=0.8, zorder=0)
        axes.set(
            xlabel="place between two rows of pixels (px)",
            ylabel="column less surface ($10^{-3}$ px)",
            xlim=(0.0, 1.0),
        )
    return drawing
