"""The paper's impact with the film in the mesh, at its full size: whole to the end, and what the model makes of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from support.ledger import Verified
from wrinklewave.config import load_case
from wrinklewave.experiments.simulate import simulate
from wrinklewave.experiments.simulated_surface import rewrinkled
from wrinklewave.experiments.wrinkle_study import Member, agreement

pytestmark = pytest.mark.paper_size

CASE = Path(__file__).parents[2] / "examples" / "paper_resolved.toml"
ALONE = ("wrinkles.model=none", "mesh.elements=[202, 74]", "mesh.grading=[1, 1]")
RANDOM = "film.imperfection={kind='random', amplitude='60 um', wavelengths=['1 mm', '4 mm'], seed=4}"


@pytest.mark.parametrize(
    ("imperfection", "end"),
    [
        ("film.imperfection.amplitude=60 um", ()),
        (RANDOM, ()),
        ("film.imperfection.amplitude=60 um", ("film.end_gap=1 mm", "boundaries.slip=1.2 mm")),
        (RANDOM, ("film.end_gap=1 mm", "boundaries.slip=1.2 mm")),
    ],
    ids=["sinusoidal", "random", "sinusoidal, gap", "random, gap"],
)
def test_no_element_inverts(imperfection: str, end: tuple[str, ...], verified: Verified) -> None:
    # a run stops where a volume ratio leaves its range; energy is kept to the end
    run = simulate(load_case(CASE, [imperfection, *end]), threads=1)
    assert run.summary["simulated_time_s"] == pytest.approx(5e-3)
    kind = ("random" if "random" in imperfection else "sinusoidal") + (", gap" if end else "")
    verified.between(f"least volume ratio, 60 um {kind}", run.summary["volume_ratio_min"], 0.15, 1.0)
    verified.error(f"energy imbalance, 60 um {kind}", run.summary["energy_imbalance_max"], 0.005)


@pytest.mark.parametrize("amplitude", ["10 um", "30 um"])
def test_rate_dependent_model_agrees(amplitude: str, verified: Verified) -> None:
    # the same impact on the substrate alone, and the amplitude equation driven by its surface strain
    resolved = load_case(CASE, [f"film.imperfection.amplitude={amplitude}"])
    surfaces = [simulate(case, threads=1).surface for case in (resolved, resolved.overridden(*ALONE))]
    assert surfaces[0] is not None
    assert surfaces[1] is not None
    model = rewrinkled(surfaces[1], resolved.overridden("wrinkles.model=rate-dependent"))
    fit = agreement(
        Member(amplitude, resolved, {"resolved": surfaces[0], "rate-dependent": model}), "rate-dependent"
    )
    for what, found in (
        ("amplitude over resolved, median", fit.median),
        ("amplitude over resolved, 5 %", fit.low),
        ("amplitude over resolved, 95 %", fit.high),
        ("onset time over resolved", fit.onset),
    ):
        verified.value(f"{what}, {amplitude}", found, 1.0, relative=0.1)
    assert np.isfinite(fit.mean)
