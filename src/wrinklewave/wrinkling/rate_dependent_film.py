"""The film of the rate-dependent model: what it does to its underside, for every strain of its middle surface.

Taken from the exact incremental problem of a compressed layer (:mod:`wrinklewave.theory.incremental`), reduced to the
displacements (U, V) of the underside. With E the film's transfer matrix over its thickness and its top free of
traction, the film resists with F U + f A_i,

    F = E_22^-1 E_21,     f = P_11 (E_22^-1 - I) e_1,

where the second term is the axial force P_11 acting on the slope of an initial wrinkle A_i, and its top rises by
V_top = t U + t_i A_i. A film whose moduli relax has the rates of F with each Prony term and with P_11 beside it.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from wrinklewave.materials.moduli import Viscoelastic
from wrinklewave.theory.incremental import PrestressedLayer, film_transfer, prestressed_layer, stroh_matrix

Array = NDArray[np.float64]

STRAIN_SPACING = 0.008
"""Of the table; F is smooth in the strain, and linear interpolation errs by less than 5e-5 of it."""
DIFFERENCE = 1e-4
"""Relative step of central differences."""


@dataclass(frozen=True)
class FilmResponse:
    """What the film does at some points, shapes for M wavenumbers and P points; lengths in 1/k.

    Args:
        F: 00, 01, 11, shape [3, M, P].
        f: 0, 1, shape [2, M, P].
        transverse_stretch: of the flat film, shape [M, P].
        axial_force: of the relaxed flat film, P_11 = l1 S_11, and its rise with the strain, shape [P] each.
        top: how (U, V) of the underside and the initial wrinkle move the top, shape [3, M, P].
        F_of_stress, f_of_stress: dF/dS_11 and df/dS_11, shapes [3, M, P] and [2, M, P].
        F_of_terms: dF/d(Prony term), shape [n_terms, 3, M, P].
    """

    F: Array
    f: Array
    transverse_stretch: Array
    axial_force: Array
    axial_force_rise: Array
    top: Array
    F_of_stress: Array
    f_of_stress: Array
    F_of_terms: Array


@dataclass(frozen=True)
class FilmTable:
    """The film's response at strains ``first_strain`` + i ``STRAIN_SPACING``; lengths in 1/k, stresses in ``unit``.

    Args:
        first_strain: of the table.
        columns: in the order of ``FilmResponse``, shape [15 + 3 n_terms, M, n_strains]; the
            last of them, from dF/dS_11 on, only of films that relax.
        mass: dF/d(rho s^2), components 00, 01, 11, shape [3, M, 1].
    """

    first_strain: float
    columns: Array
    mass: Array

    @property
    def last_strain(self) -> float:
        return self.first_strain + STRAIN_SPACING * (self.columns.shape[-1] - 1)

    def at(self, strain: Array) -> FilmResponse:
        """Interpolate linearly at the middle surface's ``strain`` [P]."""
        place = (strain - self.first_strain) / STRAIN_SPACING
        row = np.clip(place.astype(np.intp), 0, self.columns.shape[-1] - 2)
        lower = self.columns.take(row, axis=-1)
        rise = self.columns.take(row + 1, axis=-1) - lower
        value = lower + (place - row) * rise
        terms = value[15:].reshape(-1, 3, *value.shape[1:])  # none, like the derivatives, of an elastic film
        return FilmResponse(
            F=value[:3],
            f=value[3:5],
            transverse_stretch=value[5],
            axial_force=value[6, 0],
            axial_force_rise=rise[6, 0] / STRAIN_SPACING,
            top=value[7:10],
            F_of_stress=value[10:13],
            f_of_stress=value[13:15],
            F_of_terms=terms,
        )


def film_table(
    film: Viscoelastic,
    *,
    thickness: float,
    wavenumbers: Array,
    strain_range: tuple[float, float],
    unit: float,
) -> FilmTable:
    """Tabulate the film's response.

    Args:
        film: its relaxing moduli.
        thickness: [m].
        wavenumbers: of the undeformed state [1/m], shape [n_wavenumbers].
        strain_range: strains of the middle surface to be covered.
        unit: stress unit, the substrate's long-term shear modulus [Pa].
    """
    count = int(np.ceil((strain_range[1] - strain_range[0]) / STRAIN_SPACING)) + 2
    strains = strain_range[0] + STRAIN_SPACING * np.arange(count)
    solid = replace(film, density=0.0)
    layers = [prestressed_layer(solid, 1.0 - strain, unit=unit) for strain in strains]
    columns = [
        [
            np.concatenate(
                [_response(layer, k, thickness), _relaxing_response(solid, layer, k, thickness, unit)]
            )
            for layer in layers
        ]
        for k in wavenumbers
    ]
    unstrained = prestressed_layer(solid, 1.0, unit=unit)
    mass = [_mass(unstrained, k, thickness, film.density / unit) for k in wavenumbers]
    return FilmTable(
        first_strain=float(strains[0]),
        columns=np.ascontiguousarray(np.transpose(columns, (2, 0, 1))),
        mass=np.transpose(mass)[..., np.newaxis],
    )


def _response(layer: PrestressedLayer, k: float, thickness: float) -> Array:
    """F, f, transverse stretch, axial force, t and t_i of one layer, shape [10]."""
    E = film_transfer(stroh_matrix(layer, k), k * thickness)
    compliance = np.linalg.inv(E[2:, 2:])
    F = compliance @ E[2:, :2]
    axial_force = layer.stretch * layer.axial_stress
    f = axial_force * (compliance[:, 0] - [1.0, 0.0])
    t = E[1, :2] - E[1, 2:] @ F
    t_i = -axial_force * (E[1, 2:] @ compliance[:, 0])
    return np.array([F[0, 0], F[0, 1], F[1, 1], *f, layer.transverse_stretch, axial_force, *t, t_i])


def _relaxing_response(
    solid: Viscoelastic, layer: PrestressedLayer, k: float, thickness: float, unit: float
) -> Array:
    """dF/dS_11, df/dS_11 and dF/d(term) for every term, shape [5 + 3 n_terms]."""
    if not solid.tau_k.size:
        return np.empty(0)
    d = DIFFERENCE * solid.mu_inf / unit
    by_stress = _slope(lambda step: _response(_with_stress(layer, step), k, thickness)[:5], d)
    by_term = [_slope_of_term(alone, layer, k, thickness, unit) for alone in _single_terms(solid)]
    return np.concatenate([by_stress, *by_term])


def _with_stress(layer: PrestressedLayer, step: float) -> PrestressedLayer:
    """Add to the axial stress S_11, but not to the moduli that relax."""
    return replace(
        layer,
        axial_stress=layer.axial_stress + step,
        A_1111=layer.A_1111 + step,
        A_2121=layer.A_2121 + step,
    )


def _single_terms(solid: Viscoelastic) -> Iterator[Viscoelastic]:
    """Yield the solid with one of its Prony terms at a time, of relaxation time 1."""
    for k in range(solid.tau_k.size):
        yield replace(solid, mu_k=solid.mu_k[[k]], K_k=solid.K_k[[k]], tau_k=np.ones(1))


def _slope_of_term(
    alone: Viscoelastic, layer: PrestressedLayer, k: float, thickness: float, unit: float
) -> Array:
    """dF/d(share), with which a solid's only term acts on increments: share = s tau/(1 + s tau)."""

    def F(share: float) -> Array:
        acting = prestressed_layer(alone, layer.stretch, rate=share / (1.0 - share), unit=unit)
        return _response(acting, k, thickness)[:3]

    return _slope(F, DIFFERENCE)


def _mass(layer: PrestressedLayer, k: float, thickness: float, density: float) -> Array:
    """Components 11, 12 and 22 of the film's mass, per s^2: it multiplies accelerations of (U, V)."""
    by_inertia = _slope(
        lambda step: _response(replace(layer, inertia=step * k**2), k, thickness)[:3], DIFFERENCE
    )
    return by_inertia * density / k**2


def _slope(function: Callable[[float], Array], step: float) -> Array:
    return (function(step) - function(-step)) / (2.0 * step)
