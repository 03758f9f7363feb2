"""A stretched solid: its stress is the derivative of its energy, its stiffness that of its stress."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.theory.biaxial import (
    bulk_stiffness,
    held_stiffness,
    normal_stress,
    shape,
    shape_increments,
    shear_stiffness,
)

stretches = st.floats(0.6, 1.6)
moduli = st.floats(0.1, 10.0)
STEP = 1e-30


def slopes(function: Callable[[Any, Any], Any], l1: float, l2: float) -> tuple[Any, Any]:
    """Derivatives by the squares of the stretches, C_11/2 and C_22/2, exact to rounding (complex step)."""
    by_l1, by_l2 = function(l1 + 1j * STEP, l2), function(l1, l2 + 1j * STEP)
    return [part.imag / STEP / l1 for part in by_l1], [part.imag / STEP / l2 for part in by_l2]


def stress(mu: float, K: float) -> Callable[[Any, Any], Any]:
    return lambda l1, l2: normal_stress(l1, l2, [mu * s for s in shape(l1, l2)], K * (l1 * l2 - 1.0))


@given(stretches, stretches, moduli, moduli)
def test_stress_is_the_derivative_of_the_energy(l1: float, l2: float, mu: float, K: float) -> None:
    def energy(l1: Any, l2: Any) -> Any:
        J = l1 * l2
        return [mu / 2 * (J ** (-2 / 3) * (l1 * l1 + l2 * l2 + 1) - 3) + K / 2 * (J - 1) ** 2]

    (S_11,), (S_22,) = slopes(energy, l1, l2)
    assert stress(mu, K)(l1, l2) == pytest.approx([S_11, S_22], rel=1e-9, abs=1e-12)


@given(stretches, stretches, moduli, moduli)
def test_stiffness_is_the_derivative_of_the_stress(l1: float, l2: float, mu: float, K: float) -> None:
    """All of it: at constant A and p, by A = mu shape, and by p = K (J - 1)."""
    A, p = [mu * s for s in shape(l1, l2)], K * (l1 * l2 - 1.0)
    held, shear, bulk = held_stiffness(l1, l2, A, p), shear_stiffness(l1, l2), bulk_stiffness(l1, l2)
    c_1111, c_2222, c_1122, c_1212 = (h + mu * s + K * b for h, s, b in zip(held, shear, bulk, strict=True))
    by_1, by_2 = slopes(stress(mu, K), l1, l2)
    close = 1e-9 * (mu + K)
    assert [c_1111, c_1122] == pytest.approx(by_1, rel=1e-9, abs=close)
    assert [c_1122, c_2222] == pytest.approx(by_2, rel=1e-9, abs=close)
    # an isotropic solid: C and S turn together, dS_12 = (S_11 - S_22)/(C_11 - C_22) dC_12
    S_11, S_22 = stress(mu, K)(l1, l2)
    assert c_1212 * (l1**2 - l2**2) == pytest.approx(S_11 - S_22, rel=1e-9, abs=close)


@given(stretches, stretches, st.floats(-1.0, 1.0), st.floats(-1.0, 1.0), st.floats(-1.0, 1.0))
def test_increments_of_the_shape_are_its_derivative(
    l1: float, l2: float, e_11: float, e_22: float, g_12: float
) -> None:
    by_1, by_2 = slopes(shape, l1, l2)
    d_11, d_22, d_33 = (e_11 * one + e_22 * two for one, two in zip(by_1, by_2, strict=True))
    found = shape_increments(l1, l2, e_11, e_22, g_12)
    assert (found[0], found[1], found[3]) == pytest.approx((d_11, d_22, d_33), rel=1e-9, abs=1e-12)
    s_11, s_22, _ = shape(l1, l2)  # turns with C, as the stress does
    assert found[2] * (l1**2 - l2**2) == pytest.approx(g_12 * (s_11 - s_22), rel=1e-9, abs=1e-12)
