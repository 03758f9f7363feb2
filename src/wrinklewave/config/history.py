"""Measured input from CSV files: the motion of the struck end, the profile of a surface before the test."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from wrinklewave.config.columns import read_columns

if TYPE_CHECKING:
    from pathlib import Path

    import numpy as np
    from numpy.typing import NDArray


@dataclass(frozen=True, eq=False)
class BoundaryHistory:
    """Motion of the struck end.

    Args:
        time: [s], shape [n], increasing.
        u_x: displacement along x, towards the held end [m], shape [n].
        u_y: transverse displacement of the top corner [m], shape [n]; None where it was not measured.
    """

    time: NDArray[np.float64]
    u_x: NDArray[np.float64]
    u_y: NDArray[np.float64] | None


@dataclass(frozen=True, eq=False)
class SurfaceProfile:
    """Height of a surface before the test.

    Args:
        x: undeformed position [m], shape [n], increasing.
        height: height above the mean surface [m], shape [n].
    """

    x: NDArray[np.float64]
    height: NDArray[np.float64]


def read_history(path: str | Path) -> BoundaryHistory:
    """Read a boundary history with columns time_s, u_x_m and, if known, u_y_m.

    Raises:
        InputError: as :func:`wrinklewave.config.columns.read_columns`.
    """
    columns = read_columns(path, ("time_s", "u_x_m"), ("u_y_m",))
    return BoundaryHistory(columns["time_s"], columns["u_x_m"], columns.get("u_y_m"))


def read_profile(path: str | Path) -> SurfaceProfile:
    """Read a surface profile with columns x_m, height_m.

    Raises:
        InputError: as :func:`wrinklewave.config.columns.read_columns`.
    """
    columns = read_columns(path, ("x_m", "height_m"))
    return SurfaceProfile(columns["x_m"], columns["height_m"])
