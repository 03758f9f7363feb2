"""Registry of the figures of a quasi-static test, and writing them all."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.detections import Detection
from wrinklewave.figures.style import RC
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from wrinklewave.experiments.quasi_static_test import QuasiStaticTest


@dataclass(frozen=True)
class CompressionInputs:
    """What figures are drawn from: the test, and a few images of it if there are any."""

    test: QuasiStaticTest
    images: tuple[Detection, ...] = ()

    @property
    def largest_strain(self) -> float:
        """Of all series."""
        return max(float(test.series.strain.max()) for test in self.test.tests)

    def fine_strains(self) -> Array:
        """Strains for smooth curves."""
        return np.linspace(0.0, self.largest_strain, 800)


Draw = Callable[[CompressionInputs], "Figure"]


@dataclass(frozen=True)
class CompressionFigure:
    """A figure of a quasi-static test.

    Attributes:
        name: file name without its ending.
        number: of the paper's figure, such as "1D".
        caption: what it shows.
        draw: makes it.
        possible: whether the inputs hold what it needs.
    """

    name: str
    number: str
    caption: str
    draw: Draw
    possible: Callable[[CompressionInputs], bool]


COMPRESSION_FIGURES: dict[str, CompressionFigure] = {}


def compression_figure(
    name: str,
    *,
    number: str,
    caption: str,
    possible: Callable[[CompressionInputs], bool] = lambda inputs: True,
) -> Callable[[Draw], Draw]:
    """Register a function that draws a figure of a quasi-static test."""

    def register(draw: Draw) -> Draw:
        COMPRESSION_FIGURES[name] = CompressionFigure(name, number, caption, draw, possible)
        return draw

    return register


def write_compression_figures(folder: str | Path, inputs: CompressionInputs) -> dict[str, Path]:
    """Write every figure that is possible as PNG; return the files by name."""
    import matplotlib

    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    files = {}
    with matplotlib.rc_context(RC):
        for name, figure in COMPRESSION_FIGURES.items():
            if figure.possible(inputs):
                files[name] = folder / f"{name}.png"
                figure.draw(inputs).savefig(files[name], pil_kwargs={"compress_level": 1})
    return files
