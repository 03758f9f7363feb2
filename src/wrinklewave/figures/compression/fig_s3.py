"""Fig. S3: where the ends keep the surface free of wrinkles."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.compression.inputs import COMPRESSION_FIGURES, CompressionInputs
from wrinklewave.figures.style import (
    MAP_MARGINS,
    MILLI,
    colour_bar,
    colour_map,
    legend_above,
    new_figure,
    outlined,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@COMPRESSION_FIGURES.figure(
    "fig_s3_margins",
    number="S3",
    caption="Local amplitude of the wrinkles over position in the undeformed sample and strain. Lines: where it first "
    "reaches half its mean over the window, seen from the ends. Within about half a wavelength of the ends the Hilbert "
    "envelope itself is too small.",
)
def margins_against_strain(inputs: CompressionInputs) -> Figure:
    """Map of the envelope with the margins at both ends."""
    series = inputs.test.first.series
    order = np.argsort(series.strain)
    strain = series.strain[order]
    drawing, axes = new_figure(6.3, 3.8, margins=replace(MAP_MARGINS, left=0.75))
    shown = axes.pcolormesh(
        MILLI * series.X,
        strain,
        np.ma.masked_invalid(MILLI * series.envelope[order]),
        cmap=colour_map("viridis"),
        shading="nearest",
        rasterized=True,
        vmin=0.0,
    )
    colour_bar(axes, shown, label="amplitude (mm)")
    held = series.length - series.held_margin[order]
    axes.plot(
        MILLI * series.struck_margin[order],
        strain,
        color="white",
        lw=1.4,
        path_effects=outlined(1.4),
        label="struck end",
    )
    axes.plot(MILLI * held, strain, "--", color="white", lw=1.4, path_effects=outlined(1.4), label="held end")
    axes.set(xlabel="undeformed position $X$ (mm)", ylabel="strain $\\epsilon$")
    axes.set_xlim(0.0, MILLI * series.length)
    legend_above(axes, columns=2)
    return drawing
