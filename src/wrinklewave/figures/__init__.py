"""The paper's figures, drawn from analysed surface motions: one module per figure, all in one registry."""

from wrinklewave.figures import (  # noqa: F401 - each registers its figure, in this order
    fig_2c,
    fig_2d,
    fig_3,
    fig_4b,
    fig_4c,
    fig_4d,
    fig_5a,
    fig_5b,
    fig_5d,
    fig_energies,
    fig_s2,
    fig_s4,
    fig_s5,
)
from wrinklewave.figures.inputs import FIGURES, FigureInputs, StrainSnapshots, figure_inputs

__all__ = ["FIGURES", "FigureInputs", "StrainSnapshots", "figure_inputs"]
