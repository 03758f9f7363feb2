"""A model on a GPU: what lies there, how it gets there and back, and how the kernels are launched."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numba import config, cuda

from wrinklewave.dynamics.backends import Sample
from wrinklewave.dynamics.boundary import FORCE, N_TOTALS, Boundary, n_edge_nodes
from wrinklewave.dynamics.cuda import kernels
from wrinklewave.dynamics.energy import N_COLUMNS
from wrinklewave.dynamics.fields import FIELDS
from wrinklewave.dynamics.step import Arrays, update_factors
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

    from numpy.typing import NDArray

    from wrinklewave.dynamics.model import Model

SAMPLES_PER_LAUNCH = 64
SIMULATED_THREADS = 4
"""In numba's simulator every thread is one of Python's."""
SIMULATED_RESIDENTS = 64
"""Nodes that the simulated device is said to have threads for, so that small meshes try both ways of launching."""

config.CUDA_LOW_OCCUPANCY_WARNINGS = 0  # meshes too small to fill a GPU are no mistake


@dataclass(frozen=True, eq=False)
class _Resident:
    """What stays on the device: arguments of the kernels, see :mod:`wrinklewave.dynamics.cuda.kernels`."""

    arrays: Arrays
    layer: Any
    memory: tuple[Any, ...]
    boundary: Boundary
    density: Any


class _Times(NamedTuple):
    """Arguments of a march: time, last step, step [s], and the Prony coefficients of the first step."""

    t: float
    dt_last: float
    dt: float
    first_factors: Any


class _Samples(NamedTuple):
    """Where the device puts its samples, one after the other."""

    sums: Any
    totals: Any
    corner: Any


class Cuda:
    """A :class:`~wrinklewave.dynamics.backends.Backend` on the current CUDA device, in double precision.

    Raises:
        InputError: in numba's simulator, if it cannot work as it is set up.
    """

    def __init__(self, model: Model) -> None:
        if config.ENABLE_CUDASIM and not config.DISABLE_JIT:
            raise InputError(
                "numba simulates CUDA, which cannot call compiled functions",
                key="NUMBA_ENABLE_CUDASIM",
                cure="set NUMBA_DISABLE_JIT=1 as well",
            )
        self._model = model
        self._threads = SIMULATED_THREADS if config.ENABLE_CUDASIM else kernels.BLOCK
        self._shared = 8 * self._threads  # bytes: one number for each
        self._blocks = -(-model.mesh.X.size // self._threads)

    def march(
        self, n: int, group: int, t: float, dt_last: float, dt: float, totals: NDArray[np.float64]
    ) -> Iterator[Sample]:
        """Step and survey on the device; samples come from it by the launch."""
        terms, factors = self._model.arrays.terms, self._model.arrays.factors
        for first in range(0, n, group * SAMPLES_PER_LAUNCH):
            count = min(group * SAMPLES_PER_LAUNCH, n - first)
            last = dt_last if first == 0 else dt
            update_factors(terms, last, dt, factors)
            times = _Times(t + first * dt, last, dt, cuda.to_device(factors))
            if count > 1:
                update_factors(terms, dt, dt, factors)
            self._on_device.arrays.factors.copy_to_device(factors)  # type: ignore[attr-defined]  # on the device it is a device array
            yield from self._march(count, group, times, totals)

    def stable_steps(self) -> NDArray[np.float64]:
        """Largest stable step of each element [s]."""
        d = self._on_device
        out = cuda.device_array(self._model.mesh.shape)
        kernels.stable_steps[self._blocks, self._threads](d.arrays, d.layer, d.density, out)
        return out.copy_to_host()

    def fields(self) -> NDArray[np.float64]:
        """Element fields."""
        d = self._on_device
        out = cuda.device_array((len(FIELDS), *self._model.mesh.shape))
        kernels.fields[self._blocks, self._threads](d.arrays, d.layer, d.memory, self._model.terms, out)
        return out.copy_to_host()

    def fetch_nodes(self) -> None:
        """Copy displacements and velocities to ``model.arrays``."""
        for name in ("u", "w", "vx", "vy"):
            getattr(self._on_device.arrays, name).copy_to_host(getattr(self._model.arrays, name))

    def fetch_all(self) -> None:
        """Copy the memory as well."""
        self.fetch_nodes()
        for k, component in enumerate(self._on_device.memory):
            component.copy_to_host(self._model.memory[k])

    @cached_property
    def _on_device(self) -> _Resident:
        model, (rows, columns) = self._model, self._model.mesh.shape
        arrays = model.arrays._replace(forces=np.zeros((rows, 8, columns + 2)))
        boundary = model.boundary
        names = ("motion", "motion_across", "old", "bins")
        return _Resident(
            arrays=Arrays(*map(cuda.to_device, arrays)),
            layer=cuda.to_device(model.mesh.layer.astype(np.uint8)),
            memory=tuple(cuda.to_device(component) for component in model.memory),
            boundary=boundary._replace(**{name: cuda.to_device(getattr(boundary, name)) for name in names}),
            density=cuda.to_device(model.density),
        )

    @property
    def _fits(self) -> bool:
        """Whether every node can have a thread at once: a multiprocessor always holds one block."""
        if config.ENABLE_CUDASIM:
            return self._model.mesh.X.size <= SIMULATED_RESIDENTS
        return self._blocks <= cuda.get_current_device().MULTIPROCESSOR_COUNT

    def _march(self, n: int, group: int, times: _Times, totals: NDArray[np.float64]) -> Iterator[Sample]:
        count, (rows, columns) = -(-n // group), self._model.mesh.X.shape
        edge_nodes = n_edge_nodes(rows, columns)
        gathered = cuda.to_device(np.zeros((edge_nodes, N_TOTALS)))
        samples = _Samples(
            cuda.to_device(np.zeros((count, rows, kernels.N_SUMS))),
            cuda.device_array((count, edge_nodes, N_TOTALS)),
            cuda.device_array((count, 2)),
        )
        begin = time.perf_counter()
        launch = self._in_one_launch if self._fits else self._in_groups
        launch(n, group, times, gathered, samples)
        sums, edges, corner = (sample.copy_to_host() for sample in samples)
        seconds = time.perf_counter() - begin
        before = totals.copy()
        before[FORCE] = 0.0
        for k in range(count):
            totals[:] = before + edges[k].sum(axis=0)
            yield Sample(
                steps=min(group, n - k * group),
                seconds=seconds if k == 0 else 0.0,
                survey=sums[k, :-1, :N_COLUMNS],
                kinetic=float(sums[k, :, kernels.KINETIC].sum()),
                corner=(float(corner[k, 0]), float(corner[k, 1])),
            )

    def _in_one_launch(self, n: int, group: int, times: _Times, gathered: Any, samples: _Samples) -> None:
        d = self._on_device
        state = (d.arrays, d.layer, d.memory, self._model.terms, d.boundary, gathered)
        blocks = 1 if config.ENABLE_CUDASIM else self._blocks
        kernels.march[blocks, self._threads, 0, self._shared](n, group, *times, *state, *samples)

    def _in_groups(self, n: int, group: int, times: _Times, gathered: Any, samples: _Samples) -> None:
        d = self._on_device
        state = (d.arrays, d.layer, d.memory, self._model.terms)
        blocks, rows = 0, self._model.mesh.X.shape[0]
        for k, first in enumerate(range(0, n, group)):
            if first > 0:
                times = _Times(times.t + group * times.dt, times.dt, times.dt, d.arrays.factors)
            arguments = (min(group, n - first), *times, *state, d.boundary, gathered)
            blocks = blocks or self._cooperating_blocks(kernels.steps, arguments)
            kernels.steps[blocks, self._threads](*arguments)
            then = (samples.sums[k], samples.totals[k], samples.corner[k])
            kernels.sample[rows, self._threads, 0, self._shared](times.dt, *state, gathered, *then)

    def _cooperating_blocks(self, kernel: Any, arguments: tuple[Any, ...]) -> int:
        """As many blocks as are useful and can be on the device together, so that they may wait for each other."""
        if config.ENABLE_CUDASIM:
            return 1
        compiled = kernel.compile(tuple(kernel.typeof_pyval(argument) for argument in arguments))
        return min(self._blocks, compiled.max_cooperative_grid_blocks(self._threads))
