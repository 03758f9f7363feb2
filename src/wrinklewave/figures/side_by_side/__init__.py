"""Figures of a comparison: the paper's, with all surface motions in each; one module per kind, one registry."""

from wrinklewave.figures.side_by_side import (  # noqa: F401, I001 - each registers its figures, in this order
    maps,
    curves,
    boundary,
    wrinkles,
)
from wrinklewave.figures.side_by_side.registry import (
    COMPARISON_FIGURES,
    ComparisonFigure,
    write_comparison_figures,
)

__all__ = ["COMPARISON_FIGURES", "ComparisonFigure", "write_comparison_figures"]
