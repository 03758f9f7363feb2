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
    isochoric_energy,
    isochoric_shape,
    right_cauchy_green,
    second_piola_kirchhoff,
)

component = st.floats(-0.3, 0.3)
stress = st.tuples(*[st.floats(-2.0, 2.0)] * 5)


def test_the_inverse_cube_root_is_accurate_to_rounding_in_its_whole_range() -> None:
    J = np.linspace(J_MIN, J_MAX, 20001)
    found = np.array([inverse_cube_root(j) for j in J])
    exact = np.longdouble(J) ** (-np.longdouble(1) / 3)
    assert np.abs(found / exact - 1).max() < 4 * np.finfo(float).eps


@given(component, component, component, component, st.floats(0.1, 10.0), st.floats(0.1, 10.0))
def test_stress_is_the_derivative_of_the_energy(
    a: float, b: float, c: float, d: float, mu: float, K: float
) -> None:
    """S = 2 dW/dC, exact to rounding by complex steps in C_11, C_22 and C_12 = C_21."""

    def energy(C11: complex, C22: complex, C12: complex) -> complex:
        J = (C11 * C22 - C12 * C12) ** 0.5
        return mu * isochoric_energy.py_func(C11, C22, J ** (-2 / 3)) + K / 2 * (J - 1) ** 2

    F = np.array([[1 + a, b], [c, 1 + d]])
    C, J = right_cauchy_green(*F.ravel()), float(np.linalg.det(F))
    A = [mu * s for s in isochoric_shape(*C, J**-2.0)]
    S = second_piola_kirchhoff(*A, *C, J, J ** (-2 / 3), J**-2.0, K * (J - 1))
    by_C = [energy(*(C + 1e-30j * step)).imag / 1e-30 for step in np.eye(3)]
    np.testing.assert_allclose(S, [2 * by_C[0], 2 * by_C[1], by_C[2]], rtol=1e-9, atol=1e-11 * (mu + K))
    np.testing.assert_allclose(C, (F.T @ F)[[0, 1, 0], [0, 1, 1]], rtol=1e-14)


@given(component, component, component, component)
def test_shape_of_the_stress_has_no_part_that_changes_the_volume(
    a: float, b: float, c: float, d: float
) -> None:
    F = np.array([[1 + a, b], [c, 1 + d]])
    C11, C22, C12 = right_cauchy_green(*F.ravel())
    s11, s22, s12, s33 = isochoric_shape(C11, C22, C12, float(np.linalg.det(F)) ** -2.0)
    assert abs(s11 * C11 + s22 * C22 + 2 * s12 * C12 + s33) < 1e-12  # DEV[1] : C = 0


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
