"""Fig. S2: how unevenly the strain is spread over the depth of the block."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import COLOURS, MILLI, Margins, colour_bar, colour_map, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_s2_strain_over_depth",
    number="S2",
    caption="Nominal strain in the deformed block at a few times (left), and over its depth at undeformed"
    " positions (right; dotted: mean over the depth drawn).",
    possible=lambda inputs: inputs.snapshots is not None,
)
def strain_over_depth(inputs: FigureInputs) -> Figure:
    """One row per time: the deformed block, and strain profiles over Y."""
    snapshots = inputs.snapshots
    assert snapshots is not None  # by `possible`
    limit = float(np.nanpercentile(np.abs(snapshots.strain_xx), 99.0))
    rows = snapshots.time.size
    drawing, panels = new_figure(
        7.6,
        1.0 + 1.9 * rows,
        rows=rows,
        columns=2,
        margins=Margins(right=1.45, top=0.4),
        width_ratios=(2.2, 1),
        squeeze=False,
    )
    middles = 0.5 * (snapshots.X[0, 1:] + snapshots.X[0, :-1])
    heights = 0.5 * (snapshots.Y[1:, 0] + snapshots.Y[:-1, 0])
    thickness = np.diff(snapshots.Y[:, 0])
    for row, time in enumerate(snapshots.time):
        block, profiles = panels[row]
        mesh = block.pcolormesh(
            MILLI * snapshots.x[row],
            MILLI * snapshots.y[row],
            snapshots.strain_xx[row],
            cmap=colour_map("RdBu_r"),
            vmin=-limit,
            vmax=limit,
        )
        block.set(xlim=(0.0, MILLI * snapshots.X.max()), ylim=(0.0, MILLI * snapshots.y.max()))
        block.set(ylabel="$y$ (mm)", title=f"$t$ = {MILLI * time:.3g} ms")
        for colour, position in zip(COLOURS, inputs.positions, strict=False):
            column = int(np.abs(middles - position).argmin())
            strain = snapshots.strain_xx[row, :, column]
            profiles.plot(strain, MILLI * heights, color=colour, label=f"$X$ = {MILLI * position:g} mm")
            profiles.axvline(np.average(strain, weights=thickness), color=colour, ls=":", lw=1.0)
        profiles.set(ylabel="$Y$ (mm)", xlim=(-1.2 * limit, 1.2 * limit))
    panels[-1, 0].set_xlabel("$x$ (mm)")
    panels[-1, 1].set_xlabel("$\\epsilon_{xx}$")
    panels[0, 1].legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), borderaxespad=0.2, handlelength=1.2)
    colour_bar(panels[-1, 1], mesh, label="$\\epsilon_{xx}$", extend="both")
    return drawing
