"""Fig. S5: the strain corrected for the curvature of the surface."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import COLOURS, MILLI, Margins, legend_above, new_figure, panel_letter

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_s5_curvature",
    number="S5",
    caption="(A) The surface without wrinkles at a few times; dots: struck end. Its length s along the arc is more "
    "than the straight distance to the held end. (B) Strain from the arc, 1 - s/L0, and from the motion of the "
    "end alone, U/L0; grey: their difference.",
    possible=lambda inputs: inputs.surface_moves and bool(inputs.times),
)
def curvature_figure(inputs: FigureInputs) -> Figure:
    """Surface profiles, and both strains against time."""
    subject, pulse = inputs.subject, inputs.analysis.pulse
    drawing, (profiles, strains) = new_figure(
        6.3, 5.3, rows=2, margins=Margins(left=0.75, top=0.42, between_rows=0.75)
    )
    for colour, wanted in zip(COLOURS, inputs.times, strict=False):
        row = int(np.abs(subject.time - wanted).argmin())
        label = f"$t$ = {MILLI * subject.time[row]:.3g} ms, $\\epsilon$ = {pulse.arc_strain[row]:.3f}"
        profiles.plot(MILLI * subject.x, MILLI * pulse.displacement[row], color=colour, label=label)
        end, known = subject.x_boundary[row], np.flatnonzero(np.isfinite(pulse.displacement[row]))
        if np.isfinite(end) and known.size:
            profiles.plot(MILLI * end, MILLI * pulse.displacement[row, known[0]], "o", ms=4, color=colour)
    profiles.set(xlabel="position $x$ (mm)", ylabel="height over rest (mm)")
    legend_above(profiles)
    time, straight = MILLI * subject.time, inputs.analysis.boundary.displacement / subject.length
    strains.plot(time, pulse.arc_strain, color="black", label="along the arc")
    strains.plot(time, straight, "--", color=COLOURS[1], label="from the end's motion")
    strains.plot(time, straight - pulse.arc_strain, color="0.65", lw=1.0, label="difference")
    strains.set(xlabel="time (ms)", ylabel="strain", xlim=(time[0], time[-1]))
    strains.legend(loc=(0.6, 0.22))
    for axes, letter in ((profiles, "A"), (strains, "B")):
        panel_letter(axes, letter)
    return drawing
