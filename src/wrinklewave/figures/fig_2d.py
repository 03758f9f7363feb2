"""Fig. 2D: spectrum of the struck end's motion."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import BOUNDARY_COLOUR, MILLI, Margins, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN_BANDWIDTHS = 4.0
SHOWN_IN_KHZ = 2000.0
APART = 0.01
"""Of the time shown: lines that are nearer to each other lie on each other."""


@FIGURES.figure(
    "fig_2d_boundary_spectrum",
    number="2D",
    caption="Motion of the struck end, and the magnitude of its Fourier transform over its maximum; dashed: "
    "the frequency beyond which it stays below a tenth.",
    possible=lambda inputs: np.isfinite(inputs.analysis.boundary.spectrum.bandwidth),
)
def boundary_spectrum_figure(inputs: FigureInputs) -> Figure:
    """Displacement against time, and its spectrum."""
    boundary = inputs.analysis.boundary
    drawing, (motion, spectrum) = new_figure(6.3, 2.7, columns=2, margins=Margins(top=0.25))
    motion.plot(MILLI * inputs.subject.time, MILLI * boundary.displacement, color=BOUNDARY_COLOUR)
    for label, moment in _moments(inputs).items():
        motion.axvline(MILLI * moment, color="0.5", lw=0.8, ls=":" if label == "stop" else "--", label=label)
    motion.ticklabel_format(axis="y", style="sci", scilimits=(-2, 3))
    motion.set(xlabel="time (ms)", ylabel="displacement of the end (mm)")
    if motion.get_legend_handles_labels()[1]:
        motion.legend(loc="lower right")
    bandwidth = boundary.spectrum.bandwidth
    highest = min(SHOWN_BANDWIDTHS * bandwidth, boundary.spectrum.frequency[-1])
    shown = boundary.spectrum.frequency <= highest
    unit, scale = ("kHz", 1e-3) if highest >= SHOWN_IN_KHZ else ("Hz", 1.0)
    frequency = scale * boundary.spectrum.frequency[shown]
    spectrum.plot(frequency, boundary.spectrum.magnitude[shown], color=BOUNDARY_COLOUR)
    spectrum.axvline(scale * bandwidth, color="0.5", lw=0.8, ls="--", label=f"{scale * bandwidth:.3g} {unit}")
    spectrum.set(xlabel=f"frequency ({unit})", ylabel="magnitude / maximum")
    spectrum.set(ylim=(0.0, 1.05), xlim=(0.0, scale * highest))
    spectrum.legend()
    return drawing


def _moments(inputs: FigureInputs) -> dict[str, float]:
    """When the striker stops and the end leaves it [s], where known; one line where the eye could not part two."""
    boundary, time = inputs.analysis.boundary, inputs.subject.time
    stop, separation = boundary.stop_time, boundary.separation_time
    if abs(separation - stop) < APART * (time[-1] - time[0]):
        return {"stop, separation": separation}
    return {
        label: moment for label, moment in (("stop", stop), ("separation", separation)) if np.isfinite(moment)
    }
