"""Registry of the figures, and writing them all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING

from wrinklewave.figures.inputs import FigureInputs
from wrinklewave.figures.style import RC

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Draw = Callable[[FigureInputs], "Figure"]


@dataclass(frozen=True)
class FigureSpec:
    """A figure that can be drawn.

    Attributes:
        name: file name without its ending.
        number: of the paper's figure, such as "2C".
        caption: what it shows.
        draw: makes it.
        possible: whether the inputs hold what it needs.
        measured: name and number of the same figure in the paper's arrangement where the surface motion was measured.
    """

    name: str
    number: str
    caption: str
    draw: Draw
    possible: Callable[[FigureInputs], bool]
    measured: tuple[str, str] | None = None

    def of(self, kind: str) -> FigureSpec:
        """The figure as it is called for a "simulation" or a "measurement"."""
        if kind != "measurement" or self.measured is None:
            return self
        return replace(self, name=self.measured[0], number=self.measured[1])


FIGURES: dict[str, FigureSpec] = {}


def figure(
    name: str,
    *,
    number: str,
    caption: str,
    possible: Callable[[FigureInputs], bool] = lambda inputs: True,
    measured: tuple[str, str] | None = None,
) -> Callable[[Draw], Draw]:
    """Register a function that draws a figure; it is called with the style of this package in force."""

    def register(draw: Draw) -> Draw:
        def styled(inputs: FigureInputs) -> Figure:
            import matplotlib

            with matplotlib.rc_context(RC):
                return draw(inputs)

        FIGURES[name] = FigureSpec(name, number, caption, styled, possible, measured)
        return styled

    return register


def write_all(folder: str | Path, inputs: FigureInputs) -> dict[str, Path]:
    """Write every figure that is possible as PNG; return the files by name."""
    import matplotlib

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    files = {}
    for name, spec in FIGURES.items():
        if spec.possible(inputs):
            files[name] = folder / f"{spec.of(inputs.subject.kind).name}.png"
            drawing = spec.draw(inputs)
            with matplotlib.rc_context(RC):
                drawing.savefig(
                    files[name], pil_kwargs={"compress_level": 1}
                )  # a third faster, a fifth larger
    return files
