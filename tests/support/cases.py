"""Cases of the package's own examples, coarse and fine, as the tests run them."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from wrinklewave.config import Case, load_case
from wrinklewave.experiments.simulate import Run, simulate

EXAMPLES = Path(__file__).parents[2] / "examples"

BULK_RESPONSES = ("elastic-long-term", "elastic-instantaneous", "relaxing")
COARSE, PAPER, FINE = (101, 37), (202, 74), (404, 148)


def impact(element: str, bulk: str = "elastic-long-term", *overrides: str) -> Case:
    """A millisecond of the impact on a coarse mesh."""
    return load_case(
        EXAMPLES / "quick.toml",
        [f"mesh.element={element}", f"substrate.bulk_response={bulk}", *overrides],
    )


@cache
def paper_impact(
    element: str = "one-point",
    bulk: str = "elastic-long-term",
    mesh: tuple[int, int] = PAPER,
    *overrides: str,
) -> Run:
    """The paper's impact, on one thread; each is run once and kept."""
    choices = [
        f"mesh.element={element}",
        f"substrate.bulk_response={bulk}",
        f"mesh.elements=[{mesh[0]}, {mesh[1]}]",
    ]
    return simulate(EXAMPLES / "paper_impact.toml", threads=1, overrides=[*choices, *overrides])
