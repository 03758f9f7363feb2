"""Fig. 1D: wrinkle amplitude against strain, with Eq. 1."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.figures.compression.inputs import COMPRESSION_FIGURES, CompressionInputs
from wrinklewave.figures.style import new_figure
from wrinklewave.wrinkling.quasi_static import wrinkle_amplitude

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@COMPRESSION_FIGURES.figure(
    "fig_1d_amplitude",
    number="1D",
    caption="Wrinkle amplitude (mean of the Hilbert envelope over the window) against the strain along the arc. "
    "Dashed: Eq. 1 with the fitted critical strain and wavelength; solid: the same with the wrinkles that were "
    "there before.",
)
def amplitude_against_strain(inputs: CompressionInputs) -> Figure:
    """Measured amplitudes and the fit."""
    series, fit = inputs.test.first.series, inputs.test.first.fit
    drawing, axes = new_figure(4.6, 3.2)
    axes.plot(series.strain, 1e3 * series.amplitude, "o", ms=3.5, color="black", label="measured")
    if fit is not None:
        strain = inputs.fine_strains()
        ideal = wrinkle_amplitude(
            strain, critical_strain=fit.critical_strain, critical_wavelength=fit.critical_wavelength
        )
        sigma = fit.sigmas["critical_strain"]
        label = f"Eq. 1, $\\epsilon_c$ = {fit.critical_strain:.4f} ± {sigma:.4f}"
        axes.plot(strain, 1e3 * ideal, "--", color="#0000a7", label=label)
        before = f"wrinkled before, $A_i$ = {1e6 * fit.initial_amplitude:.1f} µm"
        axes.plot(strain, 1e3 * fit.amplitude(strain), color="#c1272d", lw=1.0, label=before)
    axes.set(xlabel="strain $\\epsilon$", ylabel="amplitude $A$ (mm)", ylim=(0.0, None), xlim=(0.0, None))
    axes.legend(loc="lower right")
    return drawing
