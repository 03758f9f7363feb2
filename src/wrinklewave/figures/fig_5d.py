"""Fig. 5D: spectra of the wrinkles' wavelength against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import MILLI, Margins, colour_bar, legend_above, new_figure, outlined

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHORTEST, LONGEST = 0.5, 2.0
"""Wavelengths shown, over the critical one, or over that of the strongest spectrum where no film is named."""


@FIGURES.figure(
    "fig_5d_wavelength",
    number="5D",
    caption="Spectra of the wrinkles in the window against time, over their maximum. Dashed red: critical"
    " wavelength; dashed green: wavelength of Eq. 1 at the strain of Fig. 5A's dotted line; "
    "white: Eq. 1 with the strain of Fig. 5A.",
    possible=lambda inputs: inputs.surface_moves,
    measured=("fig_5c_wavelength", "5C"),
)
def wavelength_figure(inputs: FigureInputs) -> Figure:
    """Map of the spectra over time (to the right) and wavelength (upwards)."""
    spectra, expected = inputs.analysis.wrinkles.spectra, inputs.analysis.quasi_static
    time = MILLI * inputs.subject.time
    strongest = spectra.peak[spectra.magnitude.max(axis=1).argmax()]
    scale = strongest if expected is None else expected.critical_wavelength
    shown = (spectra.wavelength >= SHORTEST * scale) & (spectra.wavelength <= LONGEST * scale)
    magnitude = spectra.magnitude[:, shown] / max(spectra.magnitude.max(), 1e-12)
    drawing, axes = new_figure(6.3, 3.0, margins=Margins(right=0.95, top=0.35))
    mesh = axes.pcolormesh(
        time,
        MILLI * spectra.wavelength[shown],
        magnitude.T,
        cmap="magma",
        vmin=0.0,
        vmax=1.0,
        shading="nearest",
    )
    colour_bar(axes, mesh, label="magnitude / maximum")
    if expected is not None:
        for level, colour, label in (
            (expected.critical_wavelength, "#ff4b4b", "$\\lambda_c$"),
            (expected.wavelength_at_rest, "#5edc1f", "$\\lambda(\\epsilon_R)$"),
        ):
            axes.axhline(
                MILLI * level, color=colour, ls="--", lw=1.2, path_effects=outlined(1.2), label=label
            )
        axes.plot(
            time,
            MILLI * expected.wavelength,
            "--",
            color="white",
            lw=1.2,
            path_effects=outlined(1.2),
            label="Eq. 1",
        )
        legend_above(axes)
    axes.set(xlabel="time (ms)", ylabel="wavelength (mm)", xlim=(time[0], time[-1]))
    return drawing
