"""Fig. 2C: out-of-plane displacement of the surface over position and time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.overlays import draw_boundary, draw_material_points, draw_speed, frame
from wrinklewave.figures.style import MAP_MARGINS, legend_above, new_figure, space_time_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_2c_displacement",
    number="2C",
    caption="Out-of-plane displacement of the surface in the laboratory, wrinkles included, over its "
    "maximum (scale cut at -0.25). Dashed red: struck end; white: wavefront, free line (dashed) "
    "and line through the origin (dotted); dash-dotted: paths of material points.",
    possible=lambda inputs: inputs.surface_moves,
    measured=("fig_2b_displacement", "2B"),
)
def displacement_map(inputs: FigureInputs) -> Figure:
    """Map of U_y / U_y,max with the struck end, the speed lines and material points."""
    subject = inputs.subject
    highest = np.fmax.reduce(subject.u_y, axis=None)
    drawing, axes = new_figure(6.3, 4.4, margins=MAP_MARGINS)
    space_time_map(
        axes,
        subject.x,
        subject.time,
        subject.u_y / max(highest, np.finfo(float).tiny),
        label="$U_y / U_{y,\\mathrm{max}}$",
        cmap="viridis",
        limits=(-0.25, 1.0),
        extend="min",
    )
    draw_boundary(axes, inputs)
    draw_material_points(axes, inputs)
    draw_speed(axes, inputs.analysis.pulse.wavefront, inputs, name="wavefront")
    frame(axes, inputs)
    legend_above(axes)
    return drawing
