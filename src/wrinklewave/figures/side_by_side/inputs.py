"""What figures of a comparison are drawn from, and the registry of these figures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.figures.inputs import FigureInputs
from wrinklewave.figures.registry import Registry

if TYPE_CHECKING:
    from wrinklewave.experiments.compare import Agreement, Comparison

LINE_STYLES = ("-", "--", ":", "-.")
SHARES_OF_TIME = (0.25, 0.5, 0.75)


@dataclass(frozen=True, eq=False)
class ComparedInputs:
    """A comparison, and each of its surface motions as other figures take it.

    Attributes:
        comparison: as computed.
        motions: by name as a figure writes it, the reference first.
    """

    comparison: Comparison
    motions: dict[str, FigureInputs]

    @property
    def first(self) -> FigureInputs:
        """The reference."""
        return next(iter(self.motions.values()))

    @property
    def agreements(self) -> dict[str, Agreement]:
        """Of all but the reference with it, by name as in ``motions``."""
        return {as_written(name): agreement for name, agreement in self.comparison.agreements.items()}

    @property
    def styled(self) -> list[tuple[str, FigureInputs, str]]:
        """Name, surface motion and line style of each."""
        return [
            (name, motion, LINE_STYLES[number % len(LINE_STYLES)])
            for number, (name, motion) in enumerate(self.motions.items())
        ]


def as_written(name: str) -> str:
    """A name as matplotlib writes it: to it, dollars mark formulas, and a label that begins with a low line is none."""
    return f"{' ' * name.startswith('_')}{name}".replace("$", r"\$")


COMPARISON_FIGURES: Registry[ComparedInputs] = Registry("wrinklewave.figures.side_by_side:COMPARISON_FIGURES")


def compared_inputs(comparison: Comparison) -> ComparedInputs:
    """Inputs with the positions and times of the settings that all share; a few of the common times if none."""
    grid, settings = comparison.grid, comparison.settings
    positions = tuple(x for x in settings.positions if grid.x[0] <= x <= grid.x[-1])
    times = tuple(t for t in settings.times if grid.time[0] <= t <= grid.time[-1])
    if not times:
        times = tuple(float(t) for t in np.quantile(grid.time, SHARES_OF_TIME))
    return ComparedInputs(
        comparison,
        {
            as_written(name): FigureInputs(motion.subject, motion.analysis, positions, times)
            for name, motion in comparison.motions.items()
        },
    )
