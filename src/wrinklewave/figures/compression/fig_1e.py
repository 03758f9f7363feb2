"""Fig. 1E: wavelength against strain, with Eq. 1."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.compression.inputs import COMPRESSION_FIGURES, CompressionInputs
from wrinklewave.figures.style import MILLI, new_figure
from wrinklewave.wrinkling.quasi_static import wrinkle_wavelength

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@COMPRESSION_FIGURES.figure(
    "fig_1e_wavelength",
    number="1E",
    caption="Wavelength on the compressed sample (strongest Fourier component) against the strain along the arc. "
    "Solid: the fitted wavelength of undeformed material times 1 - ε, with its drift; dashed: Eq. 1 from the same "
    "wavelength at the critical strain.",
    possible=lambda inputs: bool(np.isfinite(inputs.test.first.series.wavelength).any()),
)
def wavelength_against_strain(inputs: CompressionInputs) -> Figure:
    """Measured wavelengths and the fit."""
    series, fit = inputs.test.first.series, inputs.test.first.fit
    drawing, axes = new_figure(4.6, 3.2)
    axes.plot(series.strain, MILLI * series.wavelength, "o", ms=3.5, color="black", label="measured")
    if fit is not None:
        strain = inputs.fine_strains()
        label = (
            f"$\\lambda_c$ = {MILLI * fit.compressed_wavelength:.3f} mm at $\\epsilon_c$,\n"
            f"{MILLI * fit.critical_wavelength:.4f} ± {MILLI * fit.sigmas['critical_wavelength']:.4f} mm of material"
        )
        axes.plot(strain, MILLI * fit.wavelength(strain), color="#c1272d", lw=1.0, label=label)
        equation = wrinkle_wavelength(
            strain, critical_strain=fit.critical_strain, critical_wavelength=fit.compressed_wavelength
        )
        axes.plot(strain, MILLI * equation, "--", color="#0000a7", label="Eq. 1")
    axes.set(xlabel="strain $\\epsilon$", ylabel="wavelength $\\lambda$ (mm)", xlim=(0.0, None))
    axes.legend(loc="lower left")
    return drawing
