"""The benchmarks' cases from plain numbers are those of the case files."""

import sys
from pathlib import Path

import numpy as np
import pytest

from wrinklewave.config import load_case
from wrinklewave.dynamics.model import build_model

REPOSITORY = Path(__file__).parents[2]
PAPER, RESOLVED = (REPOSITORY / "examples" / f"paper_{name}.toml" for name in ("impact", "resolved"))


@pytest.fixture(autouse=True)
def benchmarks(monkeypatch):
    monkeypatch.setattr(sys, "path", [str(REPOSITORY), *sys.path])


def assert_same(model, other):
    for name in ("X", "Y", "moduli", "terms", "inverse_mass"):
        assert getattr(model.arrays, name) == pytest.approx(getattr(other.arrays, name), rel=1e-9), name
    for mine, others in zip(model.boundary, other.boundary, strict=True):
        assert np.array_equal(mine, others)


@pytest.mark.parametrize(("bulk", "K"), [("elastic-long-term", "K_0"), ("elastic-instantaneous", "K_I")])
def test_paper_case(bulk, K):
    from benchmarks import parts

    assert_same(
        parts.paper(K=getattr(parts, K)),
        build_model(load_case(PAPER, [f"substrate.bulk_response={bulk}"])),
    )


def test_resolved_case_without_its_imperfection():
    from benchmarks import parts

    case = load_case(RESOLVED, ["film.imperfection.amplitude=1e-9 um", "solver.subcycling=false"])
    assert_same(parts.resolved(), build_model(case))
