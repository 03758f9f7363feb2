"""The case P1 against finite-element codes that others wrote: an elastic block whose end moves off at 10 m/s.

Fully integrated quadrilaterals in dolfinx, FElupe, scikit-fem and SfePy agree with each other to all digits; one-point
quadrilaterals with a light hourglass stiffness come from a code of their own. The elements differ from each other by
0.1 %, which is what separates the two columns and bounds what can be asked for. 202 x 74 elements, 500 steps of 2 us.
"""

from __future__ import annotations

import numpy as np
import pytest

from support.ledger import Verified
from support.models import build, elastic, march
from wrinklewave.dynamics.boundary import FIXED, LEFT_MOVED, ROLLER
from wrinklewave.mesh.block import block

FULLY_INTEGRATED = (12.0542, 5.89295, 7.12516)
ONE_POINT = (12.0622, 5.8865, 7.12876)
NAMES = ("u_y of the top left corner", "u_x at X = 15 mm", "u_y at X = 15 mm")


@pytest.mark.parametrize(
    ("element", "hourglass", "expected", "within"),
    [
        ("one-point", 0.1, ONE_POINT, 5e-4),
        ("one-point", 1.0, ONE_POINT, 1e-3),
        ("mean-dilatation", 1.0, FULLY_INTEGRATED, 1e-3),
    ],
)
def test_elastic_impact(
    element: str, hourglass: float, expected: tuple[float, ...], within: float, verified: Verified
) -> None:
    V, dt = 10.0, 2e-6
    mesh = block(length=50.4e-3, bottom=0.0, top=18.5e-3, elements=(202, 74))
    model = build(
        mesh,
        elastic(),
        element,
        left=LEFT_MOVED,
        right=FIXED,
        bottom=ROLLER,
        motion=np.array([[0.0, 1.0, 0.0, V, V, V]]),
        hourglass=hourglass,
    )
    for _ in march(model, dt, 500):
        pass
    a, column = model.arrays, int(np.argmin(np.abs(mesh.X[-1] - 15e-3)))
    found = (a.w[-1, 0], a.u[-1, column], a.w[-1, column])
    control = f", hourglass factor {hourglass:g}" if element == "one-point" else ""
    for name, value, reference in zip(NAMES, found, expected, strict=True):
        verified.value(
            f"{name}, {element}{control}", 1e3 * float(value), reference, relative=within, unit="mm"
        )
