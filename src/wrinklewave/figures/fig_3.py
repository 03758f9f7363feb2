"""Fig. 3: displacement against time at a few positions, and against position at a few times."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import COLOURS, MILLI, Margins, new_figure, panel_letter

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_3_curves",
    number="3",
    caption="Out-of-plane displacement over its maximum (A) against time at fixed laboratory positions, "
    "(B) against position at fixed times.",
    possible=lambda inputs: inputs.surface_moves,
)
def displacement_curves(inputs: FigureInputs) -> Figure:
    """Cuts through the map of Fig. 2C."""
    subject = inputs.subject
    u_y = subject.u_y / max(np.fmax.reduce(subject.u_y, axis=None), np.finfo(float).tiny)
    drawing, (against_time, against_position) = new_figure(
        6.3, 5.2, rows=2, margins=Margins(top=0.3, between_rows=0.75)
    )
    for colour, position in zip(COLOURS, inputs.positions, strict=False):
        column = int(np.abs(subject.x - position).argmin())
        against_time.plot(
            MILLI * subject.time, u_y[:, column], color=colour, label=f"$x$ = {MILLI * position:g} mm"
        )
    for colour, time in zip(COLOURS, inputs.times, strict=False):
        row = int(np.abs(subject.time - time).argmin())
        against_position.plot(
            MILLI * subject.x, u_y[row], color=colour, label=f"$t$ = {MILLI * subject.time[row]:.3g} ms"
        )
    against_time.set(xlabel="time (ms)", xlim=(MILLI * subject.time[0], MILLI * subject.time[-1]))
    against_position.set(xlabel="position $x$ (mm)", xlim=(MILLI * subject.x[0], MILLI * subject.x[-1]))
    for axes, letter in ((against_time, "A"), (against_position, "B")):
        axes.set_ylabel("$U_y / U_{y,\\mathrm{max}}$")
        axes.axhline(0.0, color="0.8", lw=0.8, zorder=0)
        axes.legend(loc="best")
        panel_letter(axes, letter)
    return drawing
