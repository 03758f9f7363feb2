"""Time series of chosen material points of the surface."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr

COLUMNS = {
    "x_m": "x_p",
    "y_m": "y_p",
    "strain_xx": "strain_xx",
    "strain_rate_xx_per_s": "strain_rate_xx",
    "nominal_stress_xx_Pa": "stress_xx",
}
"""Columns of ``probes.csv`` and the variables of the surface motion that they are taken from."""


def probe_columns(surface: xr.Dataset, probes: Sequence[float]) -> dict[str, Array]:
    """Position, and strain, strain rate and stress averaged over the depth, of surface points against time.

    Linear between the nodes. One row per probe and time, probe by probe.

    Args:
        surface: of a simulation.
        probes: undeformed positions [m].

    Returns:
        Columns ``X_m`` (undeformed), ``time_s`` and those of :data:`COLUMNS`, each of shape [n_probes * n_times].
    """
    time = surface["time"].values
    points = surface.swap_dims(point="X").interp(X=list(probes))
    columns = {
        "X_m": np.repeat(np.asarray(probes, dtype=float), time.size),
        "time_s": np.tile(time, len(probes)),
    }
    return columns | {
        name: points[variable].transpose("X", "time").values.ravel() for name, variable in COLUMNS.items()
    }
