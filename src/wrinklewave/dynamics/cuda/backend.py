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
from wrinklewave.dynamics.cuda import kernels, row_kernels
from wrinklewave.dynamics.cuda.kernels import Tall
from wrinklewave.dynamics.cuda.row_kernels import WARP, Mean, Timetable
from wrinklewave.dynamics.energy import KINETIC, N_COLUMNS, N_SUMS
from wrinklewave.dynamics.fields import FIELDS
from wrinklewave.dynamics.row_steps import MOST, seen_over, update_factors_of_rows
from wrinklewave.dynamics.step import update_factors
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from numpy.typing import NDArray

    from wrinklewave.dynamics.model import Model
    from wrinklewave.dynamics.row_steps import RowSteps
    from wrinklewave.dynamics.step import Arrays

SIMULATED_THREADS = 4
"""In numba's simulator every thread is one of Python's."""
NODAL = Nodes._fields
BY_LAYER = ("moduli", "terms")
MOST_MEMBERS = 64
"""Of a batch: more do not fill a device any better, and keep more results waiting."""
CONTEXT = 0.6e9
"""About how many bytes of the device a process takes before it has any arrays there."""
USED_MEMORY = 0.8
"""Part of the device's free memory that batches may take."""
FORCES, OUTPUTS = 8, 6
"""Components of the forces on an element; snapshots of a member that may wait at the same time, and one more."""
FIRST, REST, SEEN = range(3)
"""Prony coefficients: of the first step of a march, of those that follow, and as its survey needs them."""

config.CUDA_LOW_OCCUPANCY_WARNINGS = 0  # meshes too small to fill a GPU are no mistake


class _Resident(NamedTuple):
    """What stays on the device: arguments of the kernels, see :mod:`wrinklewave.dynamics.cuda.kernels`.

    ``first_factors`` are the Prony coefficients of the first step of a march;
    ``seen`` is the same as ``tall``, but with the velocities and Prony coefficients that outputs are made of: where
    rows have steps of their own, velocities are means of a large step.
    """

    tall: Tall
    first_factors: Any
    seen: Tall
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
    own_steps, edges = model.row_steps is not None, (boundary.old.shape, boundary.bins.shape)
    return a.X.shape, a.u.dtype, model.memory.shape, a.terms.shape, own_steps, edges


def memory_of(model: Model) -> int:
    """About how many bytes a member of a batch takes on the device."""
    a, outputs = model.arrays, 4 * model.mesh.X.size + len(FIELDS) * model.mesh.n_elements
    means = 0 if model.row_steps is None else len(Mean._fields)
    state = (len(NODAL) + FORCES + means) * a.u.nbytes + model.memory.nbytes + 8 * model.mesh.n_elements
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
        self._least: dict[
            int, NDArray[np.float64]
        ] = {}  # stable steps of rows now, of members that have marched
        self._brought: dict[str, tuple[NDArray, Any]] = {}  # what launches were told, here and on the device

    def members(self) -> list[Cuda]:
        """A backend for each model."""
        return [Cuda(self, place, model) for place, model in enumerate(self._models)]

    def march(self, wanted: Mapping[int, March]) -> dict[int, Sample]:
        """Step the members in the places that want it: steps, samples and stable steps in a row, one wait for all."""
        places = sorted(wanted, key=lambda place: -wanted[place].n)
        marches = [wanted[place] for place in places]
        n = np.array([march.n for march in marches])
        times = self._bring("times", np.array([(m.start, m.last_dt, m.dt) for m in marches]))
        members = self._bring("members", np.array(places))
        self._bring_factors(wanted)
        if self._grid is None:  # no step: the time of the first ones is not to be that of the compiler
            self._step(self._told(0 * n, places, marches), members, times)
            self.stream.synchronize()
        begin = time.perf_counter()
        self._step(self._told(n, places, marches), members, times)
        sums, edges, least = self._survey(members, times)
        seconds = time.perf_counter() - begin
        self._least |= dict(zip(places, least, strict=True))
        for place, march in wanted.items():
            if march.counts is not None:
                self._row_steps(place).last[:] = march.dt / march.counts
        work = n * [1 if march.counts is None else march.counts.sum() for march in marches]
        return {
            place: Sample(
                seconds=seconds * float(share),
                survey=sums[k, :-1, :N_COLUMNS],
                kinetic=float(sums[k, :, KINETIC].sum()),
                totals=edges[k, :N_TOTALS],
                corner=(float(edges[k, N_TOTALS]), float(edges[k, N_TOTALS + 1])),
            )
            for k, (place, share) in enumerate(zip(places, work / work.sum(), strict=True))
        }

    def _told(self, n: NDArray[np.int64], places: Sequence[int], marches: Sequence[March]) -> tuple[Any, ...]:
        """What tells the kernel to take ``n`` steps with each of some members."""
        if not self._own_steps:
            return (self._bring("n", n),)
        counts = np.array([march.counts for march in marches])
        most = counts[:, -1]
        rows, due = listed(most[:, None] // counts)
        table = Timetable(
            listed=rows,
            due=due,
            period=most[:, None] // counts,
            ticks=n * most,
            dt=np.array([march.dt for march in marches]) / most,
            last=np.array([self._row_steps(place).last for place in places]),
        )
        return int(table.ticks.max()), Timetable(*map(self._bring, Timetable._fields, table))

    def _bring(self, name: str, values: NDArray) -> Any:
        """Numbers on the device, in the place of the last of this name; nothing is copied if those were the same."""
        before, there = self._brought.get(name, (np.empty(0), None))
        if there is None or before.shape != values.shape:
            there = cuda.to_device(values, stream=self.stream)
        elif not np.array_equal(before, values):
            there.copy_to_device(values, stream=self.stream)
        self._brought[name] = values, there
        return there

    def _row_steps(self, place: int) -> RowSteps:
        steps = self._models[place].row_steps
        assert steps is not None
        return steps

    def _bring_factors(self, wanted: Mapping[int, March]) -> None:
        """Prony coefficients of all members go to where the kernels look for them."""
        for place, march in wanted.items():
            own, model = self.layers(place), self._models[place]
            for which, factors in enumerate(_factors(march, model)):
                self._factors[which, own] = factors
        self._factors_on_device.copy_to_device(self._factors, stream=self.stream)

    def _step(self, steps: tuple[Any, ...], members: Any, times: Any) -> None:
        d = self.resident
        arguments = (*steps, members, times, d.first_factors, d.tall, d.memory, self._models[0].terms)
        arguments = (*arguments, self._nodes, d.boundary, self._buffers.totals)
        if self._own_steps:
            arguments = (*arguments, Mean(d.seen.vx, d.seen.vy))
        kernel = row_kernels.row_steps if self._own_steps else kernels.steps
        self._grid = self._grid or self._cooperating(kernel, arguments)
        kernel[(*self._grid, self.stream)](*arguments)

    def _survey(self, members: Any, times: Any) -> tuple[NDArray, NDArray, NDArray]:
        """Of the members of a launch: sums by rows, what the edges have gathered, and the stable steps of rows."""
        d, b, count, height = self.resident, self._buffers, members.size, self._height
        launch = kernels.sample[count * height, self.threads, self.stream, self._shared]
        sums, edges, least = b.sums[:count], b.edges[:count], b.least[:count]
        launch(members, times, d.seen, d.memory, self._models[0].terms, b.totals, sums, edges)
        self._estimate_steps(members, least)
        found = tuple(values.copy_to_host(stream=self.stream) for values in (sums, edges, least))
        self.stream.synchronize()
        return found

    def _estimate_steps(self, members: Any, least: Any) -> None:
        launch = kernels.stable_steps[least.size, self.threads, self.stream, self._shared]
        launch(len(self._models), members, self.resident.tall, self._buffers.steps, least)

    def stable_steps(self, place: int) -> NDArray[np.float64]:
        """Largest stable step of each element of a member [s], shape [n_rows, n_columns]."""
        self._estimate_steps(cuda.to_device(np.array([place]), stream=self.stream), self._buffers.least[:1])
        return self._buffers.steps[self.rows(place)].copy_to_host(stream=self.stream)

    def stable_steps_of_rows(self, place: int) -> NDArray[np.float64]:
        """The smallest of each row [s], shape [n_rows]; the last march has brought them with it."""
        if place not in self._least:
            self._least[place] = self.stable_steps(place).min(axis=1)
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
        tall["layer"] = self._tall(map(layers_of_elements, arrays))
        components = zip(*(model.memory for model in self._models), strict=True)
        present = {name: cuda.to_device(values) for name, values in tall.items()}
        whole = Tall(**present, factors=self._factors_on_device[REST])
        return _Resident(
            tall=whole,
            first_factors=self._factors_on_device[FIRST],
            seen=whole._replace(**self._means(), factors=self._factors_on_device[SEEN]),
            memory=tuple(cuda.to_device(self._tall(component)) for component in components),
            boundary=_stacked([model.boundary for model in self._models]),
        )

    @staticmethod
    def _tall(of_members: Iterable[NDArray]) -> NDArray:
        """Fields of elements on top of each other, with a row of no elements above each."""
        return np.concatenate([np.pad(values, ((0, 1), (0, 0))) for values in of_members])

    @property
    def _own_steps(self) -> bool:
        """Whether rows of elements have steps of their own: in all members or in none."""
        return self._models[0].row_steps is not None

    def _means(self) -> dict[str, Any]:
        """Mean velocities of a large step, where rows have steps of their own."""
        steps = [model.row_steps for model in self._models if model.row_steps is not None]
        names = Mean._fields if steps else ()
        return {name: cuda.to_device(np.concatenate([getattr(s, name) for s in steps])) for name in names}

    @cached_property
    def _factors(self) -> NDArray[np.float64]:
        """Prony coefficients as they are on the device: three kinds, by layer."""
        return np.array([np.concatenate([model.arrays.factors for model in self._models])] * 3)

    @cached_property
    def _factors_on_device(self) -> Any:
        return cuda.to_device(self._factors)

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

    def _cooperating(self, kernel: Any, arguments: tuple[Any, ...]) -> tuple[int, int]:
        """Blocks and threads per block that can be on the device together, so that they may wait for each other.

        A multiprocessor has one block, of as many threads as registers allow; fewer do if nodes are few.
        """
        if config.ENABLE_CUDASIM:
            return 1, SIMULATED_THREADS
        nodes = len(self._models) * self._models[0].mesh.X.size
        compiled = kernel.compile(tuple(kernel.typeof_pyval(argument) for argument in arguments))
        threads = compiled.max_threads_per_block // WARP * WARP
        return min(-(-nodes // threads), compiled.max_cooperative_grid_blocks(threads)), threads


def layers_of_elements(a: Arrays) -> NDArray[np.int32]:
    """Layer of each element, which may be one of its row alone, shape [n_rows, n_columns]."""
    start, stop, layer = a.runs.T
    return np.repeat(layer, stop - start).reshape(a.first_run.size - 1, -1).astype(np.int32)


def listed(period: NDArray[np.int64]) -> tuple[NDArray[np.int64], NDArray[np.int64]]:
    """``listed`` and ``due`` of a :class:`~wrinklewave.dynamics.cuda.row_kernels.Timetable`, from its ``period``.

    Periods are powers of two, so all that are due at a tick are shorter than all that are not.
    """
    order = np.argsort(period, axis=None, kind="stable")
    rows = np.column_stack(np.unravel_index(order, period.shape))
    return rows, np.array([(tick % period == 0).sum() for tick in range(MOST)])


def _factors(march: March, model: Model) -> Iterator[NDArray[np.float64]]:
    """Prony coefficients of a member: of the first step of a march, of the rest, and as its survey needs them."""
    a, steps = model.arrays, model.row_steps
    if steps is None or march.counts is None:
        update_factors(a.terms, march.last_dt, march.dt, a.factors)
        yield a.factors
        if march.n > 1:
            update_factors(a.terms, march.dt, march.dt, a.factors)
        yield a.factors
        yield a.factors
        return
    most = int(march.counts[-1])
    numbers = (march.n * most, march.dt / most, most // march.counts, steps.last, a)
    for step in range(2):
        update_factors_of_rows(step, *numbers)
        yield a.factors
    yield seen_over(march.dt, a).factors


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

    def stable_steps_of_rows(self) -> NDArray[np.float64]:
        """The smallest of each row [s]."""
        return self._batch.stable_steps_of_rows(self._place)

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
        launch(own.seen, own.memory, model.terms, slot.nodal, slot.elements)
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
        for name in Mean._fields if model.row_steps is not None else ():
            getattr(own.seen, name).copy_to_host(getattr(model.row_steps, name), stream=stream)
        for component, kept in zip(own.memory, model.memory, strict=True):
            component.copy_to_host(kept, stream=stream)
        stream.synchronize()

    @cached_property
    def _own(self) -> _Resident:
        """Its part of what stays on the device."""
        d, elements = self._batch.resident, self._batch.rows(self._place)
        nodes, layers = slice(elements.start, elements.stop + 1), self._batch.layers(self._place)
        parts = dict.fromkeys(NODAL, nodes) | dict.fromkeys((*BY_LAYER, "factors", "density"), layers)
        parts |= {"forces": nodes, "layer": elements}
        tall, seen = (
            Tall(**{name: getattr(whole, name)[part] for name, part in parts.items()})
            for whole in (d.tall, d.seen)
        )
        return d._replace(tall=tall, seen=seen, memory=tuple(component[elements] for component in d.memory))
