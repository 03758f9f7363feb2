"""A batch of models on a GPU: what lies there, how it gets there and back, and how the kernels are launched."""

from __future__ import annotations

import time
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numba import config, cuda

from wrinklewave.dynamics.backends import March, Sample, Snapshot
from wrinklewave.dynamics.boundary import N_TOTALS, Boundary, Nodes, n_edge_nodes
from wrinklewave.dynamics.cuda import kernels
from wrinklewave.dynamics.cuda.kernels import Tall
from wrinklewave.dynamics.energy import KINETIC, N_COLUMNS, N_SUMS
from wrinklewave.dynamics.fields import FIELDS
from wrinklewave.dynamics.step import update_factors
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping, Sequence

    from numpy.typing import NDArray

    from wrinklewave.dynamics.model import Model

SIMULATED_THREADS = 4
"""In numba's simulator every thread is one of Python's."""
WARP = 32
NODAL = Nodes._fields
BY_LAYER = ("moduli", "terms", "factors")
MOST_MEMBERS = 64
"""Of a batch: more do not fill a device any better, and keep more results waiting."""
CONTEXT = 0.6e9
"""About how many bytes of the device a process takes before it has any arrays there."""
USED_MEMORY = 0.8
"""Part of the device's free memory that batches may take."""
FORCES, OUTPUTS = 8, 6
"""Components of the forces on an element; snapshots of a member that may wait at the same time, and one more."""

config.CUDA_LOW_OCCUPANCY_WARNINGS = 0  # meshes too small to fill a GPU are no mistake


class _Resident(NamedTuple):
    """What stays on the device: arguments of the kernels, see :mod:`wrinklewave.dynamics.cuda.kernels`."""

    tall: Tall
    memory: tuple[Any, ...]
    boundary: Boundary


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


class _Buffers(NamedTuple):
    """What launches leave behind: of the edges, node by node and together; by rows; stable steps of elements and rows.

    The first index counts members: of the batch in ``totals``, of the launch in ``sums``, ``edges`` and ``least``.
    """

    totals: Any
    sums: Any
    edges: Any
    steps: Any
    least: Any


def shape_of(model: Model) -> tuple[Any, ...]:
    """What models must have in common to be members of one batch."""
    a, boundary = model.arrays, model.boundary
    return a.X.shape, a.u.dtype, model.memory.shape, a.terms.shape, boundary.old.shape, boundary.bins.shape


def memory_of(model: Model) -> int:
    """About how many bytes a member of a batch takes on the device."""
    a, outputs = model.arrays, 4 * model.mesh.X.size + len(FIELDS) * model.mesh.n_elements
    state = (len(NODAL) + FORCES) * a.u.nbytes + model.memory.nbytes + 8 * model.mesh.n_elements
    return state + 8 * OUTPUTS * outputs


def most_members(model: Model, batches: int) -> int:
    """How many models of one shape each of some batches, in processes of their own, can have the memory for."""
    free = USED_MEMORY * cuda.current_context().get_memory_info().free / batches - CONTEXT
    return max(1, int(min(MOST_MEMBERS, free / memory_of(model))))


def most_processes() -> float:
    """How many processes the device's memory has room for, with as much again for their batches."""
    return max(1.0, cuda.current_context().get_memory_info().free / (2 * CONTEXT))


class Batch:
    """Models of one shape on the current CUDA device, whatever their numbers; :meth:`members` step them.

    Members that march together do so in one launch, each with its own step and number of steps; none depends on which
    others do.

    Raises:
        InputError: in numba's simulator, if it cannot work as it is set up.
        ValueError: if the models are not of one shape.
    """

    def __init__(self, models: Sequence[Model]) -> None:
        if config.ENABLE_CUDASIM and not config.DISABLE_JIT:
            raise InputError(
                "numba simulates CUDA, which cannot call compiled functions",
                key="NUMBA_ENABLE_CUDASIM",
                cure="set NUMBA_DISABLE_JIT=1 as well",
            )
        if len(set(map(shape_of, models))) > 1:
            raise ValueError("models of more than one shape")
        self._models = list(models)
        self.threads = SIMULATED_THREADS if config.ENABLE_CUDASIM else kernels.BLOCK
        self.slots: list[_Slot] = []  # that no snapshot holds
        self._shared = 8 * self.threads  # bytes: one number for each
        self._grid: tuple[int, int] | None = None  # of the steps; not known before the first
        self._least: dict[int, float] = {}  # stable step of members' present states, as far as it is known

    def members(self) -> list[Cuda]:
        """A backend for each model."""
        return [Cuda(self, place, model) for place, model in enumerate(self._models)]

    def march(self, wanted: Mapping[int, March]) -> dict[int, Sample]:
        """Step the members in the places that want it: steps, samples and stable steps in a row, one wait for all."""
        places = sorted(wanted, key=lambda place: -wanted[place].n)
        marches = [wanted[place] for place in places]
        n = np.array([march.n for march in marches])
        times = cuda.to_device(np.array([(m.start, m.last_dt, m.dt) for m in marches]), stream=self.stream)
        members = cuda.to_device(np.array(places), stream=self.stream)
        first_factors = self._bring_factors(wanted)
        if self._grid is None:  # no step: the time of the first ones is not to be that of the compiler
            self._step(0 * n, members, times, first_factors)
            self.stream.synchronize()
        begin = time.perf_counter()
        self._step(n, members, times, first_factors)
        sums, edges, least = self._survey(members, times)
        seconds = (time.perf_counter() - begin) / n.sum()
        self._least |= {place: float(smallest) for place, smallest in zip(places, least, strict=True)}
        return {
            place: Sample(
                seconds=seconds * march.n,
                survey=sums[k, :-1, :N_COLUMNS],
                kinetic=float(sums[k, :, KINETIC].sum()),
                totals=edges[k, :N_TOTALS],
                corner=(float(edges[k, N_TOTALS]), float(edges[k, N_TOTALS + 1])),
            )
            for k, (place, march) in enumerate(zip(places, marches, strict=True))
        }

    def _bring_factors(self, wanted: Mapping[int, March]) -> Any:
        """Prony coefficients of all members but the first step's go to where the kernels look for them."""
        first_factors = self._factors.copy()
        for place, march in wanted.items():
            own, arrays = self.layers(place), self._models[place].arrays
            terms, factors = arrays.terms, arrays.factors
            update_factors(terms, march.last_dt, march.dt, factors)
            first_factors[own] = factors
            if march.n > 1:
                update_factors(terms, march.dt, march.dt, factors)
            self._factors[own] = factors
        self.resident.tall.factors.copy_to_device(self._factors, stream=self.stream)
        return cuda.to_device(first_factors, stream=self.stream)

    def _step(self, n: NDArray[np.int64], *launch: Any) -> None:
        d = self.resident
        arguments = (cuda.to_device(n, stream=self.stream), *launch, d.tall, d.memory, self._models[0].terms)
        arguments = (*arguments, self._nodes, d.boundary, self._buffers.totals)
        self._grid = self._grid or self._cooperating(arguments)
        kernels.steps[(*self._grid, self.stream)](*arguments)

    def _survey(self, members: Any, times: Any) -> tuple[NDArray, NDArray, NDArray]:
        """Of the members of a launch: sums by rows, what the edges have gathered, and the smallest stable step."""
        d, b, count, height = self.resident, self._buffers, members.size, self._height
        launch = kernels.sample[count * height, self.threads, self.stream, self._shared]
        terms, sums, edges = self._models[0].terms, b.sums[:count], b.edges[:count]
        launch(members, times, d.tall, d.memory, terms, b.totals, sums, edges)
        self._estimate_steps(members)
        found = (values[:count].copy_to_host(stream=self.stream) for values in (sums, edges, b.least))
        sums, edges, least = found
        self.stream.synchronize()
        return sums, edges, least.min(axis=1)

    def _estimate_steps(self, members: Any) -> None:
        b, count = self._buffers, members.size
        blocks = count * (self._height - 1)
        launch = kernels.stable_steps[blocks, self.threads, self.stream, self._shared]
        launch(len(self._models), members, self.resident.tall, b.steps, b.least[:count])

    def stable_steps(self, place: int) -> NDArray[np.float64]:
        """Largest stable step of each element of a member [s], shape [n_rows, n_columns]."""
        self._estimate_steps(cuda.to_device(np.array([place]), stream=self.stream))
        return self._buffers.steps[self.rows(place)].copy_to_host(stream=self.stream)

    def least_stable_step(self, place: int) -> float:
        """The smallest of them [s]; the last march has brought it with it."""
        if place not in self._least:
            self._least[place] = float(self.stable_steps(place).min())
        return self._least[place]

    def rows(self, place: int) -> slice:
        """Rows of elements of a member in the tall mesh."""
        return slice(place * self._height, (place + 1) * self._height - 1)

    def layers(self, place: int) -> slice:
        """Layers of a member among those of all."""
        count = len(self._models[place].density)
        return slice(place * count, (place + 1) * count)

    @cached_property
    def resident(self) -> _Resident:
        """Everything, brought to the device at the first use."""
        arrays = [model.arrays for model in self._models]
        tall = {name: np.concatenate([getattr(a, name) for a in arrays]) for name in (*NODAL, *BY_LAYER)}
        tall["density"] = np.concatenate([model.density for model in self._models])
        tall["forces"] = np.zeros((len(tall["u"]), 8, tall["u"].shape[1] + 1), tall["u"].dtype)
        tall["layer"] = self._tall(model.mesh.layer.astype(np.uint8) for model in self._models)
        components = zip(*(model.memory for model in self._models), strict=True)
        return _Resident(
            tall=Tall(**{name: cuda.to_device(values) for name, values in tall.items()}),
            memory=tuple(cuda.to_device(self._tall(component)) for component in components),
            boundary=_stacked([model.boundary for model in self._models]),
        )

    @staticmethod
    def _tall(of_members: Iterable[NDArray]) -> NDArray:
        """Fields of elements on top of each other, with a row of no elements above each."""
        return np.concatenate([np.pad(values, ((0, 1), (0, 0))) for values in of_members])

    @cached_property
    def _factors(self) -> NDArray[np.float64]:
        """Prony coefficients as they are on the device."""
        return np.concatenate([model.arrays.factors for model in self._models])

    @cached_property
    def stream(self) -> Any:
        """Of the steps, and of what is copied between them."""
        return cuda.stream()

    @cached_property
    def copies(self) -> Any:
        """Of what is copied while steps are taken."""
        return cuda.stream()

    @property
    def _height(self) -> int:
        return self._models[0].mesh.X.shape[0]

    @cached_property
    def _nodes(self) -> Nodes:
        """Fields of nodes by member."""
        shape = (len(self._models), *self._models[0].mesh.X.shape)
        return Nodes(*(getattr(self.resident.tall, name).reshape(shape) for name in NODAL))

    @cached_property
    def _buffers(self) -> _Buffers:
        count, (height, columns) = len(self._models), self._models[0].mesh.X.shape
        return _Buffers(
            totals=cuda.device_array((count, n_edge_nodes(height, columns), N_TOTALS)),
            sums=cuda.to_device(np.zeros((count, height, N_SUMS))),
            edges=cuda.device_array((count, N_TOTALS + 2)),
            steps=cuda.device_array((count * height, columns - 1)),
            least=cuda.device_array((count, height - 1)),
        )

    def _cooperating(self, arguments: tuple[Any, ...]) -> tuple[int, int]:
        """Blocks and threads per block that can be on the device together, so that they may wait for each other.

        A multiprocessor has one block, of as many threads as registers allow; fewer do if nodes are few.
        """
        if config.ENABLE_CUDASIM:
            return 1, SIMULATED_THREADS
        kernel, nodes = kernels.steps, len(self._models) * self._models[0].mesh.X.size
        compiled = kernel.compile(tuple(kernel.typeof_pyval(argument) for argument in arguments))
        threads = compiled.max_threads_per_block // WARP * WARP
        return min(-(-nodes // threads), compiled.max_cooperative_grid_blocks(threads)), threads


def _stacked(boundaries: Sequence[Boundary]) -> Boundary:
    """Edge conditions on the device, each field with a leading index for the member."""
    longest = [max(len(getattr(b, name)) for b in boundaries) for name in ("motion", "motion_across")]
    even = [
        b._replace(
            motion=_lengthened(b.motion, longest[0]), motion_across=_lengthened(b.motion_across, longest[1])
        )
        for b in boundaries
    ]
    return Boundary(*(cuda.to_device(np.array(values)) for values in zip(*even, strict=True)))


def _lengthened(motion: NDArray[np.float64], n: int) -> NDArray[np.float64]:
    """A history of ``n`` segments that says the same: those that are missing last no time, at its end."""
    _, t, _, U, _, V = motion[-1]
    return np.concatenate([motion, np.tile([t, t, U, U, V, V], (n - len(motion), 1))])


class Cuda:
    """A :class:`~wrinklewave.dynamics.backends.Backend` of one member of a batch.

    Args:
        batch: that it is a member of.
        place: among the members.
        model: that it steps.
    """

    def __init__(self, batch: Batch, place: int, model: Model) -> None:
        self._batch, self._place, self._model = batch, place, model

    def march(self, wanted: March) -> Sample:
        """March alone."""
        return self._batch.march({self._place: wanted})[self._place]

    def least_stable_step(self) -> float:
        """The smallest of them [s]."""
        return self._batch.least_stable_step(self._place)

    def stable_steps(self) -> NDArray[np.float64]:
        """Largest stable step of each element [s]."""
        return self._batch.stable_steps(self._place)

    def snapshot(self) -> Callable[[], Snapshot]:
        """Compute the fields on the device; they are copied from it while the next steps are taken."""
        batch, model = self._batch, self._model
        slot = batch.slots.pop() if batch.slots else _Slot.of(model)
        blocks = -(-model.mesh.X.size // batch.threads)
        launch = kernels.snapshot[blocks, batch.threads, batch.stream]
        own = self._own
        launch(own.tall, own.memory, model.terms, slot.nodal, slot.elements)
        ready, copied = cuda.event(), cuda.event()
        ready.record(batch.stream)
        ready.wait(batch.copies)
        slot.nodal.copy_to_host(slot.nodal_copy, stream=batch.copies)
        slot.elements.copy_to_host(slot.elements_copy, stream=batch.copies)
        copied.record(batch.copies)

        def wait() -> Snapshot:
            cuda.current_context()  # the device becomes that of the thread that waits
            copied.synchronize()
            found = Snapshot(slot.nodal_copy.copy(), slot.elements_copy.copy())
            batch.slots.append(slot)
            return found

        return wait

    def fetch_all(self) -> None:
        """Copy displacements, velocities and memory to the model."""
        own, model, stream = self._own, self._model, self._batch.stream
        for name in ("u", "w", "vx", "vy"):
            getattr(own.tall, name).copy_to_host(getattr(model.arrays, name), stream=stream)
        for component, kept in zip(own.memory, model.memory, strict=True):
            component.copy_to_host(kept, stream=stream)
        stream.synchronize()

    @cached_property
    def _own(self) -> _Resident:
        """Its part of what stays on the device."""
        d, elements = self._batch.resident, self._batch.rows(self._place)
        nodes, layers = slice(elements.start, elements.stop + 1), self._batch.layers(self._place)
        parts = dict.fromkeys(NODAL, nodes) | dict.fromkeys((*BY_LAYER, "density"), layers)
        parts |= {"forces": nodes, "layer": elements}
        tall = Tall(**{name: getattr(d.tall, name)[part] for name, part in parts.items()})
        return d._replace(tall=tall, memory=tuple(component[elements] for component in d.memory))
