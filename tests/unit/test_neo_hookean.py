"""The neo-Hookean law's arithmetic: what the kernels take for granted."""

from __future__ import annotations

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.materials.neo_hookean import (
    J_MAX,
    J_MIN,
    first_piola_kirchhoff,
    inverse_cube_root,
    second_piola_kirchhoff,
)

component = st.floats(-0.3, 0.3)
stress = st.tuples(*[st.floats(-2.0, 2.0)] * 5)


def test_the_inverse_cube_root_is_accurate_to_rounding_in_its_whole_range() -> None:
    J = np.linspace(J_MIN, J_MAX, 20001)
    found = np.array([inverse_cube_root(j) for j in J])
    exact = np.longdouble(J) ** (-np.longdouble(1) / 3)
    assert np.abs(found / exact - 1).max() < 4 * np.finfo(float).eps


@given(component, component, component, component, stress)
def test_first_piola_kirchhoff_is_f_times_second(
    a: float, b: float, c: float, d: float, A: tuple[float, ...]
) -> None:
    F = np.array([[1 + a, b], [c, 1 + d]])
    C, J = F.T @ F, float(np.linalg.det(F))
    C_ = (C[0, 0], C[1, 1], C[0, 1])
    *A_, p = A
    S11, S22, S12 = second_piola_kirchhoff(*A_, *C_, J, J ** (-2 / 3), J**-2.0, p)
    P = first_piola_kirchhoff(*F.ravel(), *A_, *C_, J ** (-2 / 3), 1 / J, p)
    expected = F @ np.array([[S11, S12], [S12, S22]])
    np.testing.assert_allclose(np.reshape(P, (2, 2)), expected, rtol=0, atol=1e-13)
