"""Wrinkles that take their time: amplitude of a film's wrinkles as the substrate below it is strained.

At every material point of the surface a wrinkle of given wavelength follows the local strain history. It is the
exact incremental motion of a film on a half-space with memory and inertia (two functions of the depth in place of
all), up to a finite amplitude at which the film's shortening by the wrinkle relieves its strain. Its slow limit is
Eq. 1 of "Wrinkles Riding Waves ...", its linear limit the growth rates of :mod:`wrinklewave.theory.growth`; both,
and the derivation, are in ``docs/theory_wrinkling.md``.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wrinklewave.errors import InputError
from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.growth import growth_rate
from wrinklewave.wrinkling.rate_dependent_film import Array, film_table
from wrinklewave.wrinkling.rate_dependent_flat import stepped_moduli
from wrinklewave.wrinkling.rate_dependent_march import Bilayer, at_rest, shortening_of_waves, wrinkle_step

LARGEST_STRAIN = 0.6
UNLOADING_RESERVE = 0.2
"""Film strains below the smallest axial strain that the film's table covers: wrinkles that unload stretch the film."""
LARGEST_INITIAL_SLOPE = 0.5
STEPS_PER_TIME_SCALE = 3
"""The amplitudes then err by less than 0.1 % (the scheme is of second order)."""
LEAST_STEPS, MOST_STEPS = 150, 400


@dataclass(frozen=True)
class FilmLayer:
    """A film of ``thickness`` [m] bonded to the substrate."""

    thickness: float
    moduli: Viscoelastic


class CompetingWrinkles(NamedTuple):
    """Wrinkles of several wavelengths on the same film.

    Args:
        wavelengths: undeformed [m], shape [n_wavelengths].
        amplitudes: of each [m], shape [n_times, n_points, n_wavelengths].
    """

    wavelengths: Array
    amplitudes: Array

    @property
    def amplitude(self) -> Array:
        """Amplitude of the sine with the mean square of all together [m], shape [n_times, n_points]."""
        return np.sqrt((self.amplitudes**2).sum(axis=-1))

    @property
    def wavelength(self) -> Array:
        """Wavelength of the largest [m], undeformed, shape [n_times, n_points]."""
        return self.wavelengths[np.abs(self.amplitudes).argmax(axis=-1)]


def wrinkle_amplitude(
    time: ArrayLike,
    strain: ArrayLike,
    *,
    film: FilmLayer,
    substrate: Viscoelastic,
    wavelength: float,
    imperfection: ArrayLike,
) -> Array:
    """Amplitude of the film's top [m], shape [n_times, n_points], of wrinkles that keep their wavelength.

    Args:
        time: increasing [s], shape [n_times]; before the first the sample is at rest and unstrained.
        strain: nominal compressive strain of the material points, shape [n_times, n_points]; linear in between.
        film: on the surface.
        substrate: relaxing moduli.
        wavelength: of wrinkles and imperfection, undeformed [m].
        imperfection: amplitude A_i of the stress-free film [m], for all points or shape [n_points].

    Raises:
        InputError: if times or strains make no sense.
        RunError: if the wrinkles cannot be followed.
    """
    wrinkles = competing_wrinkles(
        time, strain, film=film, substrate=substrate, wavelengths=[wavelength], imperfection=imperfection
    )
    return wrinkles.amplitudes[..., 0]


def competing_wrinkles(
    time: ArrayLike,
    strain: ArrayLike,
    *,
    film: FilmLayer,
    substrate: Viscoelastic,
    wavelengths: ArrayLike,
    imperfection: ArrayLike,
) -> CompetingWrinkles:
    """Follow wrinkles of several wavelengths at once: all shorten the same film, and the fastest prevails.

    Arguments as in :func:`wrinkle_amplitude`, with ``wavelengths`` of shape [n_wavelengths] and ``imperfection``
    one amplitude for all, or of shape [n_wavelengths] or [n_points, n_wavelengths]; complex where the phases of the
    waves are known: the film is then shortened by their sum, else by each.
    """
    time, strain = checked_history(time, strain)
    instants, bilayer, wavelengths = prepared(time, strain, film, substrate, wavelengths, imperfection)
    grown = at_times(time, instants, _march(at_times(instants, time, strain), bilayer))
    return CompetingWrinkles(wavelengths, np.moveaxis(grown, 1, 2) * wavelengths / (2 * np.pi))


def prepared(
    time: Array,
    strain: Array,
    film: FilmLayer,
    substrate: Viscoelastic,
    wavelengths: ArrayLike,
    imperfection: ArrayLike,
    *,
    reserve: float = 0.0,
) -> tuple[Array, Bilayer, Array]:
    """Instants of the steps [n_steps + 1], what stays the same in them, and the wavelengths [m].

    Arguments as in :func:`competing_wrinkles`; the film's table reaches ``reserve`` beyond the largest strain.
    """
    lengths = _checked_wavelengths(wavelengths)
    wavenumbers = 2 * np.pi / lengths
    slopes, phases = _initial_slopes(imperfection, wavenumbers, strain.shape[1])
    longer = shortening_of_waves(
        slopes.T, phases
    )  # strain by which the film is longer than flat to begin with
    highest = max(float(strain.max()), 0.0) + float(longer.max()) + reserve
    table = film_table(
        film.moduli,
        thickness=film.thickness,
        wavenumbers=wavenumbers,
        strain_range=(min(float(strain.min()), 0.0) - UNLOADING_RESERVE, highest),
        unit=substrate.mu_inf,
    )
    n_steps = _number_of_steps(time, strain, film, substrate, wavenumbers)
    instants = np.linspace(time[0], time[-1], n_steps + 1)
    step = float(instants[1] - instants[0])
    bilayer = Bilayer(
        substrate=stepped_moduli(substrate, step=step, unit=substrate.mu_inf),
        film=stepped_moduli(film.moduli, step=step, unit=substrate.mu_inf),
        table=table,
        density=substrate.density / (substrate.mu_inf * wavenumbers**2),
        imperfection=slopes.T,
        phases=phases,
        shortened=longer,
        step=step,
    )
    return instants, bilayer, lengths


def _march(strain: Array, bilayer: Bilayer) -> Array:
    """Follow the wrinkles through strains [n_steps, P], and return k A, shape [n_steps, M, P]."""
    grown = np.empty((strain.shape[0], *bilayer.imperfection.shape))
    state = at_rest(bilayer)
    grown[0] = state.top
    for n in range(1, strain.shape[0]):
        state = wrinkle_step(state, strain[n], bilayer)
        grown[n] = state.top
    return grown


def at_times(instants: ArrayLike, times: ArrayLike, values: ArrayLike) -> Array:
    """Values [n_times, ...] interpolated linearly at other instants."""
    from scipy.interpolate import make_interp_spline

    times = np.asarray(times)
    return make_interp_spline(times, values, k=1, axis=0)(np.clip(instants, times[0], times[-1]))


def _number_of_steps(
    time: Array, strain: Array, film: FilmLayer, substrate: Viscoelastic, wavenumbers: Array
) -> int:
    """Enough for the shortest relaxation time and the fastest growth, within limits.

    Histories that are long beside both are slow for the material: the scheme is stable and follows their equilibrium.
    """
    rates = [
        growth_rate(film.moduli, substrate, float(strain.max()), k, thickness=film.thickness)
        for k in wavenumbers
    ]
    fastest = max([*rates, *(1.0 / substrate.tau_k), *(1.0 / film.moduli.tau_k)])
    wanted = STEPS_PER_TIME_SCALE * fastest * (time[-1] - time[0])
    return int(np.clip(np.ceil(wanted), LEAST_STEPS, MOST_STEPS))


def checked_history(time: ArrayLike, strain: ArrayLike) -> tuple[Array, Array]:
    """Times and strains as arrays.

    Raises:
        InputError: if they make no sense.
    """
    time, strain = np.asarray(time, dtype=float), np.asarray(strain, dtype=float)
    if time.ndim != 1 or strain.ndim != 2 or strain.shape[0] != time.size:
        raise InputError(
            f"time has shape {time.shape} and strain {strain.shape}",
            expected="[n_times] and [n_times, n_points]",
        )
    if time.size < 2 or not (np.diff(time) > 0).all():
        raise InputError("times do not increase", key="time", expected="at least two increasing values")
    if not (np.abs(strain) <= LARGEST_STRAIN).all():
        raise InputError(
            "strains are not a number or too large",
            key="strain",
            expected=f"between -{LARGEST_STRAIN} and {LARGEST_STRAIN} at every time and point",
            cure="leave out the points where the strain is not known",
        )
    return time, strain


def _checked_wavelengths(wavelengths: ArrayLike) -> Array:
    lengths = np.atleast_1d(np.asarray(wavelengths, dtype=float))
    if lengths.ndim != 1 or not (lengths > 0).all():
        raise InputError(
            f"wavelengths are {wavelengths!r}", key="wavelengths", expected="positive numbers of metres"
        )
    return lengths


def _initial_slopes(
    imperfection: ArrayLike, wavenumbers: Array, n_points: int
) -> tuple[Array, NDArray[np.complex128] | None]:
    """k A_i of every point and wavenumber, shape [n_points, n_wavelengths], and exp(i phase), transposed."""
    amplitude = np.asarray(imperfection)
    if amplitude.ndim == 1 and amplitude.size == n_points and wavenumbers.size == 1:
        amplitude = amplitude[:, np.newaxis]
    try:
        slopes = np.broadcast_to(amplitude, (n_points, wavenumbers.size)) * wavenumbers
    except ValueError:
        raise InputError(
            f"imperfection has shape {amplitude.shape}",
            key="imperfection",
            expected=f"one amplitude, or shape [{n_points}, {wavenumbers.size}] (points, wavelengths)",
        ) from None
    if not (np.abs(slopes) < LARGEST_INITIAL_SLOPE).all():
        raise InputError(
            f"an imperfection is as steep as {np.abs(slopes).max():.3g}",
            key="imperfection",
            expected=f"2 pi amplitude / wavelength below {LARGEST_INITIAL_SLOPE}",
        )
    if not np.iscomplexobj(slopes):
        return slopes, None
    return np.abs(slopes), np.exp(1j * np.angle(slopes)).T
