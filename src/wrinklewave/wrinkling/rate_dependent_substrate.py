"""The substrate of the rate-dependent model: a half-space with memory and inertia, as two functions of the depth.

It moves as U(Y) sin kX along and V(Y) cos kX across the surface, with

    U = U0 phi_0 + U1 phi_1,   V = V0 phi_0 + V1 phi_1,   phi_0 = exp(q Z),   phi_1 = Z exp(q Z),   Z = k Y < 0,

which holds the exact static motions of an unstrained half-space (q = 1). Each component of its strain increments, and
of the stresses that they leave behind, is then two coefficients too. Symbols as in ``docs/theory_wrinkling.md``;
lengths in 1/k, stresses in the substrate's long-term shear modulus, times in seconds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wrinklewave.theory.biaxial import shape_increments
from wrinklewave.wrinkling.rate_dependent_flat import FlatState, SteppedModuli

Array = NDArray[np.float64]

DECAY = 1.08
"""q. The exact shapes decay with 1 and l2/l1: this one keeps the half-space's stiffness to 1 % up to 15 % strain."""
PRODUCTS = np.array([[0.5 / DECAY, -0.25 / DECAY**2], [-0.25 / DECAY**2, 0.25 / DECAY**3]])
"""Integrals over the depth of phi_a phi_b."""
SLOPES = np.array([[0.5, -0.25 / DECAY], [0.25 / DECAY, 0.0]])
"""Integrals of phi_a' phi_b."""
SLOPE_PRODUCTS = np.array([[0.5 * DECAY, 0.25], [0.25, 0.25 / DECAY]])
"""Integrals of phi_a' phi_b'."""

GAMMA = 0.51
BETA = 0.25 * (GAMMA + 0.5) ** 2
"""Newmark's scheme, unconditionally stable, with a trace of damping for the shortest oscillations."""


@dataclass(frozen=True)
class WaveState:
    """Waves on the substrate, shapes for M wavenumbers, P points and n Prony terms.

    Args:
        U, V: coefficients of phi_0 and phi_1, shape [2, M, P].
        velocity, acceleration: of U and V, shape [2, 2, M, P].
        shape: increments 11, 22, 12, 33 (first axis) of the isochoric shape by depth function (second axis), shape
            [4, 2, M, P].
        dilation: increments of J by depth function, shape [2, M, P].
        relaxing_shear, relaxing_mean: what the terms add to the increments of A and p, shapes [n, 4, 2, M, P] and
            [n, 2, M, P].
    """

    U: Array
    V: Array
    velocity: Array
    acceleration: Array
    shape: Array
    dilation: Array
    relaxing_shear: Array
    relaxing_mean: Array


@dataclass(frozen=True)
class Interface:
    """What resists the motion (U0, V0) of the interface within a step: force = stiffness (U0, V0) + force at rest.

    Args:
        k_00, k_01, k_11: stiffness, shape [M, P].
        force: along and across, shape [2, M, P].
        u1, v1: rows (at rest, per U0, per V0) of U1 and V1, which follow, shape [3, M, P] each.
        predicted: U and V that inertia alone leads to, shape [2, 2, M, P].
    """

    k_00: Array
    k_01: Array
    k_11: Array
    force: Array
    u1: Array
    v1: Array
    predicted: Array


def waves_at_rest(moduli: SteppedModuli, n_wavenumbers: int, n_points: int) -> WaveState:
    """Return the substrate before anything has moved."""
    M, P = n_wavenumbers, n_points
    n, coefficients, pair = moduli.keep.size, np.zeros((2, M, P)), np.zeros((2, 2, M, P))
    return WaveState(
        U=coefficients,
        V=coefficients,
        velocity=pair,
        acceleration=pair,
        shape=np.zeros((4, 2, M, P)),
        dilation=coefficients,
        relaxing_shear=np.zeros((n, 4, 2, M, P)),
        relaxing_mean=np.zeros((n, 2, M, P)),
    )


def interface(
    waves: WaveState,
    stretch: Array,
    flat: FlatState,
    moduli: SteppedModuli,
    density: Array,
    film_mass: Array,
    step: float,
) -> Interface:
    """Reduce substrate, and inertia of substrate and film, to the interface.

    Args:
        waves: at the step's beginning.
        stretch: l1 at its end, shape [P].
        flat: at its end.
        moduli: of the substrate.
        density: rho/(mu k^2) of the substrate [s^2], shape [M].
        film_mass: 00, 01, 11 [s^2], shape [3, M, 1].
        step: its length [s].
    """
    l1, l2 = stretch, flat.transverse_stretch
    c11, c22, c12, c66 = flat.stiffness
    inertia = 1.0 / (BETA * step**2)
    mass = density[:, np.newaxis] * inertia
    m_00, m_01, m_11 = film_mass * inertia
    uu, uu_slopes = l1**2 * c11 + flat.axial_stress + mass, l1**2 * c66
    vv, vv_slopes = l2**2 * c66 + flat.axial_stress + mass, l2**2 * c22
    across = np.broadcast_to(l1 * l2 * (c12 + c66) * SLOPES[1, 0], uu.shape)
    u1_u0, v1_v0 = (
        own * PRODUCTS[0, 1] + slopes * SLOPE_PRODUCTS[0, 1]
        for own, slopes in ((uu, uu_slopes), (vv, vv_slopes))
    )
    u1_u1, v1_v1 = (
        own * PRODUCTS[1, 1] + slopes * SLOPE_PRODUCTS[1, 1]
        for own, slopes in ((uu, uu_slopes), (vv, vv_slopes))
    )
    predicted = np.array([waves.U, waves.V]) + step * waves.velocity
    predicted += step**2 * (0.5 - BETA) * waves.acceleration
    along, across_force = _remembered_forces(waves, l1, l2, moduli)
    along -= mass * np.tensordot(PRODUCTS, predicted[0], axes=1)
    across_force -= mass * np.tensordot(PRODUCTS, predicted[1], axes=1)
    along[0] -= m_00 * predicted[0, 0] + m_01 * predicted[1, 0]
    across_force[0] -= m_01 * predicted[0, 0] + m_11 * predicted[1, 0]

    u1 = -np.array([along[1], u1_u0, -across]) / u1_u1
    v1 = -np.array([across_force[1], across, v1_v0]) / v1_v1
    return Interface(
        k_00=uu * PRODUCTS[0, 0] + uu_slopes * SLOPE_PRODUCTS[0, 0] + m_00 + u1_u0 * u1[1] + across * v1[1],
        k_01=l1 * l2 * (c12 - c66) * SLOPES[0, 0] + m_01 + u1_u0 * u1[2] + across * v1[2],
        k_11=vv * PRODUCTS[0, 0] + vv_slopes * SLOPE_PRODUCTS[0, 0] + m_11 - across * u1[2] + v1_v0 * v1[2],
        force=np.array(
            [along[0] + u1_u0 * u1[0] + across * v1[0], across_force[0] - across * u1[0] + v1_v0 * v1[0]]
        ),
        u1=u1,
        v1=v1,
        predicted=predicted,
    )


def wave_step(
    before: WaveState,
    interface: Interface,
    U0: Array,
    V0: Array,
    stretch: Array,
    flat: FlatState,
    moduli: SteppedModuli,
    step: float,
) -> WaveState:
    """Move the interface to (U0, V0) [M, P] at the end of a step, and everything below it with it."""
    U, V = (
        np.array([here, row[0] + row[1] * U0 + row[2] * V0])
        for here, row in ((U0, interface.u1), (V0, interface.v1))
    )
    acceleration = (np.array([U, V]) - interface.predicted) / (BETA * step**2)
    l1, l2 = stretch, flat.transverse_stretch
    e_11, e_22, g_12 = _strains(U, V, l1, l2)
    shape = np.array(shape_increments(l1, l2, e_11, e_22, g_12))
    dilation = l2 / l1 * e_11 + l1 / l2 * e_22
    relaxing_shear, relaxing_mean = np.empty_like(before.relaxing_shear), np.empty_like(before.relaxing_mean)
    for k, (keep, add) in enumerate(zip(moduli.keep, moduli.add, strict=True)):
        relaxing_shear[k] = keep * before.relaxing_shear[k] + add * moduli.mu_k[k] * (shape - before.shape)
        relaxing_mean[k] = keep * before.relaxing_mean[k] + add * moduli.K_k[k] * (dilation - before.dilation)
    return WaveState(
        U=U,
        V=V,
        velocity=before.velocity + step * ((1 - GAMMA) * before.acceleration + GAMMA * acceleration),
        acceleration=acceleration,
        shape=shape,
        dilation=dilation,
        relaxing_shear=relaxing_shear,
        relaxing_mean=relaxing_mean,
    )


def _remembered_forces(waves: WaveState, l1: Array, l2: Array, moduli: SteppedModuli) -> tuple[Array, Array]:
    """Forces on U and V, shape [2, M, P] each, of the stresses left of earlier steps."""
    A_11, A_22, A_12, A_33 = (
        np.tensordot(moduli.keep, waves.relaxing_shear, axes=1) - moduli.mu_added * waves.shape
    )
    p = np.tensordot(moduli.keep, waves.relaxing_mean, axes=1) - moduli.K_added * waves.dilation
    J = l1 * l2
    factor = J ** (-2.0 / 3.0)
    hydrostatic = J * p - factor * (l1**2 * A_11 + l2**2 * A_22 + A_33) / 3.0
    s_11, s_22, s_12 = factor * A_11 + hydrostatic / l1**2, factor * A_22 + hydrostatic / l2**2, factor * A_12
    along = l1 * (np.tensordot(PRODUCTS, s_11, axes=1) + np.tensordot(SLOPES, s_12, axes=1))
    across = l2 * (np.tensordot(SLOPES, s_22, axes=1) - np.tensordot(PRODUCTS, s_12, axes=1))
    return along, across


def _strains(U: Array, V: Array, l1: Array, l2: Array) -> tuple[Array, Array, Array]:
    """Green strain increments 11, 22 and twice 12, by depth function, shape [2, M, P] each."""
    dU, dV = (np.array([DECAY * W[0] + W[1], DECAY * W[1]]) for W in (U, V))
    return l1 * U, l2 * dV, l1 * dU - l2 * V
