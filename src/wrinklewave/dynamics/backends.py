"""Where a model is stepped: one interface to the processor and to a GPU."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Protocol

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from wrinklewave.dynamics.model import Model

Device = Literal["cpu", "cuda"]


@dataclass(frozen=True)
class March:
    """Steps of one length that a simulation asks for.

    Args:
        n: how many, at least one.
        start: time of the present positions [s].
        last_dt: the step that led to them (0 at the start) [s].
        dt: the step [s].
        counts: how many steps each row of elements takes in one step, shape [n_rows], if rows have steps of their own.
    """

    n: int
    start: float
    last_dt: float
    dt: float
    counts: NDArray | None = None


@dataclass(frozen=True, eq=False)
class Sample:
    """Energies, edges and the struck end's top corner after a march.

    Args:
        seconds: of wall-clock time that its steps took.
        survey: sums and extremes of each element row, shape [n_rows, N_COLUMNS], see
            :mod:`wrinklewave.dynamics.energy`; the next sample may overwrite it.
        kinetic: kinetic energy at mid-step [J/m].
        totals: work and impulses at the boundary during the march, and the force in its last step, shape [N_TOTALS],
            see :mod:`wrinklewave.dynamics.boundary`.
        corner: displacements u, w of the struck end's top corner [m].
    """

    seconds: float
    survey: NDArray
    kinetic: float
    totals: NDArray
    corner: tuple[float, float]


@dataclass(frozen=True, eq=False)
class Snapshot:
    """Fields at one time.

    Args:
        nodal: displacements u, w [m] and velocities [m/s], shape [4, n_rows + 1, n_columns + 1].
        elements: shape [len(FIELDS), n_rows, n_columns], see :mod:`wrinklewave.dynamics.fields`.
    """

    nodal: NDArray
    elements: NDArray


class Backend(Protocol):
    """Steps a model that is at rest or comes from a checkpoint, whose state it takes when it is first used."""

    def march(self, wanted: March) -> Sample:
        """Take steps, and a sample of the state that they lead to."""

    def stable_steps_of_rows(self) -> NDArray:
        """The smallest of :meth:`stable_steps` in each row [s], NaN if any is, shape [n_rows]."""

    def stable_steps(self) -> NDArray:
        """Largest stable step of each element [s], shape [n_rows, n_columns]."""

    def snapshot(self) -> Callable[[], Snapshot]:
        """Set the present state aside. The result makes the fields of it, once, on any thread and later if need be."""

    def fetch_all(self) -> None:
        """Bring all that a checkpoint keeps to ``model.arrays`` and ``model.memory``."""


def backend_for(device: Device, model: Model) -> Backend:
    """The backend of a device, for one model."""
    if device == "cuda":
        from wrinklewave.dynamics.cuda.backend import Batch

        return Batch([model]).members()[0]
    from wrinklewave.dynamics.cpu import Cpu

    return Cpu(model)
