"""What figures of one surface motion are drawn from, and the registry of these figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.results import Analysis
from wrinklewave.analysis.subject import Subject, subject_of
from wrinklewave.figures.registry import Registry
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True)
class StrainSnapshots:
    """Strain over the depth of a block of n_y x n_x elements, at a few times.

    Attributes:
        time: [s], shape [n_times].
        X, Y: undeformed corners of the elements [m], shape [n_y + 1, n_x + 1], Y from mid-height up.
        x, y: where they are [m], shape [n_times, n_y + 1, n_x + 1].
        strain_xx: nominal strain in the elements, compression > 0, shape [n_times, n_y, n_x].
    """

    time: Array
    X: Array
    Y: Array
    x: Array
    y: Array
    strain_xx: Array


@dataclass(frozen=True)
class FigureInputs:
    """A surface motion, its analysis, and what a simulation adds.

    Attributes:
        subject: the surface motion as arrays.
        analysis: of the same surface motion.
        positions: laboratory x [m] and times [s] at which curves are cut from the maps.
        times: see ``positions``.
        snapshots: of the strain over the depth, if there are any.
        history: columns of the energy balance by name, each of shape [n], if there are any.
    """

    subject: Subject
    analysis: Analysis
    positions: tuple[float, ...]
    times: tuple[float, ...]
    snapshots: StrainSnapshots | None = None
    history: Mapping[str, Array] | None = None

    @property
    def surface_moves(self) -> bool:
        """Whether there is any out-of-plane displacement to show."""
        return bool(np.fmax.reduce(np.abs(self.subject.u_y), axis=None) > 0.0)


FIGURES: Registry[FigureInputs] = Registry("wrinklewave.figures:FIGURES")


def figure_inputs(
    surface: xr.Dataset,
    analysis: Analysis,
    *,
    positions: tuple[float, ...],
    times: tuple[float, ...],
    snapshots: StrainSnapshots | None = None,
    history: Mapping[str, Array] | None = None,
) -> FigureInputs:
    """Collect what figures are drawn from, as described at :class:`FigureInputs`."""
    return FigureInputs(subject_of(surface), analysis, positions, times, snapshots, history)
