"""Fig. 4D: depth-averaged strain over the critical strain."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.overlays import draw_boundary, draw_material_points, draw_speed, frame
from wrinklewave.figures.style import MAP_MARGINS, MILLI, legend_above, new_figure, outlined, space_time_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_4d_strain",
    number="4D",
    caption="Depth-averaged nominal strain over the film's critical strain; wrinkles form beyond the thin"
    " line, where the ratio is 1. White: wavefront.",
    possible=lambda inputs: (
        inputs.analysis.strains is not None and inputs.subject.critical_strain is not None
    ),
)
def strain_map(inputs: FigureInputs) -> Figure:
    """Map of the strain, with its critical value as a contour."""
    subject, strains = inputs.subject, inputs.analysis.strains
    assert strains is not None  # by `possible`
    assert subject.critical_strain is not None
    ratio = strains.strain_seen / subject.critical_strain
    drawing, axes = new_figure(6.3, 4.4, margins=MAP_MARGINS)
    space_time_map(
        axes,
        subject.x,
        subject.time,
        ratio,
        label="$\\epsilon_{xx} / \\epsilon_c$",
        cmap="viridis",
        limits=(0.0, max(float(np.nanpercentile(ratio, 99.5)), 1.0)),
        extend="both",
    )
    if np.fmax.reduce(ratio, axis=None) > 1.0:
        axes.contour(
            MILLI * subject.x, MILLI * subject.time, ratio, levels=[1.0], colors="white", linewidths=0.7
        )
        axes.plot(
            [], [], color="white", lw=0.9, path_effects=outlined(0.9), label="$\\epsilon_{xx} = \\epsilon_c$"
        )
    draw_boundary(axes, inputs)
    draw_material_points(axes, inputs)
    draw_speed(axes, inputs.analysis.pulse.wavefront, inputs, name="wavefront")
    frame(axes, inputs)
    legend_above(axes)
    return drawing
