"""What a simulation leaves behind as it runs: surface frames in memory, field frames on disk or in memory."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.dynamics.checkpoint import Record
from wrinklewave.dynamics.fields import NOMINAL, RATE, STRAIN, depth_weights, to_nodes
from wrinklewave.mesh.bilayer import SUBSTRATE

if TYPE_CHECKING:
    from collections.abc import Sequence
    from pathlib import Path

    from numpy.typing import NDArray

    from wrinklewave.dynamics.simulation import Simulation

SURFACE = ("time", "x_p", "y_p", "strain_xx", "strain_rate_xx", "stress_xx")


@dataclass(eq=False)
class SurfaceRecorder:
    """Motion of the surface nodes, and depth averages below them, at the surface times.

    Args:
        depth: over which strain, rate and stress of the substrate are averaged, below its surface [m].
        frames: one tuple of :data:`SURFACE` per recorded time.
    """

    depth: float
    frames: list[tuple[NDArray[np.float64], ...]] = field(default_factory=list)

    def record(self, simulation: Simulation, fields: NDArray[np.float64]) -> None:
        """Add the present state."""
        a = simulation.model.arrays
        substrate = np.flatnonzero(simulation.model.mesh.layer[:, 0] == SUBSTRATE)
        y = a.Y[substrate[0] : substrate[-1] + 2, 0]
        weights = depth_weights(y, float(y[-1]), min(self.depth, float(y[-1] - y[0])))
        averages = (to_nodes(weights @ fields[k][substrate]) for k in (STRAIN, RATE, NOMINAL))
        self.frames.append((np.array(simulation.time), a.X[-1] + a.u[-1], a.Y[-1] + a.w[-1], *averages))

    def to_record(self) -> Record:
        """The frames as stacked arrays, for a checkpoint or a dataset."""
        return Record({name: np.stack([frame[k] for frame in self.frames]) for k, name in enumerate(SURFACE)})

    def restore(self, record: Record) -> None:
        """Take up the frames of a checkpoint."""
        self.frames = list(zip(*(record.arrays[name] for name in SURFACE), strict=True))


@dataclass(frozen=True, eq=False)
class FieldFrame:
    """Nodal and element fields at one time, in single precision.

    Args:
        time: [s].
        nodal: u_x, u_y [m], v_x, v_y [m/s], shape [4, n_rows + 1, n_columns + 1].
        elements: shape [len(FIELDS), n_rows, n_columns].
    """

    time: float
    nodal: NDArray[np.float32]
    elements: NDArray[np.float32]


class FieldStore:
    """Field frames in order of time: each in a file of its own, which a kill cannot damage, or in memory."""

    def __init__(self, folder: Path | None) -> None:
        self.folder = folder
        self._memory: list[FieldFrame] = []
        if folder is not None:
            folder.mkdir(parents=True, exist_ok=True)

    def add(self, index: int, simulation: Simulation, fields: NDArray[np.float64]) -> None:
        """Keep the present state as frame ``index``."""
        a = simulation.model.arrays
        nodal = np.stack([a.u, a.w, a.vx, a.vy]).astype(np.float32)
        frame = FieldFrame(simulation.time, nodal, fields.astype(np.float32))
        if self.folder is None:
            self._memory.append(frame)
            return
        file = self.folder / f"{index:06d}.npz"
        partial = file.with_suffix(".part")
        with partial.open("wb") as stream:
            np.savez(stream, time=frame.time, nodal=frame.nodal, elements=frame.elements)
        partial.replace(file)

    def __len__(self) -> int:
        return len(self._memory) if self.folder is None else len(self._files())

    def __getitem__(self, index: int) -> FieldFrame:
        if self.folder is None:
            return self._memory[index]
        with np.load(self._files()[index]) as data:
            return FieldFrame(float(data["time"]), data["nodal"], data["elements"])

    def times(self) -> NDArray[np.float64]:
        """Times of all frames [s]."""
        return np.array([self[k].time for k in range(len(self))])

    def nearest(self, times: Sequence[float]) -> list[FieldFrame]:
        """The frames nearest to the given times [s]."""
        known = self.times()
        return [self[int(np.argmin(np.abs(known - time)))] for time in times]

    def forget_from(self, index: int) -> None:
        """Drop the frames from ``index`` on: a restart will make them again."""
        assert self.folder is not None  # only runs with a folder restart
        for file in self._files()[index:]:
            file.unlink()

    def remove(self) -> None:
        """Delete the files of the frames, once they have been gathered elsewhere."""
        if self.folder is not None:
            for file in self.folder.iterdir():
                file.unlink()
            self.folder.rmdir()

    def _files(self) -> list[Path]:
        assert self.folder is not None
        return sorted(self.folder.glob("*.npz"))
