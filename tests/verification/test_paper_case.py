"""The paper's impact at its full size: energy balance, hourglass control, elements compared, mesh convergence.

Each run is made once and serves all tests here.
"""

from __future__ import annotations

import numpy as np
import pytest

from support.cases import BULK_RESPONSES, COARSE, FINE, PAPER, paper_impact
from support.ledger import Verified
from support.models import ELEMENTS

pytestmark = pytest.mark.paper_size


@pytest.mark.parametrize("bulk", BULK_RESPONSES)
@pytest.mark.parametrize("element", ELEMENTS)
def test_energy_balance(element: str, bulk: str, verified: Verified) -> None:
    # stored + dissipated + kinetic + lost in contact = external work, at every row of the history
    run = paper_impact(element, bulk)
    verified.error(
        f"energy imbalance over external work, K {bulk}, {element}", run.summary["energy_imbalance_max"], 1e-3
    )


@pytest.mark.parametrize("bulk", BULK_RESPONSES)
def test_hourglass_control(bulk: str, verified: Verified) -> None:
    one_point, full = (paper_impact(element, bulk).summary for element in ELEMENTS)
    verified.error(
        f"hourglass energy over internal energy, K {bulk}", one_point["hourglass_energy_share_max"], 0.01
    )
    verified.between(
        f"largest hourglass amplitude over that of the fully integrated element, K {bulk}",
        one_point["hourglass_amplitude_max"] / full["hourglass_amplitude_max"],
        0.0,
        1.5,
    )


@pytest.mark.parametrize("bulk", BULK_RESPONSES)
def test_both_elements_move_alike(bulk: str, verified: Verified) -> None:
    # up to where the surface folds onto itself at the held end, a place that no mesh resolves
    one_point, full = (paper_impact(element, bulk).surface for element in ELEMENTS)
    assert one_point is not None
    assert full is not None
    before_the_fold = one_point["X"].values <= 40e-3
    for name in ("x_p", "y_p"):
        apart = np.abs(one_point[name].values - full[name].values)[:, before_the_fold].max()
        verified.error(
            f"{name} of both elements, difference over the striker's travel, K {bulk}",
            float(apart) / 6.3e-3,
            4e-3,
        )


@pytest.mark.parametrize("element", ELEMENTS)
def test_wavefront_speed_converges(element: str, verified: Verified) -> None:
    coarse, paper, fine = (
        paper_impact(element, "elastic-long-term", mesh).summary["wavefront_speed_m_per_s"]
        for mesh in (COARSE, PAPER, FINE)
    )
    verified.between(f"c_S of the paper case in m/s, K elastic-long-term, {element}", paper, 50.0, 68.0)
    verified.error(
        f"c_S with 0.25 mm minus that with 0.125 mm, relative, {element}", abs(paper / fine - 1), 0.01
    )
    verified.between(
        f"change of c_S from 0.25 to 0.125 mm over that from 0.5 to 0.25 mm, {element}",
        abs(fine - paper) / abs(paper - coarse),
        0.0,
        0.6,
    )
