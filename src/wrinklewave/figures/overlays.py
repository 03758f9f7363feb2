"""Lines that the space-time maps have in common: the struck end, fitted speeds, material points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.fronts import SpeedFit
from wrinklewave.figures.inputs import FigureInputs
from wrinklewave.figures.style import BOUNDARY_COLOUR, MILLI, outlined

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def draw_boundary(axes: Axes, inputs: FigureInputs) -> None:
    """Struck end (dashed) and the moment at which it leaves the striker (circle)."""
    subject, boundary = inputs.subject, inputs.analysis.boundary
    axes.plot(
        MILLI * subject.x_boundary,
        MILLI * subject.time,
        "--",
        color=BOUNDARY_COLOUR,
        lw=1.4,
        label="struck end",
    )
    if np.isfinite(boundary.separation_time):
        place = np.interp(boundary.separation_time, subject.time, subject.x_boundary)
        axes.plot(MILLI * place, MILLI * boundary.separation_time, "ko", ms=5, label="leaves the striker")


def draw_speed(
    axes: Axes, fit: SpeedFit, inputs: FigureInputs, *, name: str, colour: str = "white", origin: bool = True
) -> None:
    """Free line (dashed) of a fitted front and, with ``origin``, its line through the origin (dotted)."""
    x = inputs.subject.x
    if fit.is_line:
        axes.plot(
            MILLI * x,
            MILLI * (fit.intercept + x / fit.speed),
            "--",
            color=colour,
            path_effects=outlined(),
            label=f"{name}: {fit.speed:.0f} m/s",
        )
    if origin and fit.is_line_through_origin:
        axes.plot(
            MILLI * x,
            MILLI * (fit.start + x / fit.origin_speed),
            ":",
            color=colour,
            path_effects=outlined(),
            label=f"{name}, through origin: {fit.origin_speed:.0f} m/s",
        )


def draw_material_points(axes: Axes, inputs: FigureInputs, *, colour: str = "black") -> None:
    """Paths of material points: all probe wires, or of many points those that start at the chosen positions."""
    subject = inputs.subject
    if subject.kind == "measurement":
        points = list(range(subject.X.size))
    else:
        points = [int(np.abs(subject.X - position).argmin()) for position in inputs.positions]
    for number, point in enumerate(points):
        label = "material points" if number == 0 else None
        axes.plot(
            MILLI * subject.x_p[:, point], MILLI * subject.time, "-.", color=colour, lw=1.0, label=label
        )


def frame(axes: Axes, inputs: FigureInputs) -> None:
    """Limit the axes to the map: lines run on beyond it."""
    subject = inputs.subject
    axes.set_xlim(MILLI * subject.x[0], MILLI * subject.x[-1])
    axes.set_ylim(MILLI * subject.time[0], MILLI * subject.time[-1])
