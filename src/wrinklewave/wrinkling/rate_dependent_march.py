"""The rate-dependent model's step: film and substrate meet, and all wrinkles together shorten the film.

At every step the substrate is reduced to a stiffness and a force on the interface, of each wavenumber; the film
answers with its response at the strain of its middle surface; and that strain is the axial strain less what all
wrinkles take up: one scalar equation for every material point. Symbols as in ``docs/theory_wrinkling.md``; lengths in
1/k, stresses in the substrate's long-term shear modulus, times in seconds.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wrinklewave.errors import RunError
from wrinklewave.wrinkling.rate_dependent_film import FilmResponse, FilmTable
from wrinklewave.wrinkling.rate_dependent_flat import FlatState, SteppedModuli, flat_at_rest, flat_step
from wrinklewave.wrinkling.rate_dependent_substrate import (
    Interface,
    WaveState,
    interface,
    wave_step,
    waves_at_rest,
)

Array = NDArray[np.float64]

TOLERANCE = 1e-7
"""Of the film's strain."""
MOST_ITERATIONS = 100


@dataclass(frozen=True)
class Bilayer:
    """What does not change with time, shapes for M wavenumbers and P points.

    Args:
        substrate, film: moduli over steps of length ``step`` [s].
        table: the film's response.
        density: rho/(mu k^2) of the substrate [s^2], shape [M].
        imperfection: k A_i, shape [M, P].
        phases: exp(i phase) of each wave, of which the sum shortens the film, shape [M, P]; None for waves of unknown
            phase, which shorten it each by itself.
        shortened: strain by which the imperfection shortens the film, shape [P].
    """

    substrate: SteppedModuli
    film: SteppedModuli
    table: FilmTable
    density: Array
    imperfection: Array
    phases: NDArray[np.complex128] | None
    shortened: Array
    step: float


@dataclass(frozen=True)
class WrinkleState:
    """Film and substrate at some points.

    Args:
        strain: axial, shape [P].
        film_strain: of the film's middle surface, shape [P].
        taken_up: in the last step, of the axial strain by the wrinkles, shape [P].
        slope: of the equation for it where it was last solved, shape [P].
        flat, flat_film: flat state of substrate and film; that of an elastic film rests.
        waves: on the substrate.
        film_force: the film's force on its underside per Prony term before it relaxes, and what is left of it after,
            shape [n_terms, 2, M, P] each.
        top: k times the amplitude of the film's top, shape [M, P].
    """

    strain: Array
    film_strain: Array
    taken_up: Array
    slope: Array
    flat: FlatState
    flat_film: FlatState
    waves: WaveState
    film_force: tuple[Array, Array]
    top: Array


@dataclass(frozen=True)
class BegunStep:
    """A step in which the substrate has been compressed to the axial ``strain`` [P], and nothing else is known yet."""

    before: WrinkleState
    strain: Array
    flat: FlatState
    below: Interface


@dataclass(frozen=True)
class Meeting:
    """Film and substrate at one trial strain of the film's middle surface.

    ``excess`` [P] is how far that strain lies above the axial ``strain`` less what the wrinkles take up, ``slope`` its
    rise with the film's strain; ``V0_film`` is V0 counted from where the flat film puts the initial wrinkle.
    """

    strain: Array
    film_strain: Array
    excess: Array
    slope: Array
    film: FilmResponse
    flat_film: FlatState
    U0: Array
    V0: Array
    V0_film: Array


def at_rest(bilayer: Bilayer) -> WrinkleState:
    """Return the undeformed sample with its imperfection."""
    M, P = bilayer.imperfection.shape
    force = np.zeros((bilayer.film.keep.size, 2, M, P))
    return WrinkleState(
        strain=np.zeros(P),
        film_strain=np.zeros(P),
        taken_up=np.zeros(P),
        slope=np.ones(P),
        flat=flat_at_rest(bilayer.substrate, P),
        flat_film=flat_at_rest(bilayer.film, P),
        waves=waves_at_rest(bilayer.substrate, M, P),
        film_force=(force, force),
        top=bilayer.imperfection,
    )


def wrinkle_step(before: WrinkleState, strain: Array, bilayer: Bilayer) -> WrinkleState:
    """Bring the points to the axial ``strain`` [P] within one step.

    Raises:
        RunError: if the film's strain leaves the table or cannot be found.
    """
    begun = begin_step(before, strain, bilayer)
    met = meet_film(begun, strain, expected_film_strain(before, strain), before.slope, bilayer)
    return end_step(begun, met, bilayer)


def expected_film_strain(before: WrinkleState, strain: Array) -> Array:
    """Strain of the film at the axial ``strain`` [P] if the wrinkles take up what they did in the last step."""
    return before.film_strain + strain - before.strain - before.taken_up


def begin_step(before: WrinkleState, strain: Array, bilayer: Bilayer) -> BegunStep:
    """Compress the substrate to the axial ``strain`` [P], and find what resists the motion of its surface."""
    stretch = 1.0 - strain
    flat = flat_step(before.flat, stretch, bilayer.substrate)
    below = interface(
        before.waves, stretch, flat, bilayer.substrate, bilayer.density, bilayer.table.mass, bilayer.step
    )
    return BegunStep(before, strain, flat, below)


def meet_film(begun: BegunStep, strain: Array, guess: Array, slope: Array, bilayer: Bilayer) -> Meeting:
    """Let film and substrate meet where the wrinkles leave nothing of the axial ``strain`` [P] over.

    The film's strain of no excess is the only root of a function that rises with a slope of 1 or more. Secant steps
    within a bracket, which is halved where they leave it; unstable trials have an excess that says: less.

    Args:
        begun: step.
        strain: at its end; it may differ a little from that for which the step was begun.
        guess, slope: of the film's strain, and of the rise of the excess, to start from, shape [P].
        bilayer: of the step.

    Raises:
        RunError: if the film's strain leaves the table or cannot be found.
    """
    low = np.full_like(strain, bilayer.table.first_strain)
    high = strain + bilayer.shortened
    x, last = np.minimum(guess, high), None
    for _ in range(MOST_ITERATIONS):
        met = _meet(x, begun, strain, slope, bilayer)
        value = met.excess
        if last is not None:
            moved = x != last.film_strain
            rise = np.divide(value - last.excess, x - last.film_strain, out=slope.copy(), where=moved)
            slope = np.maximum(rise, 0.5)
        done = (np.abs(value) < TOLERANCE) | (high - low < TOLERANCE)
        if done.all():
            _check_reach(x, strain, bilayer.table)
            return replace(met, slope=slope)
        low, high = np.where(value > 0.0, low, x), np.where(value > 0.0, x, high)
        following = x - value / slope
        following = np.where((low < following) & (following < high), following, 0.5 * (low + high))
        x, last = np.where(done, x, following), met
    worst = int(np.argmax(np.abs(value)))
    raise RunError(
        f"the film's strain does not converge at point {worst}, where the strain is {strain[worst]:.4g}"
    )


def end_step(begun: BegunStep, met: Meeting, bilayer: Bilayer) -> WrinkleState:
    """Take the step to where film and substrate have met."""
    before = begun.before
    film_force = before.film_force
    if bilayer.film.relaxes:
        film_force = _film_force(met, before.film_force, bilayer.film)
    top_u, top_v, top_initial = met.film.top
    return WrinkleState(
        strain=met.strain,
        film_strain=met.film_strain,
        taken_up=before.film_strain + met.strain - before.strain - met.film_strain,
        slope=met.slope,
        flat=begun.flat,
        flat_film=met.flat_film,
        waves=wave_step(
            before.waves,
            begun.below,
            met.U0,
            met.V0,
            1.0 - begun.strain,
            begun.flat,
            bilayer.substrate,
            bilayer.step,
        ),
        film_force=film_force,
        top=top_u * met.U0
        + top_v * met.V0_film
        + (top_initial + met.film.transverse_stretch) * bilayer.imperfection,
    )


def compressive_force(met: Meeting, bilayer: Bilayer) -> tuple[Array, Array]:
    """Nominal force along the film per its thickness, compression > 0, and its rise with the axial strain, shape [P].

    Both in the unit of the moduli; the rise is that of a film whose wrinkles take up their share of the strain.
    """
    force, rise = -met.film.axial_force, -met.film.axial_force_rise
    if bilayer.film.relaxes:
        force = -(1.0 - met.film_strain) * met.flat_film.axial_stress
        rise = rise * (bilayer.film.mu_acting / bilayer.film.mu)
    return force, rise / np.maximum(met.slope, 1.0)


def shortening(slope: Array) -> Array:
    """Share of its length that an inextensible film loses to a wrinkle of ``slope`` = k A: 1 - 2 E(slope^2)/pi.

    E is the complete elliptic integral of that parameter and X the arc length; Eq. 1 of the paper is the inverse of
    its series. Steeper than 1, where the film stands upright, it is taken as 1.
    """
    from scipy.special import ellipe

    return 1.0 - 2.0 / np.pi * ellipe(np.minimum(slope**2, 1.0))


def shortening_of_waves(slopes: Array, phases: NDArray[np.complex128] | None) -> Array:
    """Share of its length that a film loses to all waves on it, slopes and phases of shape [M, P]."""
    if phases is None:
        return shortening(slopes).sum(axis=0)
    return shortening(np.abs((slopes * phases).sum(axis=0)))


def _meet(film_strain: Array, begun: BegunStep, strain: Array, slope: Array, bilayer: Bilayer) -> Meeting:
    """Equilibrium of the interface under a film of the given strain [P]."""
    before, flat, below = begun.before, begun.flat, begun.below
    film, initial = bilayer.table.at(film_strain), bilayer.imperfection
    f_00, f_01, f_11 = film.F
    force = below.force + film.f * initial
    force[0] += (1.0 - strain) * flat.axial_stress * initial
    flat_film = before.flat_film
    if bilayer.film.relaxes:
        flat_film = flat_step(before.flat_film, 1.0 - film_strain, bilayer.film)
        (f_00, f_01, f_11), added = _film_memory(film_strain, film, flat_film, before, bilayer)
        force += added
    jump = (flat.transverse_stretch - film.transverse_stretch) * initial
    force += np.array([f_01, f_11]) * jump
    k_00, k_01, k_11 = f_00 + below.k_00, f_01 + below.k_01, f_11 + below.k_11
    determinant = k_00 * k_11 - k_01**2
    unstable = (k_00 <= 0.0) | (determinant <= 0.0)
    determinant = np.where(unstable, 1.0, determinant)
    U0 = (k_01 * force[1] - k_11 * force[0]) / determinant
    V0 = (k_01 * force[0] - k_00 * force[1]) / determinant
    shortened = shortening_of_waves(V0 + flat.transverse_stretch * initial, bilayer.phases)
    shortened = np.where(unstable.any(axis=0), 1.0, shortened)
    excess = film_strain - strain + shortened - bilayer.shortened
    return Meeting(strain, film_strain, excess, slope, film, flat_film, U0, V0, V0 + jump)


def _film_memory(
    film_strain: Array, film: FilmResponse, flat_film: FlatState, before: WrinkleState, bilayer: Bilayer
) -> tuple[Array, Array]:
    """F of a film that relaxes, as it acts over the step, and the force that earlier steps left on its underside."""
    moduli = bilayer.film
    excess = flat_film.axial_stress - film.axial_force / (1.0 - film_strain)
    strained, left = before.film_force
    F = film.F + excess * film.F_of_stress + np.tensordot(moduli.add, film.F_of_terms, axes=1)
    force = excess * film.f_of_stress * bilayer.imperfection
    force += np.tensordot(moduli.keep, left, axes=1) - np.tensordot(moduli.add, strained, axes=1)
    return F, force


def _film_force(met: Meeting, before: tuple[Array, Array], moduli: SteppedModuli) -> tuple[Array, Array]:
    """Let the film's forces relax over a step and take up those of its new motion."""
    f_00, f_01, f_11 = np.moveaxis(met.film.F_of_terms, 1, 0)
    strained = np.stack([f_00 * met.U0 + f_01 * met.V0_film, f_01 * met.U0 + f_11 * met.V0_film], axis=1)
    keep, add = (weights[:, np.newaxis, np.newaxis, np.newaxis] for weights in (moduli.keep, moduli.add))
    return strained, keep * before[1] + add * (strained - before[0])


def _check_reach(film_strain: Array, strain: Array, table: FilmTable) -> None:
    if film_strain.min() < table.first_strain + TOLERANCE:
        worst = int(np.argmin(film_strain))
        raise RunError(
            f"wrinkles at point {worst} stretch the film by more than {-table.first_strain:.3g} "
            f"while the strain falls to {strain[worst]:.3g}: the strain falls faster than the model can follow"
        )
