"""Fig. 4C: magnitude of the depth-averaged strain rate over position and time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.overlays import draw_boundary, draw_material_points, draw_speed, frame
from wrinklewave.figures.style import MAP_MARGINS, legend_above, new_figure, space_time_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN_RATE = 300.0


@FIGURES.figure(
    "fig_4c_strain_rate",
    number="4C",
    caption="Magnitude of the depth-averaged nominal strain rate, cut at 300 /s as in the paper where it "
    "is more. White: wavefront; grey dash-dotted: paths of material points.",
    possible=lambda inputs: inputs.analysis.strains is not None,
)
def strain_rate_map(inputs: FigureInputs) -> Figure:
    """Map of the strain rate."""
    subject, strains = inputs.subject, inputs.analysis.strains
    assert strains is not None  # by `possible`
    rate = np.abs(strains.rate_seen)
    highest = float(max(np.fmax.reduce(rate, axis=None), 1e-12))
    drawing, axes = new_figure(6.3, 4.4, margins=MAP_MARGINS)
    space_time_map(
        axes,
        subject.x,
        subject.time,
        rate,
        label="$|\\dot{\\epsilon}_{xx}|$ (1/s)",
        cmap="inferno",
        limits=(0.0, min(highest, SHOWN_RATE)),
        extend="max" if highest > SHOWN_RATE else "neither",
    )
    draw_boundary(axes, inputs)
    draw_material_points(axes, inputs, colour="silver")
    draw_speed(axes, inputs.analysis.pulse.wavefront, inputs, name="wavefront")
    frame(axes, inputs)
    legend_above(axes)
    return drawing
