"""Figures of a comparison: the paper's, with all surface motions in each; one module per kind, one registry."""

from wrinklewave.figures.side_by_side import (  # noqa: F401, I001 - each registers its figures, in this order
    maps,
    curves,
    boundary,
    wrinkles,
)
from wrinklewave.figures.side_by_side.inputs import COMPARISON_FIGURES, compared_inputs

__all__ = ["COMPARISON_FIGURES", "compared_inputs"]
