"""Fig. 5B: wrinkle amplitude against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import MILLI, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure


@FIGURES.figure(
    "fig_5b_amplitude",
    number="5B",
    caption="Wrinkle amplitude (mean of the Hilbert envelope over the window) against time, over A0, the "
    "amplitude of Eq. 1 at the strain of Fig. 5A's dotted line. Black: Eq. 1 with the strain of "
    "Fig. 5A.",
    possible=lambda inputs: (
        inputs.analysis.quasi_static is not None and inputs.analysis.quasi_static.amplitude_at_rest > 0.0
    ),
)
def amplitude_figure(inputs: FigureInputs) -> Figure:
    """Amplitude over A_0 with what Eq. 1 expects."""
    expected = inputs.analysis.quasi_static
    assert expected is not None  # by `possible`
    time = MILLI * inputs.subject.time
    drawing, axes = new_figure(5.2, 2.8)
    axes.plot(time, expected.amplitude / expected.amplitude_at_rest, color="black", label="Eq. 1, arc strain")
    axes.plot(
        time,
        inputs.analysis.wrinkles.amplitude / expected.amplitude_at_rest,
        ".",
        ms=4,
        markevery=max(time.size // 100, 1),
        color="#c1272d",
        label="simulated" if inputs.subject.kind == "simulation" else "measured",
    )
    axes.axhline(1.0, color="0.7", lw=0.8, ls=":", zorder=0)
    axes.set(
        xlabel="time (ms)",
        ylabel=f"$A / A_0$,  $A_0$ = {1e6 * expected.amplitude_at_rest:.0f} µm",
        xlim=(time[0], time[-1]),
        ylim=(0.0, None),
    )
    axes.legend(loc="lower right")
    return drawing
