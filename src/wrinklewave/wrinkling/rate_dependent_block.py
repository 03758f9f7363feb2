"""Wrinkles on a whole block: the film also holds the surface back, above all near an end that flies free.

A film that is compressed pushes the surface apart. Where its force changes along the surface, it strains the
substrate below it, over a distance of about h E'_f/E'_s, shorter while the substrate is stiff. So the strain of the
film-free block, from a simulation of the substrate alone, is corrected by the motion with which the block answers the
film's force (:mod:`wrinklewave.wrinkling.block_motion`): linear, with inertia and memory, one matrix for all steps.
A block that is compressed already is stiffer along itself than that; so the force counts for less by that factor, which
is exact where stress and strain do not vary over the depth.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import wraps
from typing import TYPE_CHECKING, NamedTuple, ParamSpec, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wrinklewave.errors import InputError, RunError
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.wrinkling.block_elements import block_elements
from wrinklewave.wrinkling.block_motion import (
    Answer,
    BlockMotion,
    MotionState,
    answer,
    block_motion,
    displacements,
    motion_at_rest,
    motion_step,
    undriven,
)
from wrinklewave.wrinkling.rate_dependent import (
    CompetingWrinkles,
    FilmLayer,
    at_times,
    checked_history,
    prepared,
)
from wrinklewave.wrinkling.rate_dependent_film import Array
from wrinklewave.wrinkling.rate_dependent_march import (
    BegunStep,
    Bilayer,
    Meeting,
    WrinkleState,
    at_rest,
    begin_step,
    compressive_force,
    end_step,
    expected_film_strain,
    meet_film,
)

if TYPE_CHECKING:
    from scipy.sparse import csr_array

P = ParamSpec("P")
R = TypeVar("R")

CELLS = 96
"""Along the block, for the motion along the surface and for the wrinkles on it."""
STRAIN_RESERVE = 0.1
"""By which the film may strain the surface further than it was without it."""
TOLERANCE = 1e-5
"""Of the surface's strain."""
MOST_ITERATIONS = 40


@dataclass(frozen=True)
class Block:
    """A block and the film on it: lengths in metres, ``depth`` from the surface to the plane of symmetry."""

    length: float
    depth: float
    film_end: float


def one_blas_thread(function: Callable[P, R]) -> Callable[P, R]:
    """Matrices of a hundred rows: threads of BLAS make them two to four times slower."""

    @wraps(function)
    def alone(*args: P.args, **kwargs: P.kwargs) -> R:
        import scipy.linalg  # noqa: F401  # brings a BLAS of its own, which must be there to be told
        from threadpoolctl import threadpool_limits

        with threadpool_limits(1, user_api="blas"):
            return function(*args, **kwargs)

    return alone


class BlockWrinkles(NamedTuple):
    """Wrinkles on a block, and the compressive strain of the surface below them, shape [n_times, n_points]."""

    wrinkles: CompetingWrinkles
    strain: Array


@dataclass(frozen=True)
class Bearing:
    """What the film pushes against.

    Args:
        motion: of the block.
        film: force per width [N/m] of a nominal stress of 1 in the film, times the cell's length, shape [n_cells].
    """

    motion: BlockMotion
    film: Array


@dataclass(frozen=True)
class BlockState:
    """Wrinkles, the block's motion by the film, and the surface strain of that motion in this step and the last.

    ``touching`` says which nodes of the struck end touch their plate.
    """

    wrinkles: WrinkleState
    motion: MotionState
    added: Array
    added_last: Array
    touching: NDArray[np.bool_]


@one_blas_thread
def wrinkles_on_block(
    time: ArrayLike,
    X: ArrayLike,
    strain: ArrayLike,
    *,
    block: Block,
    film: FilmLayer,
    substrate: Viscoelastic,
    wavelengths: ArrayLike,
    imperfection: ArrayLike,
    gap: ArrayLike = 0.0,
) -> BlockWrinkles:
    """Follow the wrinkles on a block, given how its surface is strained without a film.

    Args:
        time: increasing [s], shape [n_times].
        X: undeformed positions of the surface points [m], shape [n_points], increasing.
        strain: nominal compressive strain along the film-free surface, shape [n_times, n_points].
        block: its size, and where the film ends.
        film: on its surface.
        substrate: relaxing moduli.
        wavelengths: of wrinkles and imperfection, undeformed [m], shape [n_wavelengths].
        imperfection: amplitudes of the stress-free film [m]: one, or shape [n_wavelengths], or
            [n_points, n_wavelengths], complex where the phases of the waves are known.
        gap: distance of the film-free block's struck end from its plate [m], zero where they touch or where the end
            is moved by prescription; one, or shape [n_times].

    Raises:
        InputError: if times, positions or strains make no sense.
        RunError: if the wrinkles cannot be followed.
    """
    time, strain = checked_history(time, strain)
    X = np.asarray(X, dtype=float)
    if X.shape != strain.shape[1:] or not (np.diff(X) > 0).all():
        raise InputError(
            f"positions have shape {X.shape}", key="X", expected="an increasing position per point"
        )
    elements = block_elements(length=block.length, depth=block.depth, n_cells=CELLS)
    centres = elements.centres
    at_cells = at_times(centres, X, strain.T).T
    seed = np.asarray(imperfection)
    if seed.ndim == 2:
        seed = at_times(centres, X, seed)
    instants, bilayer, lengths = prepared(
        time, at_cells, film, substrate, wavelengths, seed, reserve=STRAIN_RESERVE
    )
    reach = float(np.median(lengths))
    elements = replace(elements, shortening=_means(centres, reach) @ elements.shortening)
    bearing = Bearing(
        motion=block_motion(elements, substrate, step=bilayer.step),
        film=substrate.mu_inf
        * film.thickness
        * elements.cell
        * (centres < block.film_end).astype(np.float64),
    )
    gaps = np.interp(instants, time, np.broadcast_to(np.asarray(gap, dtype=float), time.shape))
    grown, strains = _march(at_times(instants, time, at_cells), gaps, bilayer, bearing)
    amplitude = np.moveaxis(at_times(time, instants, grown), 1, 2) * lengths / (2 * np.pi)
    points = np.clip(X, centres[0], centres[-1])
    return BlockWrinkles(
        CompetingWrinkles(
            lengths, np.moveaxis(at_times(points, centres, np.moveaxis(amplitude, 1, 0)), 0, 1)
        ),
        at_times(points, centres, at_times(time, instants, strains).T).T,
    )


def cell_centres(block: Block) -> Array:
    """Undeformed positions [m] at which the model follows the wrinkles of a block."""
    return (np.arange(CELLS) + 0.5) * block.length / CELLS


def _means(centres: Array, reach: float) -> csr_array:
    """Means over the cells within ``reach`` [m] on either side, by a Hann window, sparse, shape [n_cells, n_cells].

    The window is folded back at the ends, so that the matrix is symmetric and even forces stay even.

    A wrinkle feels the strain of its wavelength, not of a point: one that softens the film would else draw all strain
    into a single cell.
    """
    from scipy.sparse import csr_array

    def window(distance: Array) -> Array:
        return np.where(distance < reach, 0.5 + 0.5 * np.cos(np.pi * distance / reach), 0.0)

    mirrored = (
        2 * centres[-1] + centres[1] - centres[0] - centres
    )  # at the held end, and at the struck one, -centres
    weights = sum(window(np.abs(there - centres[:, np.newaxis])) for there in (centres, -centres, mirrored))
    return csr_array(weights / window(np.abs(centres - centres[centres.size // 2])).sum())


def _march(strain: Array, gaps: Array, bilayer: Bilayer, bearing: Bearing) -> tuple[Array, Array]:
    """Follow wrinkles and surface through film-free strains [n_steps, n_cells]: k A, and strains with the film."""
    none, touching = (
        np.zeros(strain.shape[1]),
        np.full(int(bearing.motion.elements.end.sum()), gaps[0] <= 0.0),
    )
    state = BlockState(at_rest(bilayer), motion_at_rest(bearing.motion), none, none, touching)
    grown, strains = np.empty((strain.shape[0], *bilayer.imperfection.shape)), np.empty_like(strain)
    grown[0], strains[0] = state.wrinkles.top, strain[0]
    for n in range(1, strain.shape[0]):
        state = block_step(state, strain[n], gaps[n], bilayer, bearing)
        grown[n], strains[n] = state.wrinkles.top, state.wrinkles.strain
    return grown, strains


def block_step(
    state: BlockState, strain: Array, gap: float, bilayer: Bilayer, bearing: Bearing
) -> BlockState:
    """Bring the block to the film-free ``strain`` [n_cells] within one step.

    Raises:
        RunError: if film and surface cannot be found in equilibrium.
    """
    motion = bearing.motion
    end, alone = motion.elements.end, undriven(state.motion, motion)
    begun = begin_step(state.wrinkles, strain + 2 * state.added - state.added_last, bilayer)
    film = bearing.film / _stiffening(begun, bilayer)
    touching = state.touching if gap > 0.0 else np.ones_like(state.touching)
    for _ in range(touching.size):  # nodes of the end meet the plate and leave it: it pushes, and never pulls
        within = answer(motion, alone, touching, gap)
        met, force = _balanced(state.wrinkles, begun, strain, within, film, bilayer)
        u, pressing = displacements(motion, within, force)
        now = np.where(touching, (pressing > 0.0) | (gap <= 0.0), u[end] < -gap)
        if (now == touching).all():
            break
        touching = now
    moved = motion_step(state.motion, u, motion)
    return BlockState(end_step(begun, met, bilayer), moved, met.strain - strain, state.added, touching)


def _balanced(
    wrinkles: WrinkleState, begun: BegunStep, strain: Array, within: Answer, film: Array, bilayer: Bilayer
) -> tuple[Meeting, Array]:
    """Film and wrinkles at the surface strain at which film and block push alike, and the film's forces, [n_cells]."""
    without, compliance = strain + within.strain, within.compliance * film
    reached, guess, slope = begun.strain, expected_film_strain(wrinkles, begun.strain), wrinkles.slope
    for _ in range(MOST_ITERATIONS):
        met = meet_film(begun, reached, guess, slope, bilayer)
        force, rise = compressive_force(met, bilayer)
        residual = reached - without + compliance @ force
        change = -np.linalg.solve(np.eye(reached.size) + compliance * rise, residual)
        reached = reached + change
        guess, slope = met.film_strain + change / met.slope, met.slope
        if np.abs(change).max() < TOLERANCE:
            return met, film * (force + rise * change)
    raise RunError("film and surface do not come into equilibrium along the block")


def _stiffening(begun: BegunStep, bilayer: Bilayer) -> Array:
    """How much more stress along itself a compressed block takes up per strain than one at rest, shape [n_cells]."""
    along, across, between, _ = begun.flat.stiffness
    mu, K = bilayer.substrate.mu_acting, bilayer.substrate.K_acting
    now = begun.flat.axial_stress + (1.0 - begun.strain) ** 2 * (along - between**2 / across)
    return now / (4 * mu * (3 * K + mu) / (3 * K + 4 * mu))
