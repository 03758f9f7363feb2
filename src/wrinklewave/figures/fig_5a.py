"""Fig. 5A: strain along the curved surface against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import MILLI, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_5a_arc_strain",
    number="5A",
    caption="Mean strain along the curved surface, 1 - s/L0 with s the arc length without wrinkles, over "
    "the critical strain. Dotted: strain when the striker has come to rest; grey: motion of the "
    "end over the length.",
    possible=lambda inputs: inputs.analysis.quasi_static is not None,
)
def arc_strain_figure(inputs: FigureInputs) -> Figure:
    """Arc strain over eps_c."""
    subject, expected = inputs.subject, inputs.analysis.quasi_static
    assert expected is not None  # by `possible`
    time = MILLI * subject.time
    drawing, axes = new_figure(5.2, 2.8)
    end_strain = inputs.analysis.boundary.displacement / subject.length
    axes.plot(time, end_strain / expected.critical_strain, color="0.65", lw=1.0, label="end motion / $L_0$")
    axes.plot(
        time,
        inputs.analysis.pulse.arc_strain / expected.critical_strain,
        color="black",
        label="along the arc",
    )
    axes.axhline(
        expected.strain_at_rest / expected.critical_strain,
        color="#0000a7",
        ls=":",
        label=f"$\\epsilon_R$ = {expected.strain_at_rest:.3f}",
    )
    axes.set(xlabel="time (ms)", ylabel="$\\epsilon / \\epsilon_c$", xlim=(time[0], time[-1]))
    axes.legend(loc="lower right")
    return drawing
