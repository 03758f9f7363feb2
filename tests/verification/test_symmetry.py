"""The half of a symmetric block with guides at mid-height against the whole block without them.

The same equations in another order of additions: the difference is rounding, amplified by the motion.
"""

from __future__ import annotations

import numpy as np
import pytest

from support.cases import impact
from support.ledger import Verified
from support.models import ELEMENTS, run
from wrinklewave.dynamics.model import Model, build_model

TIMES = np.linspace(0.0, 1e-3, 11)


def struck(element: str, *, symmetry: bool) -> Model:
    """The impact on a coarse block, or on its upper half; friction so that the sides are pulled as well."""
    rows = 18 if symmetry else 36
    model = build_model(
        impact(
            element,
            "relaxing",
            f"block.symmetry={str(symmetry).lower()}",
            f"mesh.elements=[50, {rows}]",
            "drive.friction=0.1",
        )
    )
    run(model, TIMES)
    return model


@pytest.mark.parametrize("element", ELEMENTS)
def test_half_block_moves_as_the_whole_block(element: str, verified: Verified) -> None:
    half, whole = struck(element, symmetry=True).arrays, struck(element, symmetry=False).arrays
    size = float(np.abs(half.u).max())
    for name in ("u", "w"):
        upper, lower = getattr(whole, name)[18:], getattr(whole, name)[18::-1]
        mirrored = lower if name == "u" else -lower
        apart = float(np.abs(upper - getattr(half, name)).max()) / size
        verified.error(
            f"displacement {name} of the half minus that of the whole block, relative, {element}", apart, 1e-9
        )
        verified.error(
            f"displacement {name} above mid-height minus that below, relative, {element}",
            float(np.abs(upper - mirrored).max()) / size,
            1e-9,
        )
