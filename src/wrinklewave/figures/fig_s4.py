"""Fig. S4: stress, and the critical strain on a substrate of the momentary modulus."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.overlays import draw_boundary, draw_speed, frame
from wrinklewave.figures.style import MILLI, Margins, legend_above, new_figure, panel_letter, space_time_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def _possible(inputs: FigureInputs) -> bool:
    strains = inputs.analysis.strains
    return strains is not None and strains.momentary_critical_strain_seen is not None


@FIGURES.figure(
    "fig_s4_momentary_critical_strain",
    number="S4",
    caption="(A) Depth-averaged nominal stress. (B) Critical strain of the film on a substrate whose "
    "modulus is the ratio of depth-averaged stress and strain, over its quasi-static value "
    "(logarithmic). (C) Strain over that critical strain; wrinkles are expected beyond the white "
    "line, where it passes 1. Grey: hardly any strain, or stress and strain of opposite sign. "
    "Dashed: wavefront.",
    possible=_possible,
)
def momentary_critical_strain(inputs: FigureInputs) -> Figure:
    """Three maps."""
    subject, strains = inputs.subject, inputs.analysis.strains
    assert strains is not None  # by `possible`
    assert strains.stress_seen is not None
    assert strains.momentary_critical_strain_seen is not None
    assert subject.critical_strain is not None
    critical = strains.momentary_critical_strain_seen
    ratio = strains.strain_seen / critical
    kilopascal = 1e-3 * strains.stress_seen
    stiffening = np.log10(critical / subject.critical_strain)
    highest = float(np.nanpercentile(np.abs(kilopascal), 99.5))
    panels = (
        (kilopascal, "stress (kPa)", "RdBu_r", (-highest, highest), "both"),
        (stiffening, "$\\log_{10}(\\epsilon_c(t) / \\epsilon_c)$", "viridis", (-0.5, 1.5), "both"),
        (ratio, "$\\epsilon_{xx} / \\epsilon_c(t)$", "viridis", (0.0, 3.0), "max"),
    )
    drawing, rows = new_figure(
        6.3, 8.4, rows=3, sharex=True, margins=Margins(left=0.7, right=1.0, top=0.5, between_rows=0.4)
    )
    for axes, letter, (values, label, colours, limits, extend) in zip(rows, "ABC", panels, strict=True):
        space_time_map(
            axes, subject.x, subject.time, values, label=label, cmap=colours, limits=limits, extend=extend
        )
        draw_boundary(axes, inputs)
        draw_speed(axes, inputs.analysis.pulse.wavefront, inputs, name="wavefront")
        panel_letter(axes, letter)
        frame(axes, inputs)
    if np.fmax.reduce(ratio, axis=None) > 1.0:
        rows[2].contour(
            MILLI * subject.x, MILLI * subject.time, ratio, levels=[1.0], colors="white", linewidths=0.8
        )
    legend_above(rows[0])
    for axes in rows[:2]:
        axes.set_xlabel("")
    return drawing
