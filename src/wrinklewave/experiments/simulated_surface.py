"""From recorded surface nodes to a surface motion, with the wrinkles that the chosen model puts on it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave._version import __version__
from wrinklewave.dynamics.checkpoint import Record
from wrinklewave.experiments.recording import SURFACE
from wrinklewave.experiments.wrinkle_models import SurfaceNodes, seen_surface
from wrinklewave.laboratory_frame import Array
from wrinklewave.materials.moduli import plane_strain_modulus, substrate_moduli, youngs_modulus
from wrinklewave.surface import surface_motion

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.config import Case


def laboratory_grid(case: Case) -> Array:
    """Places at which the surface is seen [m], from 0 to the held end, as near to ``output.pixel_size`` as fits."""
    n = round(case.block.length / case.output.pixel_size)
    return np.linspace(0.0, case.block.length, n + 1)


def simulated_surface(case: Case, X: Array, record: Record) -> xr.Dataset:
    """The surface motion of a simulation.

    Args:
        case: that was simulated.
        X: undeformed positions of the surface nodes [m], shape [n_points].
        record: what the surface recorder gathered.
    """
    recorded = dict(record.arrays)
    time = recorded.pop("time")
    x_p, y_p = recorded["x_p"], recorded["y_p"]
    x = laboratory_grid(case)
    x_boundary = x_p[:, 0]
    rest = case.block.height / 2
    nodes = SurfaceNodes(time, X, x_p, y_p, recorded["strain_xx"])
    y, y_smooth, amplitude = seen_surface(case, nodes, x, x_boundary)
    extra: dict[str, Any] = {}
    if y_smooth is not None and amplitude is not None:
        extra = {"amplitude": amplitude, "y_smooth": y_smooth, "u_y_smooth": y_smooth - rest}
    return surface_motion(
        time=time,
        x=x,
        X=X,
        y=y,
        u_y=y - rest,
        x_boundary=x_boundary,
        attrs=_attributes(case),
        **recorded,
        **extra,
    )


def rewrinkled(surface: xr.Dataset, case: Case) -> xr.Dataset:
    """The surface motion of the same substrate under the wrinkling model, film and imperfection of another case.

    Args:
        surface: of a simulation without a resolved film.
        case: says which wrinkles; its block, substrate and drive must be those of the simulation.
    """
    record = Record({name: surface[name].values for name in SURFACE})
    return simulated_surface(case, surface["X"].values, record)


def _attributes(case: Case) -> dict[str, Any]:
    substrate = substrate_moduli(case.substrate)
    E_0 = youngs_modulus(substrate.mu_inf, substrate.nu_inf)
    attributes = {
        "kind": "simulation",
        "name": case.name,
        "length": case.block.length,
        "height": case.block.height,
        "wrinkle_model": case.wrinkles.model,
        "bulk_response": case.substrate.bulk_response,
        "plane_strain_modulus": plane_strain_modulus(E_0, substrate.nu_inf),
        "stop_distance": getattr(case.drive, "stop_distance", None),
        "critical_strain": case.film.critical_strain if case.film else None,
        "critical_wavelength": case.film.critical_wavelength if case.film else None,
        "wrinklewave_version": __version__,
        "case": case.to_toml(),
    }
    return {name: value for name, value in attributes.items() if value is not None}
