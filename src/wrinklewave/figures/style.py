"""How figures look: sizes, colours, and the parts that several of them share."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.cm import ScalarMappable
    from matplotlib.figure import Figure
    from matplotlib.image import AxesImage

RC: dict[Any, Any] = {
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "legend.fontsize": 8,
    "legend.frameon": False,
    "lines.linewidth": 1.5,
    "mathtext.fontset": "dejavusans",
    "savefig.dpi": 160,
    "xtick.direction": "out",
    "ytick.direction": "out",
}
PNG: dict[str, Any] = {"pil_kwargs": {"compress_level": 1}}
"""Options of ``savefig``: curves are written a third faster and are a fifth larger, noisy pictures five times faster
and a tenth larger."""
COLOURS = ("black", "#c1272d", "#0000a7", "#008176", "#eecc16")
BOUNDARY_COLOUR = "#e3342f"
OUTSIDE = "0.85"
MILLI = 1e3


@dataclass(frozen=True)
class Margins:
    """White space around and between axes, in inches. (A layout engine costs more time than the drawing.)"""

    left: float = 0.62
    right: float = 0.18
    bottom: float = 0.48
    top: float = 0.15
    between_columns: float = 0.75
    between_rows: float = 0.55


MAP_MARGINS = Margins(right=0.95, top=0.55)


def new_figure(
    width: float,
    height: float,
    *,
    rows: int = 1,
    columns: int = 1,
    margins: Margins | None = None,
    **options: Any,
) -> tuple[Figure, Any]:
    """Figure of a size in inches with its axes, drawn without a display.

    Args:
        width, height: [inch].
        rows, columns: of axes.
        margins: white space; a default for curves.
        options: of ``Figure.subplots``, such as ``sharex``, ``height_ratios``.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    m = margins or Margins()
    figure = Figure(figsize=(width, height))
    FigureCanvasAgg(figure)
    axes_width = (width - m.left - m.right - (columns - 1) * m.between_columns) / columns
    axes_height = (height - m.bottom - m.top - (rows - 1) * m.between_rows) / rows
    figure.subplots_adjust(
        left=m.left / width,
        right=1.0 - m.right / width,
        bottom=m.bottom / height,
        top=1.0 - m.top / height,
        wspace=m.between_columns / axes_width,
        hspace=m.between_rows / axes_height,
    )
    return figure, figure.subplots(rows, columns, **options)


def colour_bar(axes: Axes, shown: ScalarMappable, *, label: str, extend: str = "neither") -> None:
    """Colour bar in the margin at the right of the axes."""
    figure = axes.get_figure(root=True)
    assert figure is not None
    place = axes.get_position()
    inch = 1.0 / figure.get_figwidth()
    beside = figure.add_axes((place.x1 + 0.1 * inch, place.y0, 0.14 * inch, place.height))
    figure.colorbar(shown, cax=beside, label=label, extend=extend)


def colour_map(name: str) -> Any:
    """A colour map that shows unknown values in light grey."""
    import matplotlib

    return matplotlib.colormaps[name].with_extremes(bad=OUTSIDE)


def space_time_map(
    axes: Axes,
    x: Array,
    time: Array,
    values: Array,
    *,
    label: str,
    cmap: str,
    limits: tuple[float, float],
    extend: str,
) -> AxesImage:
    """Map over laboratory position (mm, to the right) and time (ms, upwards), with a colour bar if it has a label."""
    half_x, half_t = 0.5 * (x[1] - x[0]), 0.5 * (time[-1] - time[0]) / (time.size - 1)
    extent = (x[0] - half_x, x[-1] + half_x, time[0] - half_t, time[-1] + half_t)
    even = np.linspace(time[0], time[-1], time.size)
    rows = np.searchsorted(0.5 * (time[1:] + time[:-1]), even)  # nearest, where times are uneven
    image = axes.imshow(
        np.ma.masked_invalid(values[rows]),
        origin="lower",
        aspect="auto",
        extent=tuple(MILLI * e for e in extent),  # type: ignore[arg-type]
        cmap=colour_map(cmap),
        vmin=limits[0],
        vmax=limits[1],
        interpolation="nearest",
    )
    axes.set_xlabel("position $x$ (mm)")
    axes.set_ylabel("time (ms)")
    if label:
        colour_bar(axes, image, label=label, extend=extend)
    return image


def outlined(width: float = 1.5) -> list[Any]:
    """Path effects that keep a light line visible on light ground."""
    from matplotlib.patheffects import Normal, Stroke

    return [Stroke(linewidth=width + 1.4, foreground="black"), Normal()]


def legend_above(axes: Axes, *, columns: int = 3) -> None:
    """Legend in the free space above the axes."""
    axes.legend(
        loc="lower left",
        bbox_to_anchor=(0.0, 1.0),
        ncols=columns,
        borderaxespad=0.2,
        columnspacing=1.4,
        handlelength=2.2,
    )


def panel_letter(axes: Axes, letter: str) -> None:
    """Bold letter at the upper left, outside the axes."""
    axes.text(-0.1, 1.02, letter, transform=axes.transAxes, fontweight="bold", fontsize=11)
