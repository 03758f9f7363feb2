"""Fig. 2D: motion of the struck end and its spectrum."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.side_by_side.inputs import COMPARISON_FIGURES, ComparedInputs
from wrinklewave.figures.style import COLOURS, MILLI, Margins, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHOWN_BANDWIDTHS = 4.0


@COMPARISON_FIGURES.figure(
    "side_2d_boundary",
    number="2D",
    caption="Motion of the struck end over the common times, and the magnitude of its Fourier transform over its "
    "maximum.",
)
def boundary_spectra(inputs: ComparedInputs) -> Figure:
    """Displacement against time, and spectra, of all surface motions."""
    drawing, (motion_axes, spectrum_axes) = new_figure(6.8, 2.8, columns=2, margins=Margins(top=0.2))
    bandwidths = []
    for (name, motion, style), colour in zip(inputs.styled, _colours(len(inputs.motions)), strict=True):
        boundary, spectrum = motion.analysis.boundary, motion.analysis.boundary.spectrum
        motion_axes.plot(
            MILLI * motion.subject.time, MILLI * boundary.displacement, style, color=colour, label=name
        )
        spectrum_axes.plot(1e-3 * spectrum.frequency, spectrum.magnitude, style, color=colour)
        bandwidths.append(spectrum.bandwidth)
    motion_axes.set(xlabel="time (ms)", ylabel="displacement of the end (mm)")
    motion_axes.legend(loc="lower right")
    known = [bandwidth for bandwidth in bandwidths if np.isfinite(bandwidth)]
    highest = SHOWN_BANDWIDTHS * max(known) if known else None
    spectrum_axes.set(xlabel="frequency (kHz)", ylabel="magnitude / maximum", ylim=(0.0, 1.05))
    spectrum_axes.set_xlim(0.0, 1e-3 * highest if highest else None)
    return drawing


def _colours(count: int) -> list[str]:
    return [COLOURS[number % len(COLOURS)] for number in range(count)]
