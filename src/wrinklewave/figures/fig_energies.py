"""The energy balance of a simulation against time."""

from __future__ import annotations

from typing import TYPE_CHECKING

from wrinklewave.figures.inputs import FIGURES, FigureInputs
from wrinklewave.figures.style import MILLI, Margins, new_figure

if TYPE_CHECKING:
    from matplotlib.figure import Figure

SHARES = {
    "elastic_J_per_m": ("elastic, stored", "#0000a7"),
    "kinetic_J_per_m": ("kinetic", "#c1272d"),
    "springs_J_per_m": ("Prony springs, stored", "#6a8fd8"),
    "dissipated_J_per_m": ("viscous dissipation", "#008176"),
    "bulk_viscosity_J_per_m": ("bulk viscosity", "#eecc16"),
    "hourglass_J_per_m": ("hourglass", "#b34fc4"),
    "contact_loss_J_per_m": ("contact loss", "#7f7f7f"),
    "friction_J_per_m": ("friction", "#8c564b"),
}


@FIGURES.figure(
    "energy_balance",
    number="",
    caption="Where the work of the struck end goes (stacked), and the imbalance over the largest external"
    " work.",
    possible=lambda inputs: inputs.history is not None,
)
def energy_balance(inputs: FigureInputs) -> Figure:
    """Stacked energies with the external work, and the relative imbalance below."""
    assert inputs.history is not None  # by `possible`
    history = dict(inputs.history)
    history["dissipated_J_per_m"] = history["viscous_work_J_per_m"] - history["springs_J_per_m"]
    time = MILLI * history["time_s"]
    drawing, (energies, imbalance) = new_figure(
        6.3,
        4.2,
        rows=2,
        sharex=True,
        height_ratios=(3, 1),
        margins=Margins(left=0.75, right=1.75, top=0.25, between_rows=0.3),
    )
    names = [name for name in SHARES if name in history]
    energies.stackplot(
        time,
        [history[name] for name in names],
        labels=[SHARES[name][0] for name in names],
        colors=[SHARES[name][1] for name in names],
        alpha=0.75,
        lw=0,
    )
    energies.plot(time, history["external_work_J_per_m"], color="black", lw=1.2, label="external work")
    energies.set(ylabel="energy (J/m)", xlim=(0.0, time[-1]))
    energies.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    largest = max(abs(history["external_work_J_per_m"]).max(), 1e-300)
    imbalance.plot(time, 1e6 * history["imbalance_J_per_m"] / largest, color="black", lw=1.0)
    imbalance.set(xlabel="time (ms)", ylabel="imbalance (ppm)")
    return drawing
