"""The wrinkling models of a case behind one interface: from moving surface nodes to the surface that is seen.

"none" adds nothing; "quasi-static" is Eq. 1 on the depth-averaged strain; "rate-dependent" takes the strain of the
surface, which is what strains the film, less what the film holds back; "resolved" has its wrinkles in the motion of
the nodes already.
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from wrinklewave.dynamics.boundary import position
from wrinklewave.dynamics.drives import striker
from wrinklewave.errors import RunError
from wrinklewave.experiments.resolved_surface import resolved_wrinkles, smooth_displacement
from wrinklewave.experiments.wrinkle_seeds import model_wavelength, wrinkle_seeds
from wrinklewave.laboratory_frame import Array
from wrinklewave.materials.moduli import substrate_moduli
from wrinklewave.theory.film import critical_values, film_material
from wrinklewave.wrinkling import quasi_static
from wrinklewave.wrinkling.profile import smooth_surface, wrinkled_surface
from wrinklewave.wrinkling.seeds import ComplexArray

if TYPE_CHECKING:
    from wrinklewave.config import Case


class SurfaceNodes(NamedTuple):
    """Surface nodes of a simulation; shapes [n_times], [n_points] and [n_times, n_points].

    Args:
        time: [s].
        X: undeformed positions along the film [m], increasing.
        x, y: positions [m].
        strain: of the substrate below, averaged over its depth, compression > 0.
    """

    time: Array
    X: Array
    x: Array
    y: Array
    strain: Array


class Seen(NamedTuple):
    """Heights on the laboratory grid [m], shape [n_times, n_x], and amplitudes of the nodes [m].

    ``smooth`` and ``amplitude`` are None if there are no wrinkles.
    """

    height: Array
    smooth: Array | None
    amplitude: Array | None


def seen_surface(case: Case, nodes: SurfaceNodes, x: Array, x_boundary: Array) -> Seen:
    """What a camera sees of the surface, under the case's wrinkling model.

    Args:
        case: that was simulated.
        nodes: motion of its surface.
        x: laboratory grid [m], shape [n_x].
        x_boundary: struck end [m], shape [n_times].
    """
    seen = {"x": x, "x_boundary": x_boundary}
    model = case.wrinkles.model
    if model == "none":
        return Seen(smooth_surface(nodes.X, nodes.x, nodes.y, **seen), None, None)
    if model == "resolved":
        cutoff = case.analysis.filter_wavelength
        wrinkles = resolved_wrinkles(nodes.X, nodes.x, nodes.y, filter_wavelength=cutoff)
        height = smooth_surface(nodes.X, nodes.x, nodes.y, **seen)
        return Seen(height, smooth_surface(nodes.X, wrinkles.x, wrinkles.y, **seen), wrinkles.amplitude)
    amplitude = _quasi_static(case, nodes) if model == "quasi-static" else _rate_dependent(case, nodes)
    wavelength = model_wavelength(case)
    heights = wrinkled_surface(nodes.X, nodes.x, nodes.y, amplitude, wavelength=wavelength, **seen)
    return Seen(heights.wrinkled, heights.smooth, np.abs(amplitude))


def surface_strain(X: Array, x: Array, y: Array, *, filter_wavelength: float) -> Array:
    """Nominal compressive strain along the surface, smoothed as the film's wrinkles smooth it.

    Args:
        X: undeformed positions of the surface nodes [m], shape [n_points].
        x, y: their positions [m], shape [n_times, n_points].
        filter_wavelength: of the low-pass filter [m].
    """
    u, w = (smooth_displacement(X, p, filter_wavelength=filter_wavelength) for p in (x - X, y))
    return 1.0 - np.hypot(1.0 + np.gradient(u, X, axis=1), np.gradient(w, X, axis=1))


def _quasi_static(case: Case, nodes: SurfaceNodes) -> Array:
    assert case.film is not None
    strain, wavelength = critical_values(case.film, case.substrate)
    return quasi_static.wrinkle_amplitude(
        nodes.strain, critical_strain=strain, critical_wavelength=wavelength
    )


def _rate_dependent(case: Case, nodes: SurfaceNodes) -> ComplexArray:
    """Complex amplitude of every node; nodes strained beyond the model's range take that of the nearest one within."""
    from wrinklewave.wrinkling.rate_dependent import LARGEST_STRAIN

    cutoff = case.analysis.filter_wavelength
    strain = surface_strain(nodes.X, nodes.x, nodes.y, filter_wavelength=cutoff)
    within = (np.abs(strain) <= LARGEST_STRAIN).all(axis=0)
    if not within.any():
        raise RunError("the surface is strained beyond the range of the rate-dependent model everywhere")
    if not within.all():
        warnings.warn(
            f"{np.count_nonzero(~within)} of {within.size} surface nodes are strained by more than {LARGEST_STRAIN}, "
            "beyond the rate-dependent model; they take the amplitude of the nearest node within its range",
            stacklevel=2,
        )
    amplitude = _amplitude_of_strain(case, nodes.time, nodes.X[within], strain[:, within], _gap(case, nodes))
    nearest = np.abs(nodes.X[:, None] - nodes.X[within]).argmin(axis=1)
    return amplitude[:, nearest]


def _amplitude_of_strain(case: Case, time: Array, X: Array, strain: Array, gap: Array) -> ComplexArray:
    from wrinklewave.wrinkling.rate_dependent import FilmLayer, at_times
    from wrinklewave.wrinkling.rate_dependent_block import Block, cell_centres, wrinkles_on_block

    film, length = case.film, case.block.length
    assert film is not None  # checked with the case
    block = Block(length=length, depth=case.block.height / 2, film_end=length - film.end_gap)
    cells = cell_centres(block)
    seeds = wrinkle_seeds(case, cells)
    wrinkles = wrinkles_on_block(
        time,
        cells,
        at_times(cells, X, strain.T).T,
        block=block,
        film=FilmLayer(film.thickness, film_material(film, case.substrate)),
        substrate=substrate_moduli(case.substrate),
        wavelengths=seeds.wavelengths,
        imperfection=seeds.audible,
        gap=gap,
    ).wrinkles
    growth = np.moveaxis(wrinkles.amplitudes / np.abs(seeds.audible), 1, 0)
    growth = np.moveaxis(at_times(X, cells, growth), 0, 1)
    return wrinkle_seeds(case, X).grown(growth, X, model_wavelength(case))


def _gap(case: Case, nodes: SurfaceNodes) -> Array:
    """Distance of the struck end from the plate [m], shape [n_times]; no other drive lets the end fly free."""
    if case.drive.kind != "striker":
        return np.zeros_like(nodes.time)
    plate = np.array([position(striker(case.drive), t) for t in nodes.time])
    return np.maximum(nodes.x[:, 0] - plate, 0.0)
