"""Figs. 5B to 5D: amplitude and wavelength of the wrinkles against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from wrinklewave.figures.side_by_side.inputs import COMPARISON_FIGURES, ComparedInputs
from wrinklewave.figures.style import COLOURS, MILLI, Margins, colour_bar, new_figure, outlined

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHORTEST, LONGEST = 0.5, 2.0
"""Wavelengths shown, over that of the strongest spectrum."""
LEAST_RANGE = 0.02
"""Ratios are shown from at least this much below one to this much above."""


@COMPARISON_FIGURES.figure(
    "side_5b_amplitude",
    number="5B",
    caption="Wrinkle amplitude (mean of the Hilbert envelope over the window) and wavelength (strongest in the "
    "spectrum) against time; below, both over those of the first surface motion while that has wrinkles.",
)
def amplitude_and_wavelength(inputs: ComparedInputs) -> Figure:
    """Amplitude and wavelength of all, and their ratios to the first."""
    drawing, panels = new_figure(
        7.2,
        4.6,
        rows=2,
        columns=2,
        margins=Margins(top=0.2, between_rows=0.3),
        sharex=True,
        height_ratios=(2, 1),
    )
    for number, (name, motion, style) in enumerate(inputs.styled):
        wrinkles, time = motion.analysis.wrinkles, MILLI * motion.subject.time
        colour = COLOURS[number % len(COLOURS)]
        panels[0, 0].plot(time, 1e6 * wrinkles.amplitude, style, color=colour, label=name)
        panels[0, 1].plot(time, MILLI * wrinkles.spectra.peak, style, color=colour)
        agreement = inputs.agreements.get(name)
        if agreement is not None:
            common = MILLI * inputs.comparison.grid.time
            for axes, ratio in zip(panels[1], (agreement.amplitude, agreement.wavelength), strict=True):
                label = f"mean {ratio.mean:.3f} ± {ratio.deviation:.3f}"
                axes.plot(common, ratio.values, style, color=colour, label=label)
    panels[0, 0].set_ylabel("amplitude (µm)")
    panels[0, 1].set_ylabel("wavelength (mm)")
    drawn = MILLI * np.concatenate(
        [_drawn(motion.analysis.wrinkles.spectra.peak) for motion in inputs.motions.values()]
    )
    if drawn.size:
        spare = 0.05 * float(np.ptp(drawn)) or 0.1
        panels[0, 1].set_ylim(drawn.min() - spare, drawn.max() + spare)
    panels[0, 0].legend(loc="lower right")
    for axes in panels[1]:
        low, high = axes.get_ylim()
        axes.set_ylim(min(low, 1.0 - LEAST_RANGE), max(high, 1.0 + LEAST_RANGE))
        axes.axhline(1.0, color="0.7", lw=0.8, zorder=0)
        axes.set(xlabel="time (ms)", ylabel="over the first")
        axes.legend(loc="best")
    return drawing


@COMPARISON_FIGURES.figure(
    "side_5d_wavelength",
    number="5C and 5D",
    caption="Spectra of the wrinkles in the window against time, over the maximum of the first surface motion. "
    "White: the strongest wavelength; dashed red: critical wavelength of the film, where it is known.",
)
def wavelength_maps(inputs: ComparedInputs) -> Figure:
    """Maps of the spectra over time (to the right) and wavelength (upwards), one below the other."""
    first = inputs.first.analysis.wrinkles.spectra
    strongest = max(first.magnitude.max(), np.finfo(float).tiny)
    scale = first.peak[first.magnitude.max(axis=1).argmax()]
    scale = scale if np.isfinite(scale) else float(np.median(first.wavelength))
    count = len(inputs.motions)
    drawing, panels = new_figure(
        6.3,
        0.9 + 2.3 * count,
        rows=count,
        margins=Margins(right=0.95, top=0.35, between_rows=0.75),
        squeeze=False,
    )
    for axes, (name, motion) in zip(panels[:, 0], inputs.motions.items(), strict=True):
        spectra, time = motion.analysis.wrinkles.spectra, MILLI * motion.subject.time
        shown = (spectra.wavelength >= SHORTEST * scale) & (spectra.wavelength <= LONGEST * scale)
        mesh = axes.pcolormesh(
            time, MILLI * spectra.wavelength[shown], spectra.magnitude[:, shown].T / strongest,
            cmap="magma", vmin=0.0, vmax=1.0, shading="nearest",
        )  # fmt: skip
        colour_bar(axes, mesh, label="magnitude")
        axes.plot(time, MILLI * spectra.peak, color="white", lw=1.0, path_effects=outlined(1.0))
        if motion.subject.critical_wavelength is not None:
            axes.axhline(MILLI * motion.subject.critical_wavelength, color="#ff4b4b", ls="--", lw=1.2)
        axes.set(xlabel="time (ms)", ylabel="wavelength (mm)", xlim=(time[0], time[-1]))
        axes.set_ylim(MILLI * SHORTEST * scale, MILLI * LONGEST * scale)
        axes.set_title(name, loc="left", fontweight="bold")
    return drawing


def _drawn(values: NDArray[np.floating]) -> NDArray[np.floating]:
    """Values of a curve that have a known neighbour: a single one draws no line and sets no range."""
    known = np.pad(np.isfinite(values), 1)
    return values[known[1:-1] & (known[:-2] | known[2:])]
