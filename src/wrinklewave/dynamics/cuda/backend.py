"""A model on a GPU: what lies there, how it gets there and back, and how the kernels are launched."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numba import config, cuda

from wrinklewave.dynamics.backends import Sample, Snapshot
from wrinklewave.dynamics.boundary import FORCE, N_TOTALS, Boundary, n_edge_nodes
from wrinklewave.dynamics.cuda import kernels
from wrinklewave.dynamics.energy import KINETIC, N_COLUMNS, N_SUMS
from wrinklewave.dynamics.fields import FIELDS
from wrinklewave.dynamics.step import Arrays, update_factors
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

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


class _Buffers(NamedTuple):
    """Of a march: what the edges gather on the device, the same on the host before it starts, and the samples."""

    gathered: Any
    nothing: NDArray[np.float64]
    samples: _Samples


@dataclass(frozen=True, eq=False)
class _Slot:
    """Room for a snapshot, on the device and in memory of the host that the device can write to."""

    nodal: Any
    elements: Any
    nodal_copy: NDArray[np.float64]
    elements_copy: NDArray[np.float64]

    @classmethod
    def of(cls, model: Model) -> _Slot:
        nodal, elements = (4, *model.mesh.X.shape), (len(FIELDS), *model.mesh.shape)
        on_device = (cuda.device_array(shape) for shape in (nodal, elements))
        return cls(*on_device, *(cuda.pinned_array(shape) for shape in (nodal, elements)))


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
        self._slots: list[_Slot] = []  # that no snapshot holds
        self._compiled = False

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

    def least_stable_step(self) -> float:
        """The smallest of them [s]."""
        return float(self._estimate_steps()[1].copy_to_host(stream=self._stream).min())

    def stable_steps(self) -> NDArray[np.float64]:
        """Largest stable step of each element [s]."""
        return self._estimate_steps()[0].copy_to_host(stream=self._stream)

    def _estimate_steps(self) -> tuple[Any, Any]:
        """Stable steps, and the smallest of each row, on the device."""
        d, (of_elements, of_rows) = self._on_device, self._steps
        launch = kernels.stable_steps[self._model.mesh.shape[0], self._threads, self._stream, self._shared]
        launch(d.arrays, d.layer, d.density, of_elements, of_rows)
        return self._steps

    def snapshot(self) -> Callable[[], Snapshot]:
        """Compute the fields on the device; they are copied from it while the next steps are taken."""
        d, slot = self._on_device, self._slots.pop() if self._slots else _Slot.of(self._model)
        launch = kernels.snapshot[self._blocks, self._threads, self._stream]
        launch(d.arrays, d.layer, d.memory, self._model.terms, slot.nodal, slot.elements)
        ready, copied = cuda.event(), cuda.event()
        ready.record(self._stream)
        ready.wait(self._copies)
        slot.nodal.copy_to_host(slot.nodal_copy, stream=self._copies)
        slot.elements.copy_to_host(slot.elements_copy, stream=self._copies)
        copied.record(self._copies)

        def wait() -> Snapshot:
            cuda.current_context()  # the device becomes that of the thread that waits
            copied.synchronize()
            found = Snapshot(slot.nodal_copy.copy(), slot.elements_copy.copy())
            self._slots.append(slot)
            return found

        return wait

    def fetch_all(self) -> None:
        """Copy displacements, velocities and memory to the model."""
        d, model = self._on_device, self._model
        for name in ("u", "w", "vx", "vy"):
            getattr(d.arrays, name).copy_to_host(getattr(model.arrays, name), stream=self._stream)
        for component, kept in zip(d.memory, model.memory, strict=True):
            component.copy_to_host(kept, stream=self._stream)
        self._stream.synchronize()

    @cached_property
    def _on_device(self) -> _Resident:
        model, (rows, columns) = self._model, self._model.mesh.shape
        arrays = model.arrays._replace(forces=np.zeros((rows, 8, columns + 2), model.arrays.u.dtype))
        boundary = model.boundary
        names = ("motion", "motion_across", "old", "bins")
        return _Resident(
            arrays=Arrays(*map(cuda.to_device, arrays)),
            layer=cuda.to_device(model.mesh.layer.astype(np.uint8)),
            memory=tuple(cuda.to_device(component) for component in model.memory),
            boundary=boundary._replace(**{name: cuda.to_device(getattr(boundary, name)) for name in names}),
            density=cuda.to_device(model.density),
        )

    @cached_property
    def _stream(self) -> Any:
        """Of the steps, and of what is copied between them."""
        return cuda.stream()

    @cached_property
    def _copies(self) -> Any:
        """Of what is copied while steps are taken."""
        return cuda.stream()

    @cached_property
    def _steps(self) -> tuple[Any, Any]:
        rows, columns = self._model.mesh.shape
        return cuda.device_array((rows, columns)), cuda.device_array(rows)

    @cached_property
    def _buffers(self) -> _Buffers:
        rows, columns = self._model.mesh.X.shape
        nothing = np.zeros((n_edge_nodes(rows, columns), N_TOTALS))
        samples = _Samples(
            cuda.to_device(np.zeros((SAMPLES_PER_LAUNCH, rows, N_SUMS))),
            cuda.device_array((SAMPLES_PER_LAUNCH, *nothing.shape)),
            cuda.device_array((SAMPLES_PER_LAUNCH, 2)),
        )
        return _Buffers(cuda.to_device(nothing), nothing, samples)

    @property
    def _fits(self) -> bool:
        """Whether every node can have a thread at once: a multiprocessor always holds one block."""
        if config.ENABLE_CUDASIM:
            return self._model.mesh.X.size <= SIMULATED_RESIDENTS
        return self._blocks <= cuda.get_current_device().MULTIPROCESSOR_COUNT

    def _march(self, n: int, group: int, times: _Times, totals: NDArray[np.float64]) -> Iterator[Sample]:
        count, b = -(-n // group), self._buffers
        samples = _Samples(*(sample[:count] for sample in b.samples))
        launch = self._in_one_launch if self._fits else self._in_groups
        b.gathered.copy_to_device(b.nothing, stream=self._stream)
        if not self._compiled:  # no step: the time of the first ones is not to be that of the compiler
            launch(0, group, times, b.gathered, samples)
            self._stream.synchronize()
            self._compiled = True
        begin = time.perf_counter()
        launch(n, group, times, b.gathered, samples)
        sums, edges, corner = (sample.copy_to_host(stream=self._stream) for sample in samples)
        self._stream.synchronize()
        seconds = time.perf_counter() - begin
        before = totals.copy()
        before[FORCE] = 0.0
        for k in range(count):
            totals[:] = before + edges[k].sum(axis=0)
            yield Sample(
                steps=min(group, n - k * group),
                seconds=seconds if k == 0 else 0.0,
                survey=sums[k, :-1, :N_COLUMNS],
                kinetic=float(sums[k, :, KINETIC].sum()),
                corner=(float(corner[k, 0]), float(corner[k, 1])),
            )

    def _in_one_launch(self, n: int, group: int, times: _Times, gathered: Any, samples: _Samples) -> None:
        d = self._on_device
        state = (d.arrays, d.layer, d.memory, self._model.terms, d.boundary, gathered)
        blocks = 1 if config.ENABLE_CUDASIM else self._blocks
        kernels.march[blocks, self._threads, self._stream, self._shared](n, group, *times, *state, *samples)

    def _in_groups(self, n: int, group: int, times: _Times, gathered: Any, samples: _Samples) -> None:
        d = self._on_device
        state = (d.arrays, d.layer, d.memory, self._model.terms)
        blocks, rows = 0, self._model.mesh.X.shape[0]
        for k, first in enumerate(range(0, max(n, 1), group)):
            if first > 0:
                times = _Times(times.t + group * times.dt, times.dt, times.dt, d.arrays.factors)
            arguments = (min(group, n - first), *times, *state, d.boundary, gathered)
            blocks = blocks or self._cooperating_blocks(kernels.steps, arguments)
            kernels.steps[blocks, self._threads, self._stream](*arguments)
            then = (samples.sums[k], samples.totals[k], samples.corner[k])
            kernels.sample[rows, self._threads, self._stream, self._shared](times.dt, *state, gathered, *then)

    def _cooperating_blocks(self, kernel: Any, arguments: tuple[Any, ...]) -> int:
        """As many blocks as are useful and can be on the device together, so that they may wait for each other."""
        if config.ENABLE_CUDASIM:
            return 1
        compiled = kernel.compile(tuple(kernel.typeof_pyval(argument) for argument in arguments))
        return min(self._blocks, compiled.max_cooperative_grid_blocks(self._threads))
