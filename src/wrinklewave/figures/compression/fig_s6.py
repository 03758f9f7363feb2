"""Fig. S6: a second quasi-static test on the same sample beside the first."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.figures.compression.inputs import COMPRESSION_FIGURES, CompressionInputs
from wrinklewave.figures.style import new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@COMPRESSION_FIGURES.figure(
    "fig_s6_repetition",
    number="S6",
    caption="Wrinkle amplitude against strain in two tests on the same sample, and the second's over the first's where "
    "both have wrinkles. Dashed: Eq. 1 as fitted to each.",
    possible=lambda inputs: inputs.test.repetition is not None,
)
def repeated_amplitudes(inputs: CompressionInputs) -> Figure:
    """Amplitudes of both tests, and their ratio."""
    drawing, (axes, below) = new_figure(4.6, 4.6, rows=2, sharex=True, height_ratios=(2, 1))
    strain = inputs.fine_strains()
    for test, colour, marker, label in zip(
        inputs.test.tests, ("black", "#c1272d"), "os", ("first test", "second test"), strict=False
    ):
        series, fit = test.series, test.fit
        axes.plot(series.strain, 1e3 * series.amplitude, marker, ms=3.5, color=colour, label=label)
        if fit is not None:
            axes.plot(strain, 1e3 * fit.amplitude(strain), "--", lw=1.0, color=colour)
    repetition = inputs.test.repetition
    assert repetition is not None  # by `possible`
    below.plot(repetition.strain, repetition.ratio, "s-", ms=3, lw=0.8, color="#c1272d")
    below.axhline(1.0, color="0.7", lw=0.8, zorder=0)
    axes.set(ylabel="amplitude $A$ (mm)", ylim=(0.0, None), xlim=(0.0, None))
    below.set(xlabel="strain $\\epsilon$", ylabel="second / first", ylim=(0.0, None))
    axes.legend(loc="lower right")
    return drawing
