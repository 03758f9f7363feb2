"""Contact sheet of a recording: frames spread over it, and the histogram of their grey values."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wrinklewave.figures.style import BOUNDARY_COLOUR, RC
from wrinklewave.imaging.frames import FrameSource, Image
from wrinklewave.imaging.inspection import Histogram

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, GAP, CAPTION, CHART = 10.0, 0.08, 0.26, 2.1  # inches
PICTURES = 12


def contact_sheet(source: FrameSource, grey: Histogram) -> Figure:
    """Up to twelve frames, stretched to the grey values that occur; the histogram below."""
    import matplotlib
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    chosen = _spread(source)
    columns = 2 if source.shape[1] > 2.5 * source.shape[0] else 4
    rows = math.ceil(len(chosen) / columns)
    width = (WIDTH - GAP) / columns
    height = width * source.shape[0] / source.shape[1] + CAPTION
    total = rows * height + CHART
    with matplotlib.rc_context(RC):
        figure = Figure(figsize=(WIDTH, total))
        FigureCanvasAgg(figure)
        limits = _limits(grey)
        for place, (index, image) in enumerate(chosen):
            left, bottom = GAP + place % columns * width, total - (place // columns + 1) * height
            box = (left / WIDTH, bottom / total, (width - GAP) / WIDTH, (height - CAPTION) / total)
            axes = figure.add_axes(box)
            axes.imshow(image, cmap="gray", vmin=limits[0], vmax=limits[1], interpolation="antialiased")
            axes.set_title(_caption(source, index), pad=2)
            axes.set_axis_off()
        chart = (0.7 / WIDTH, 0.5 / total, (WIDTH - 1.0) / WIDTH, (CHART - 0.9) / total)
        _draw_histogram(figure.add_axes(chart), grey, source)
    return figure


def _spread(source: FrameSource) -> Sequence[tuple[int, Image]]:
    """Readable frames from the first to the last, evenly spread."""
    damaged = {index for index, _ in source.unreadable}
    readable = [index for index in range(source.n_frames) if index not in damaged]
    wanted = np.unique(np.linspace(0, len(readable) - 1, PICTURES).round().astype(int))
    return [pair for place in wanted for pair in source.frames(readable[place], readable[place] + 1)]


def _caption(source: FrameSource, index: int) -> str:
    if source.times is None or source.clock != "camera":
        return f"frame {index}"
    interval = float(np.diff(source.times).min(initial=1e-3, where=np.diff(source.times) > 0)) * 1e3
    decimals = max(0, 1 - math.floor(math.log10(interval)))  # neighbouring frames differ
    return f"frame {index}, {source.times[index] * 1e3:.{decimals}f} ms"


def _limits(grey: Histogram) -> tuple[int, int]:
    """Grey values between which all but one in two thousand lie, on either side."""
    shares = np.cumsum(grey.counts) / grey.counts.sum()
    low, high = np.searchsorted(shares, [0.0005, 0.9995])
    return int(low), max(int(high), int(low) + 1)


def _draw_histogram(axes: Axes, grey: Histogram, source: FrameSource) -> None:
    top = max(source.white_level, grey.brightest) + 1
    counts: NDArray[np.int64] = grey.counts[:top]
    width = max(1, top // 512)
    bins = np.add.reduceat(counts, np.arange(0, top, width))
    axes.step(np.arange(bins.size) * width, bins / counts.sum(), where="post", color="black", lw=1.0)
    axes.set_yscale("log")
    for level, name in ((source.black_level, "black"), (source.white_level, "white")):
        axes.axvline(level, color=BOUNDARY_COLOUR, lw=0.8, ls="--")
        axes.annotate(
            name,
            (level, 1.0),
            xycoords=("data", "axes fraction"),
            color=BOUNDARY_COLOUR,
            ha="center",
            va="bottom",
        )
    axes.set(xlabel="grey value", ylabel="share of pixels", xlim=(-0.01 * top, 1.01 * top))
