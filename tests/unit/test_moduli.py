"""Moduli: relations between them, and the bulk responses."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.config import Case, load_case
from wrinklewave.materials import moduli

ROOT = Path(__file__).parents[2]
K_0, K_i = (2 * mu * 1.49 / (3 * 0.02) for mu in (44e3, 3.394e6))  # E/(3 (1 - 2 nu)), nu = 0.49
ratios, shear_moduli = st.floats(-0.99, 0.4999), st.floats(1.0, 1e9)


@given(shear_moduli, ratios)
def test_relations_close(mu: float, nu: float) -> None:
    E, K = moduli.youngs_modulus(mu, nu), moduli.bulk_modulus(mu, nu)
    assert moduli.shear_modulus(E, nu) == pytest.approx(mu, rel=1e-12)
    assert moduli.poisson_ratio(mu, K) == pytest.approx(nu, abs=1e-10)
    assert 9 * K * mu / (3 * K + mu) == pytest.approx(E, rel=1e-9)
    # plane strain: E/(1 - nu^2) = 4 mu (3 K + mu)/(3 K + 4 mu)
    assert moduli.plane_strain_modulus(E, nu) == pytest.approx(
        4 * mu * (3 * K + mu) / (3 * K + 4 * mu), rel=1e-8
    )
    assert moduli.plane_wave_modulus(mu, K) == pytest.approx(2 * mu * (1 - nu) / (1 - 2 * nu), rel=1e-9)


def paper(*overrides: str) -> Case:
    return load_case(ROOT / "examples" / "paper_impact.toml", overrides)


@pytest.mark.parametrize(
    ("response", "K_inf", "K_instantaneous"),
    [
        ("elastic-long-term", K_0, K_0),
        ("elastic-instantaneous", K_i, K_i),
        ("relaxing", K_0, K_i),
    ],
)
def test_bulk_responses(response: str, K_inf: float, K_instantaneous: float) -> None:
    solid = moduli.substrate_moduli(paper(f"substrate.bulk_response={response}").substrate)
    assert (solid.K_inf, solid.K_instantaneous) == pytest.approx((K_inf, K_instantaneous), rel=1e-9)
    assert (solid.mu_inf, solid.mu_instantaneous) == pytest.approx((44e3, 3.394e6), rel=1e-12)


def test_relaxing_bulk_keeps_poissons_ratio() -> None:
    solid = moduli.substrate_moduli(paper("substrate.bulk_response=relaxing").substrate)
    times = np.array([0.0, 1e-5, 9e-5, 1e-3, 1.0])
    nu = [moduli.poisson_ratio(mu, K) for mu, K in zip(solid.mu(times), solid.K(times), strict=True)]
    assert nu == pytest.approx([0.49] * 5, rel=1e-12)


def test_custom_bulk() -> None:
    case = paper("substrate.bulk_response=custom", "substrate.prony.0.bulk_modulus=5 MPa")
    solid = moduli.substrate_moduli(case.substrate)
    assert solid.K_k.tolist() == [5e6]
    assert solid.K(9e-5) == pytest.approx(solid.K_inf + 5e6 / np.e, rel=1e-12)


def test_elastic_solid_does_not_relax() -> None:
    solid = moduli.substrate_moduli(paper("substrate.prony=[]").substrate)
    assert solid.mu([0.0, 1.0]).tolist() == [44e3, 44e3]
    assert solid.nu_instantaneous == solid.nu_inf == pytest.approx(0.49)


def test_bulk_modulus_instead_of_poissons_ratio() -> None:
    text = (ROOT / "examples" / "paper_impact.toml").read_text(encoding="utf-8")
    from wrinklewave.config import case_from_text

    for response in ("elastic-long-term", "elastic-instantaneous", "relaxing"):
        given_K = case_from_text(
            text.replace("poisson_ratio = 0.49", 'bulk_modulus = "2.1853333333333333 MPa"'),
            overrides=[f"substrate.bulk_response={response}"],
        )
        one = moduli.substrate_moduli(given_K.substrate)
        two = moduli.substrate_moduli(paper(f"substrate.bulk_response={response}").substrate)
        assert (one.K_inf, one.K_instantaneous) == pytest.approx((two.K_inf, two.K_instantaneous), rel=1e-12)
        assert moduli.long_term_poisson_ratio(given_K.substrate) == pytest.approx(0.49, rel=1e-12)
