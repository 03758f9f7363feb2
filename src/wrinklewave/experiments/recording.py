"""What a simulation leaves behind as it runs: surface frames in memory, field frames on disk or in memory.

The state is set aside at an output time; a thread of its own computes the fields and writes them while the next steps
are taken.
"""

from __future__ import annotations

from collections import deque
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave.dynamics.checkpoint import Record
from wrinklewave.dynamics.fields import NOMINAL, RATE, STRAIN, depth_weights, to_nodes
from wrinklewave.experiments.vtkhdf import FieldFile, FieldFrame
from wrinklewave.mesh.bilayer import SUBSTRATE

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from numpy.typing import NDArray

    from wrinklewave.dynamics.backends import Snapshot
    from wrinklewave.dynamics.simulation import Simulation
    from wrinklewave.mesh.block import GridMesh

SURFACE = ("time", "x_p", "y_p", "strain_xx", "strain_rate_xx", "stress_xx")
MOST_WAITING = 4
"""Outputs that may wait to be written; then the run waits for them."""


class SurfaceRecorder:
    """Motion of the surface nodes, and depth averages below them, at the surface times.

    Args:
        mesh: undeformed.
        depth: over which strain, rate and stress of the substrate are averaged, below its surface [m].
    """

    def __init__(self, mesh: GridMesh, depth: float) -> None:
        self._X, self._Y = mesh.X[-1], mesh.Y[-1]
        self._substrate = np.flatnonzero(mesh.layer[:, 0] == SUBSTRATE)
        y = mesh.Y[self._substrate[0] : self._substrate[-1] + 2, 0]
        self._weights = depth_weights(y, float(y[-1]), min(depth, float(y[-1] - y[0])))
        self._frames: list[tuple[NDArray[np.float64], ...]] = []

    def record(self, time: float, now: Snapshot) -> None:
        """Add the state at ``time`` [s]."""
        averages = (
            to_nodes(self._weights @ now.elements[k][self._substrate]) for k in (STRAIN, RATE, NOMINAL)
        )
        self._frames.append(
            (np.array(time), self._X + now.nodal[0, -1], self._Y + now.nodal[1, -1], *averages)
        )

    def to_record(self) -> Record:
        """The frames as stacked arrays, for a checkpoint or a dataset."""
        return Record(
            {name: np.stack([frame[k] for frame in self._frames]) for k, name in enumerate(SURFACE)}
        )

    def restore(self, record: Record) -> None:
        """Take up the frames of a checkpoint."""
        self._frames = list(zip(*(record.arrays[name] for name in SURFACE), strict=True))


class FieldStore:
    """Field frames in order of time: in a file that is written in place, or in memory.

    Args:
        times: of all frames [s].
        file: if they are not to be kept in memory.
    """

    def __init__(self, times: NDArray[np.float64], file: FieldFile | None = None) -> None:
        self.times = times
        self.file = file
        self._memory: dict[int, FieldFrame] = {}

    def add(self, index: int, now: Snapshot) -> None:
        """Keep a state as frame ``index``."""
        elements = now.elements.astype(np.float32)
        frame = FieldFrame(float(self.times[index]), now.nodal.astype(np.float32), elements)
        if self.file is None:
            self._memory[index] = frame
        else:
            self.file.write(index, frame)

    def __len__(self) -> int:
        return self.times.size

    def __getitem__(self, index: int) -> FieldFrame:
        return self._memory[index] if self.file is None else self.file.read(index)

    def nearest(self, times: Sequence[float]) -> list[FieldFrame]:
        """The frames nearest to the given times [s]."""
        return [self[int(np.argmin(np.abs(self.times - time)))] for time in times]


@dataclass(eq=False)
class Recording:
    """Hands the outputs of a simulation over to a thread that computes and writes them.

    As a context it ends when all is written. What goes wrong in the thread is raised at the next call.
    """

    surface_times: frozenset[float]
    surface: SurfaceRecorder
    fields: FieldStore
    _waiting: deque[Future[Any]] = field(default_factory=deque)

    def __post_init__(self) -> None:
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="output")

    def take(self, time: float, simulation: Simulation) -> None:
        """Keep the present state, that of ``time`` [s], wherever it is due."""
        while self._waiting and (self._waiting[0].done() or len(self._waiting) >= MOST_WAITING):
            self._waiting.popleft().result()
        self._waiting.append(self._thread.submit(self._write, time, simulation.backend.snapshot()))

    def flush(self) -> None:
        """Wait until all that was taken is written."""
        while self._waiting:
            self._waiting.popleft().result()

    def _write(self, time: float, snapshot: Callable[[], Snapshot]) -> None:
        now = snapshot()
        if time in self.surface_times:
            self.surface.record(time, now)
        index = int(np.searchsorted(self.fields.times, time))
        if index < self.fields.times.size and self.fields.times[index] == time:
            self.fields.add(index, now)

    def __enter__(self) -> Recording:
        return self

    def __exit__(self, kind: type[BaseException] | None, *error: object) -> None:
        with self._thread:
            if kind is None:
                self.flush()
