"""The flat state of the rate-dependent model: a solid with memory, compressed along X and free to expand across it.

Its stress has the form of :mod:`wrinklewave.theory.biaxial`, with histories of the isochoric shape and of J - 1. Over
a step dt a Prony term of relaxation time tau keeps exp(-dt/tau) of its stress and takes up (1 - exp(-dt/tau)) tau/dt
of what came new, which is exact for what grows linearly.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.biaxial import bulk_stiffness, held_stiffness, normal_stress, shape, shear_stiffness

Array = NDArray[np.float64]

LARGEST_CORRECTION = 1e-9
"""Newton's iteration for the transverse stretch ends below it."""
MOST_ITERATIONS = 20


@dataclass(frozen=True)
class SteppedModuli:
    """Relaxing moduli over steps of one length, in units of the substrate's long-term shear modulus.

    Args:
        mu, K: long-term.
        mu_k, K_k: shares of the Prony terms, shape [n_terms].
        keep, add: what a term keeps of its stress over a step, and takes up of new stress; shape [n_terms].
    """

    mu: float
    K: float
    mu_k: Array
    K_k: Array
    keep: Array
    add: Array

    @property
    def mu_acting(self) -> float:
        """Shear modulus that acts on what comes new in a step."""
        return self.mu + self.mu_added

    @property
    def K_acting(self) -> float:
        """The same of the bulk modulus."""
        return self.K + self.K_added

    @property
    def relaxes(self) -> bool:
        return self.keep.size > 0

    @property
    def mu_added(self) -> float:
        """Its part that relaxes."""
        return float(self.add @ self.mu_k)

    @property
    def K_added(self) -> float:
        """Its part that relaxes."""
        return float(self.add @ self.K_k)


def stepped_moduli(solid: Viscoelastic, *, step: float, unit: float) -> SteppedModuli:
    """Moduli in units of ``unit`` [Pa], for steps of length ``step`` [s]."""
    ratio = step / solid.tau_k
    return SteppedModuli(
        mu=solid.mu_inf / unit,
        K=solid.K_inf / unit,
        mu_k=solid.mu_k / unit,
        K_k=solid.K_k / unit,
        keep=np.exp(-ratio),
        add=-np.expm1(-ratio) / ratio,
    )


@dataclass(frozen=True)
class FlatState:
    """Flat solid at some points, shapes for P points and n Prony terms.

    Args:
        transverse_stretch: l2, shape [P].
        axial_stress: S_11, shape [P]; S_22 = 0.
        stiffness: 1111, 2222, 1122, 1212 of increments within the step just taken, shape [4, P].
        shape: 11, 22, 33, shape [3, P].
        dilation: J - 1, shape [P].
        relaxing_shear, relaxing_mean: what the terms add to A and p, shapes [n, 3, P] and [n, P].
    """

    transverse_stretch: Array
    axial_stress: Array
    stiffness: Array
    shape: Array
    dilation: Array
    relaxing_shear: Array
    relaxing_mean: Array


def flat_at_rest(moduli: SteppedModuli, n_points: int) -> FlatState:
    """Return the undeformed solid."""
    n, P = moduli.keep.size, n_points
    zero = np.zeros(P)
    return FlatState(
        transverse_stretch=np.ones(P),
        axial_stress=zero,
        stiffness=np.zeros((4, P)),
        shape=np.zeros((3, P)),
        dilation=zero,
        relaxing_shear=np.zeros((n, 3, P)),
        relaxing_mean=np.zeros((n, P)),
    )


def flat_step(before: FlatState, stretch: Array, moduli: SteppedModuli) -> FlatState:
    """Compress the solid to the axial ``stretch`` [P] within one step."""
    left_A = np.tensordot(moduli.keep, before.relaxing_shear, axes=1) - moduli.mu_added * before.shape
    left_p = moduli.keep @ before.relaxing_mean - moduli.K_added * before.dilation

    l2 = before.transverse_stretch
    for _ in range(MOST_ITERATIONS):
        now = np.array(shape(stretch, l2))
        A, p = left_A + moduli.mu_acting * now, left_p + moduli.K_acting * (stretch * l2 - 1.0)
        axial, transverse = normal_stress(stretch, l2, tuple(A), p)
        stiffness = np.array(held_stiffness(stretch, l2, tuple(A), p))
        stiffness += moduli.mu_acting * np.array(shear_stiffness(stretch, l2))
        stiffness += moduli.K_acting * np.array(bulk_stiffness(stretch, l2))
        correction = transverse / (l2 * stiffness[1])
        if np.abs(correction).max() < LARGEST_CORRECTION:
            break
        l2 = l2 - correction
    dilation = stretch * l2 - 1.0
    keep, add = moduli.keep[:, np.newaxis], moduli.add[:, np.newaxis]
    grown_A = moduli.mu_k[:, np.newaxis, np.newaxis] * (now - before.shape)
    grown_p = moduli.K_k[:, np.newaxis] * (dilation - before.dilation)
    return FlatState(
        transverse_stretch=l2,
        axial_stress=axial,
        stiffness=stiffness,
        shape=now,
        dilation=dilation,
        relaxing_shear=keep[..., np.newaxis] * before.relaxing_shear + add[..., np.newaxis] * grown_A,
        relaxing_mean=keep * before.relaxing_mean + add * grown_p,
    )
