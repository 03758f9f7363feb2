"""Fig. 3: cuts through the maps at a few positions and times, one line style for each surface motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.side_by_side.inputs import COMPARISON_FIGURES, ComparedInputs
from wrinklewave.figures.style import COLOURS, MILLI, Margins, new_figure, panel_letter

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


@COMPARISON_FIGURES.figure(
    "side_3_curves",
    number="3",
    caption="Out-of-plane displacement, wrinkles included, (A) against time at fixed laboratory positions, (B) "
    "against position at fixed times. Solid: the first surface motion; broken: the others.",
)
def displacement_curves(inputs: ComparedInputs) -> Figure:
    """The same cuts through all surface motions."""
    drawing, (against_time, against_position) = new_figure(
        6.8, 6.0, rows=2, margins=Margins(top=0.35, between_rows=0.85)
    )
    for name, motion, style in inputs.styled:
        subject = motion.subject
        for colour, position in zip(COLOURS, motion.positions, strict=False):
            column = int(np.abs(subject.x - position).argmin())
            against_time.plot(MILLI * subject.time, MILLI * subject.u_y[:, column], style, color=colour)
        for colour, time in zip(COLOURS, motion.times, strict=False):
            row = int(np.abs(subject.time - time).argmin())
            against_position.plot(MILLI * subject.x, MILLI * subject.u_y[row], style, color=colour)
        against_time.plot([], [], style, color="0.4", label=name)
    first = inputs.first
    for colour, position in zip(COLOURS, first.positions, strict=False):
        against_time.plot([], [], color=colour, label=f"$x$ = {MILLI * position:.3g} mm")
    for colour, time in zip(COLOURS, first.times, strict=False):
        against_position.plot([], [], color=colour, label=f"$t$ = {MILLI * time:.3g} ms")
    grid = inputs.comparison.grid
    against_time.set(xlabel="time (ms)", xlim=(MILLI * grid.time[0], MILLI * grid.time[-1]))
    against_position.set(xlabel="position $x$ (mm)", xlim=(MILLI * grid.x[0], MILLI * grid.x[-1]))
    for axes, letter in ((against_time, "A"), (against_position, "B")):
        _finish(axes, letter)
    return drawing


def _finish(axes: Axes, letter: str) -> None:
    axes.set_ylabel("$U_y$ (mm)")
    axes.axhline(0.0, color="0.8", lw=0.8, zorder=0)
    axes.legend(loc="best")
    panel_letter(axes, letter)
