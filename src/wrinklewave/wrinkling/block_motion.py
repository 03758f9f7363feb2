"""How a block of relaxing, linear material moves when a film pushes along its surface, step by step.

    rho m a + K_shear (mu * u) + K_bulk (K * u) = p - B^T N,    mu * u = mu_inf u + sum_k mu_k q_k,
    dq_k/dt = du/dt - q_k / tau_k,

with the matrices of :mod:`wrinklewave.wrinkling.block_elements`, N the compressive forces of the film in the cells
along the surface and p the pressure of a plate on the struck end, whose nodes it pushes and never pulls. Newmark's
scheme takes the steps; within one, the block answers N and p by the same matrices in every step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.wrinkling.block_elements import BlockElements
from wrinklewave.wrinkling.rate_dependent_flat import SteppedModuli, stepped_moduli
from wrinklewave.wrinkling.rate_dependent_substrate import BETA, GAMMA

Array = NDArray[np.float64]


@dataclass(frozen=True)
class BlockMotion:
    """What does not change with time, for n degrees of freedom.

    Args:
        elements: of the block.
        moduli: over the steps.
        density: [kg/m³].
        step: length of the steps [s].
        solve: displacements [m] within a step under forces [N/m], shape [n] each.
        by_film: displacements per unit of film force in each cell, towards the struck end, shape [n, n_cells].
        by_plate: displacements per force on each node of the struck end, shape [n, n_end].
        compliance: compressive strain that the film's force takes from the cells, shape [n_cells, n_cells].
    """

    elements: BlockElements
    moduli: SteppedModuli
    density: float
    step: float
    solve: Callable[[Array], Array]
    by_film: Array
    by_plate: Array
    compliance: Array


@dataclass(frozen=True)
class MotionState:
    """Displacement [m], velocity [m/s] and acceleration [m/s²], shape [n]; ``relaxing`` are q_k, [n_terms, n]."""

    u: Array
    velocity: Array
    acceleration: Array
    relaxing: Array


class Answer(NamedTuple):
    """The block within one step while some nodes of its end touch a plate.

    Args:
        alone: displacements without film and plate [m], shape [n].
        held: forces of the plate per displacement that it takes back, shape [n_end, n_end].
        missing: displacements that the plate asks for, beyond ``alone`` [m], shape [n_end].
        strain: compressive strain of the cells without film, shape [n_cells].
        compliance: as in :class:`BlockMotion`, with the end held.
    """

    alone: Array
    held: Array
    missing: Array
    strain: Array
    compliance: Array


def block_motion(elements: BlockElements, solid: Viscoelastic, *, step: float) -> BlockMotion:
    """Prepare a block of ``solid`` for steps of length ``step`` [s]."""
    from scipy.sparse import diags_array
    from scipy.sparse.linalg import splu

    moduli = stepped_moduli(solid, step=step, unit=1.0)
    inertia = diags_array(solid.density * elements.mass / (BETA * step**2))
    A = moduli.mu_acting * elements.shear + moduli.K_acting * elements.bulk + inertia
    solve = splu(A.tocsc(), permc_spec="MMD_AT_PLUS_A", options={"SymmetricMode": True}).solve
    by_film = solve(elements.shortening.toarray().T)
    ends = np.flatnonzero(elements.end)
    on_end = np.zeros((elements.end.size, ends.size))
    on_end[ends, np.arange(ends.size)] = 1.0
    return BlockMotion(
        elements, moduli, solid.density, step, solve, by_film, solve(on_end), elements.shortening @ by_film
    )


def motion_at_rest(motion: BlockMotion) -> MotionState:
    """Return the block before anything has moved."""
    still = np.zeros(motion.elements.mass.size)
    return MotionState(still, still, still, np.zeros((motion.moduli.keep.size, still.size)))


def undriven(state: MotionState, motion: BlockMotion) -> Array:
    """Displacements [m] at the end of a step to which inertia and memory alone lead, shape [n]."""
    moduli, elements = motion.moduli, motion.elements
    left = moduli.keep[:, np.newaxis] * state.relaxing - moduli.add[:, np.newaxis] * state.u
    inertia = motion.density / (BETA * motion.step**2) * elements.mass * _coasting(state, motion.step)
    return motion.solve(inertia - elements.shear @ (moduli.mu_k @ left) - elements.bulk @ (moduli.K_k @ left))


def answer(motion: BlockMotion, alone: Array, touching: NDArray[np.bool_], gap: float) -> Answer:
    """The block within a step.

    Args:
        motion: of the block.
        alone: from :func:`undriven`.
        touching: nodes of the struck end that touch the plate, shape [n_end].
        gap: distance of the plate from where the struck end would be without any of this [m].
    """
    end = motion.elements.end
    inner = np.ix_(touching, touching)
    held = np.zeros((touching.size, touching.size))
    held[inner] = np.linalg.inv(motion.by_plate[end][inner])
    missing = np.where(touching, -gap - alone[end], 0.0)
    by_plate = motion.by_film[end].T  # strain of the cells: the matrices are symmetric
    strain = motion.elements.shortening @ alone + by_plate @ (held @ missing)
    compliance = motion.compliance - by_plate @ held @ motion.by_film[end]
    return Answer(alone, held, missing, strain, compliance)


def displacements(motion: BlockMotion, within: Answer, force: Array) -> tuple[Array, Array]:
    """Displacements [m], shape [n], and pressing forces of the plate [N/m], shape [n_end], under film forces."""
    pressing = within.held @ (within.missing + motion.by_film[motion.elements.end] @ force)
    return within.alone - motion.by_film @ force + motion.by_plate @ pressing, pressing


def motion_step(state: MotionState, u: Array, motion: BlockMotion) -> MotionState:
    """Take the step to the displacements ``u`` [n]."""
    moduli, step = motion.moduli, motion.step
    acceleration = (u - _coasting(state, step)) / (BETA * step**2)
    velocity = state.velocity + step * ((1 - GAMMA) * state.acceleration + GAMMA * acceleration)
    keep, add = moduli.keep[:, np.newaxis], moduli.add[:, np.newaxis]
    return MotionState(u, velocity, acceleration, keep * state.relaxing + add * (u - state.u))


def _coasting(state: MotionState, step: float) -> Array:
    """Displacements that inertia alone leads to."""
    return state.u + step * state.velocity + step**2 * (0.5 - BETA) * state.acceleration
