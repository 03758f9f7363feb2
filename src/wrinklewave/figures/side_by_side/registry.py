"""Registry of the figures of a comparison, and writing them all."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from wrinklewave.figures.side_by_side.inputs import ComparedInputs, compared_inputs
from wrinklewave.figures.style import RC

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from wrinklewave.experiments.compare import Comparison

Draw = Callable[[ComparedInputs], "Figure"]


@dataclass(frozen=True)
class ComparisonFigure:
    """A figure of a comparison.

    Attributes:
        name: file name without its ending.
        number: of the paper's figures that it is arranged like, such as "2A-C"; empty if there is none.
        caption: what it shows.
        draw: makes it.
        of_tests: the number where all of the surface motions were measured, if it is another.
    """

    name: str
    number: str
    caption: str
    draw: Draw
    of_tests: str | None = None

    def of(self, kinds: Iterable[str]) -> ComparisonFigure:
        """The figure as it is numbered for surface motions of these kinds, "simulation" or "measurement"."""
        if self.of_tests is None or set(kinds) != {"measurement"}:
            return self
        return replace(self, number=self.of_tests)


COMPARISON_FIGURES: dict[str, ComparisonFigure] = {}


def comparison_figure(
    name: str, *, number: str, caption: str, of_tests: str | None = None
) -> Callable[[Draw], Draw]:
    """Register a function that draws a figure of a comparison."""

    def register(draw: Draw) -> Draw:
        COMPARISON_FIGURES[name] = ComparisonFigure(name, number, caption, draw, of_tests)
        return draw

    return register


def write_comparison_figures(folder: str | Path, comparison: Comparison) -> dict[str, Path]:
    """Write every figure as PNG; return the files by name."""
    import matplotlib

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    inputs, files = compared_inputs(comparison), {}
    with matplotlib.rc_context(RC):
        for name, figure in COMPARISON_FIGURES.items():
            files[name] = folder / f"{name}.png"
            figure.draw(inputs).savefig(files[name], pil_kwargs={"compress_level": 1})
    return files
