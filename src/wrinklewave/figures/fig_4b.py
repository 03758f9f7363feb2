"""Fig. 4B: wrinkles over position and time, the pulse taken away."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.overlays import draw_boundary, draw_material_points, draw_speed, frame
from wrinklewave.figures.style import MAP_MARGINS, legend_above, new_figure, space_time_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_4b_wrinkles",
    number="4B",
    caption="Out-of-plane surface wrinkling after removal of the low-frequency pulse. Magenta: the wrinkle "
    "front (amplitude passes the threshold); green: the wavefront; dash-dotted: paths of material"
    " points.",
    possible=lambda inputs: inputs.surface_moves,
    measured=("fig_4a_wrinkles", "4A"),
)
def wrinkle_map(inputs: FigureInputs) -> Figure:
    """Map of the height of the wrinkles."""
    subject, wrinkles = inputs.subject, inputs.analysis.wrinkles
    scale = 1e6 * max(np.nanpercentile(np.abs(wrinkles.height), 99.0), 1e-6)
    drawing, axes = new_figure(6.3, 4.4, margins=MAP_MARGINS)
    space_time_map(
        axes,
        subject.x,
        subject.time,
        1e6 * wrinkles.height,
        label="$u_y$ (µm)",
        cmap="RdBu_r",
        limits=(-scale, scale),
        extend="both",
    )
    draw_boundary(axes, inputs)
    draw_material_points(axes, inputs)
    draw_speed(axes, wrinkles.front, inputs, name="wrinkles", colour="#ff40ff")
    draw_speed(
        axes, inputs.analysis.pulse.wavefront, inputs, name="wavefront", colour="#7cfc00", origin=False
    )
    frame(axes, inputs)
    legend_above(axes)
    return drawing
