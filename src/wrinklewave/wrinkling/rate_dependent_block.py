"""Wrinkles on a whole block: the film also holds the surface back, above all near an end that flies free.

A film that is compressed pushes the surface apart. Where its force changes along the surface, it strains the
substrate below it, over a distance of about h E'_f/E'_s, shorter while the substrate is stiff. So the strain of the
film-free block, from a simulation of the substrate alone, is corrected by the motion w(X, t) along the surface with
which the block answers the film's force N:

    K (E' * w) = -dN/dX,    strain = strain without the film - dw/dX,    N = N(strain of the film, wrinkles included),

K the stiffness of the block's surface (:mod:`wrinklewave.wrinkling.block_surface`), stiffened by the mean strain as
a half-space is, E' * the relaxing plane-strain modulus. The struck end keeps to its plate or leaves it, as far as the
plate lets it. Inertia of w is left out.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from wrinklewave.errors import InputError, RunError
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.incremental import half_space_stiffness, prestressed_layer, stroh_matrix
from wrinklewave.theory.plane_strain_relaxation import RelaxingModulus, plane_strain_relaxation
from wrinklewave.wrinkling.block_surface import BlockSurface, block_surface
from wrinklewave.wrinkling.rate_dependent import (
    CompetingWrinkles,
    FilmLayer,
    at_times,
    checked_history,
    prepared,
)
from wrinklewave.wrinkling.rate_dependent_film import Array
from wrinklewave.wrinkling.rate_dependent_march import (
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

CELLS = 96
"""Along the block, for the motion along the surface and for the wrinkles on it."""
STRAIN_RESERVE = 0.1
"""By which the film may strain the surface further than it was without it."""
TOLERANCE = 1e-5
"""Of the surface's strain."""
MOST_ITERATIONS = 40
STIFFENING_STRAINS = np.linspace(-0.1, 0.4, 11)


@dataclass(frozen=True)
class Block:
    """A block and the film on it: lengths in metres, ``depth`` from the surface to the plane of symmetry."""

    length: float
    depth: float
    film_end: float


class BlockWrinkles(NamedTuple):
    """Wrinkles on a block, and the compressive strain of the surface below them, shape [n_times, n_points]."""

    wrinkles: CompetingWrinkles
    strain: Array


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
            [n_points, n_wavelengths].
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
    surface = block_surface(length=block.length, depth=block.depth, nu=substrate.nu_inf, n_cells=CELLS)
    centres = surface.centres
    at_cells = at_times(centres, X, strain.T).T
    seed = np.asarray(imperfection, dtype=float)
    if seed.ndim == 2:
        seed = at_times(centres, X, seed)
    instants, bilayer, lengths = prepared(
        time, at_cells, film, substrate, wavelengths, seed, reserve=STRAIN_RESERVE
    )
    bearing = Bearing(
        surface=surface,
        modulus=plane_strain_relaxation(substrate),
        stiffening=_stiffening(substrate),
        force_unit=substrate.mu_inf * film.thickness,
        film=(centres < block.film_end).astype(float),
        step=bilayer.step,
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


@dataclass(frozen=True)
class Bearing:
    """What the film pushes against.

    Args:
        surface: stiffness of the block's surface, per plane-strain modulus.
        modulus: the relaxing plane-strain modulus.
        stiffening: factor on the stiffness at the strains ``STIFFENING_STRAINS``.
        force_unit: force per width [N/m] of a nominal stress of 1 in the film.
        film: 1 on the cells that carry the film, else 0, shape [n_cells].
        step: length of the time steps [s].
    """

    surface: BlockSurface
    modulus: RelaxingModulus
    stiffening: Array
    force_unit: float
    film: Array
    step: float

    @property
    def keep(self) -> Array:
        """What a term keeps of its stress over a step, shape [n_terms]."""
        return np.exp(-self.step / self.modulus.times)

    @property
    def add(self) -> Array:
        """Modulus with which a term takes up new strain in a step [Pa], shape [n_terms]."""
        ratio = self.step / self.modulus.times
        return -self.modulus.shares * np.expm1(-ratio) / ratio


@dataclass(frozen=True)
class SurfaceState:
    """Motion of the surface along itself, by the film.

    Args:
        w: displacement of the moving nodes [m], shape [n_moving].
        moved: in the last step [m].
        relaxing: E' * w of the terms [Pa m], shape [n_terms, n_moving].
    """

    w: Array
    moved: Array
    relaxing: Array


def _stiffening(substrate: Viscoelastic) -> Array:
    """How much stiffer a half-space is along its surface at ``STIFFENING_STRAINS`` than unstrained."""

    def along(strain: float) -> float:
        layer = prestressed_layer(substrate, 1.0 - strain, unit=substrate.mu_inf)
        Z = half_space_stiffness(stroh_matrix(layer, 1.0))
        return float(Z[0, 0] - Z[0, 1] * Z[1, 0] / Z[1, 1])

    return np.array([along(strain) for strain in STIFFENING_STRAINS]) / along(1e-9)


def _march(strain: Array, gaps: Array, bilayer: Bilayer, bearing: Bearing) -> tuple[Array, Array]:
    """Follow wrinkles and surface through film-free strains [n_steps, n_cells]: k A, and strains with the film."""
    still = np.zeros(bearing.surface.end.size)
    surface = SurfaceState(still, still, np.zeros((bearing.modulus.times.size, still.size)))
    wrinkles = at_rest(bilayer)
    grown, strains = np.empty((strain.shape[0], *bilayer.imperfection.shape)), np.empty_like(strain)
    grown[0], strains[0] = wrinkles.top, strain[0]
    for n in range(1, strain.shape[0]):
        wrinkles, surface = block_step(wrinkles, surface, strain[n], gaps[n], bilayer, bearing)
        grown[n], strains[n] = wrinkles.top, wrinkles.strain
    return grown, strains


def block_step(
    wrinkles: WrinkleState,
    surface: SurfaceState,
    strain: Array,
    gap: float,
    bilayer: Bilayer,
    bearing: Bearing,
) -> tuple[WrinkleState, SurfaceState]:
    """Bring the block to the film-free ``strain`` [n_cells] within one step.

    Raises:
        RunError: if film and surface cannot be found in equilibrium.
    """
    expected = strain + bearing.surface.shortening @ (surface.w + surface.moved)
    begun = begin_step(wrinkles, expected, bilayer)
    trial = replace(surface, w=surface.w + surface.moved)

    def balanced(held: bool) -> tuple[Array, Meeting]:
        w = trial.w.copy()
        if held:
            w[bearing.surface.end] = -gap
        reached = strain + bearing.surface.shortening @ w
        guess, slope = expected_film_strain(wrinkles, reached), wrinkles.slope
        for _ in range(MOST_ITERATIONS):
            met = meet_film(begun, reached, guess, slope, bilayer)
            change = _correction(w, met, surface, held, bilayer, bearing)
            strained = bearing.surface.shortening @ change
            w, reached = w + change, reached + strained
            guess, slope = met.film_strain + strained / met.slope, met.slope
            if np.abs(strained).max() < TOLERANCE:
                return w, met
        raise RunError("film and surface do not come into equilibrium along the block")

    touching = gap <= 0.0
    w, met = balanced(held=touching)
    if not touching and w[0] < -gap:  # the film would push the corner through the plate
        w, met = balanced(held=True)
    moved = w - surface.w
    relaxing = bearing.keep[:, np.newaxis] * surface.relaxing + bearing.add[:, np.newaxis] * moved
    return end_step(begun, met, bilayer), SurfaceState(w, moved, relaxing)


def _correction(
    w: Array, met: Meeting, surface: SurfaceState, held: bool, bilayer: Bilayer, bearing: Bearing
) -> Array:
    """Newton's step of the moving nodes towards equilibrium of film and surface [m]."""
    stiffening = np.interp(met.strain.mean(), STIFFENING_STRAINS, bearing.stiffening)
    K, B = stiffening * bearing.surface.stiffness, bearing.surface.shortening
    acting = bearing.modulus.long_term + float(bearing.add.sum())
    remembered = bearing.keep @ surface.relaxing - bearing.add.sum() * surface.w
    force, rise = compressive_force(met, bilayer)
    unit = bearing.force_unit * bearing.surface.cell * bearing.film
    residual = K @ (acting * w + remembered) + (unit * force) @ B
    stiffness = acting * K + B.T @ ((unit * rise)[:, np.newaxis] * B)
    change = np.zeros_like(w)
    free = ~bearing.surface.end if held else np.ones(w.size, dtype=bool)
    change[free] = -np.linalg.solve(stiffness[np.ix_(free, free)], residual[free])
    return change
