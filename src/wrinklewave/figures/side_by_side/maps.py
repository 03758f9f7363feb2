"""Figs. 2A to 2C, 4A and 4B: space-time maps of all surface motions beside each other, and their differences."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FigureInputs
from wrinklewave.figures.overlays import draw_boundary, draw_material_points, draw_speed, frame
from wrinklewave.figures.side_by_side.inputs import COMPARISON_FIGURES, ComparedInputs
from wrinklewave.figures.style import Margins, colour_bar, legend_above, new_figure, space_time_map

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

MOST_COLUMNS = 3
PANEL_WIDTH, PANEL_HEIGHT = 3.7, 3.2
NAME_ABOVE = 0.6
"""Sizes of a map in inches, and how far above it its name stands, the legend between."""
PANEL_MARGINS = Margins(right=0.95, top=0.85, between_columns=0.7, between_rows=1.3)
DIFFERENCE_MARGINS = Margins(right=0.95, top=0.4, between_columns=0.7, between_rows=0.9)


@COMPARISON_FIGURES.figure(
    "side_2c_displacement",
    number="2A to 2C",
    measured=("side_2c_displacement", "S1"),
    caption="Out-of-plane displacement of the surface, wrinkles included, over the maximum of the first surface "
    "motion (scale cut at -0.25). Dashed red: struck end; white: wavefront, free line (dashed) and line through "
    "the origin (dotted); dash-dotted: paths of material points.",
)
def displacement_maps(inputs: ComparedInputs) -> Figure:
    """Maps of U_y with one colour scale."""
    highest = max(np.fmax.reduce(inputs.first.subject.u_y, axis=None), np.finfo(float).tiny)
    drawing, panels = _panels(len(inputs.motions), PANEL_MARGINS)
    for axes, (name, motion) in zip(panels, inputs.motions.items(), strict=True):
        subject = motion.subject
        image = space_time_map(
            axes, subject.x, subject.time, subject.u_y / highest,
            label="", cmap="viridis", limits=(-0.25, 1.0), extend="min",
        )  # fmt: skip
        _draw_lines(axes, motion)
        draw_speed(axes, motion.analysis.pulse.wavefront, motion, name="wavefront")
        _finish(axes, motion, name)
    colour_bar(panels[-1], image, label="$U_y$ / maximum of the first", extend="min")
    return drawing


@COMPARISON_FIGURES.figure(
    "side_4b_wrinkles",
    number="4A and 4B",
    caption="Out-of-plane surface wrinkling after removal of the low-frequency pulse. Magenta: the wrinkle front "
    "(amplitude passes the threshold); green: the wavefront; dash-dotted: paths of material points.",
)
def wrinkle_maps(inputs: ComparedInputs) -> Figure:
    """Maps of the height of the wrinkles with one colour scale."""
    scale = 1e6 * max(np.nanpercentile(np.abs(inputs.first.analysis.wrinkles.height), 99.0), 1e-6)
    drawing, panels = _panels(len(inputs.motions), PANEL_MARGINS)
    for axes, (name, motion) in zip(panels, inputs.motions.items(), strict=True):
        subject, wrinkles = motion.subject, motion.analysis.wrinkles
        image = space_time_map(
            axes, subject.x, subject.time, 1e6 * wrinkles.height,
            label="", cmap="RdBu_r", limits=(-scale, scale), extend="both",
        )  # fmt: skip
        _draw_lines(axes, motion)
        draw_speed(axes, wrinkles.front, motion, name="wrinkles", colour="#ff40ff")
        wavefront = motion.analysis.pulse.wavefront
        draw_speed(axes, wavefront, motion, name="wavefront", colour="#7cfc00", origin=False)
        _finish(axes, motion, name)
    colour_bar(panels[-1], image, label="$u_y$ (µm)", extend="both")
    return drawing


@COMPARISON_FIGURES.figure(
    "side_misfit",
    number="",
    caption="Displacement without wrinkles less that of the first surface motion, on the common times and "
    "positions; grey where one of them is unknown.",
)
def misfit_maps(inputs: ComparedInputs) -> Figure:
    """Maps of the difference from the first, with one colour scale."""
    comparison = inputs.comparison
    grid, agreements = comparison.grid, inputs.agreements
    scale = 1e6 * max(max(np.nanpercentile(np.abs(a.misfit), 99.0) for a in agreements.values()), 1e-9)
    drawing, panels = _panels(len(agreements), DIFFERENCE_MARGINS)
    for axes, (name, agreement) in zip(panels, agreements.items(), strict=True):
        image = space_time_map(
            axes, grid.x, grid.time, 1e6 * agreement.misfit,
            label="", cmap="RdBu_r", limits=(-scale, scale), extend="both",
        )  # fmt: skip
        axes.set_title(f"{name} - {next(iter(inputs.motions))}", loc="left", fontweight="bold")
    colour_bar(panels[-1], image, label="difference of $U_y$ (µm)", extend="both")
    return drawing


def _panels(count: int, margins: Margins) -> tuple[Figure, list[Axes]]:
    """Panels of one size, at most three in a row."""
    columns = min(count, MOST_COLUMNS)
    rows = -(-count // columns)
    width = margins.left + margins.right + PANEL_WIDTH * columns + margins.between_columns * (columns - 1)
    height = margins.top + margins.bottom + PANEL_HEIGHT * rows + margins.between_rows * (rows - 1)
    drawing, axes = new_figure(width, height, rows=rows, columns=columns, margins=margins, squeeze=False)
    panels: Iterable[Axes] = axes.ravel()
    for spare in axes.ravel()[count:]:
        spare.remove()
    return drawing, list(panels)[:count]


def _draw_lines(axes: Axes, motion: FigureInputs) -> None:
    draw_boundary(axes, motion)
    if motion.subject.X.size:
        draw_material_points(axes, motion)


def _finish(axes: Axes, motion: FigureInputs, name: str) -> None:
    frame(axes, motion)
    legend_above(axes, columns=2)
    axes.text(
        0.0,
        1.0 + NAME_ABOVE / PANEL_HEIGHT,
        name,
        transform=axes.transAxes,
        fontweight="bold",
        fontsize=10,
        va="bottom",
    )
