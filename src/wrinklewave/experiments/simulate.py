"""The simulated impact, from a case to a run: fields, surface motion, energies, analysis."""

from __future__ import annotations

import time
from collections.abc import Callable, Generator, Sequence
from contextlib import AbstractContextManager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave.analysis.analyse import analyse
from wrinklewave.analysis.filters import check_cutoff
from wrinklewave.config import Case, load_case
from wrinklewave.dynamics.asking import answered
from wrinklewave.dynamics.checkpoint import read_checkpoint, write_checkpoint
from wrinklewave.dynamics.model import build_model
from wrinklewave.dynamics.simulation import HISTORY, Simulation
from wrinklewave.environment import choose_device, processor
from wrinklewave.errors import InputError, RunError
from wrinklewave.experiments.interruption import Outcome, interruptible
from wrinklewave.experiments.recording import FieldStore, Recording, SurfaceRecorder
from wrinklewave.experiments.run_folder import RunFolder
from wrinklewave.experiments.run_progress import Clock, Progress
from wrinklewave.experiments.run_summary import run_summary
from wrinklewave.experiments.simulated_surface import laboratory_grid, simulated_surface
from wrinklewave.experiments.vtkhdf import FieldFile

if TYPE_CHECKING:
    import xarray as xr
    from numpy.typing import NDArray

    from wrinklewave.analysis.results import Analysis
    from wrinklewave.dynamics.backends import Device, March, Sample
    from wrinklewave.experiments.vtkhdf import FieldFrame
    from wrinklewave.mesh.block import GridMesh


Interruptible = Callable[[], AbstractContextManager[Callable[[], bool]]]
"""Makes a context with a function that tells whether an interrupt has come."""


@dataclass(eq=False)
class Run:
    """A simulation that has ended.

    Args:
        case: as resolved.
        outcome: how it ended.
        history: energies and motion of the struck end against time, columns by name.
        fields: all field frames of a run without a folder; with one they are in ``fields.vtkhdf``.
        snapshots: the field frames nearest to ``analysis.times`` of the case.
        mesh: the undeformed mesh.
        summary: scalar results with units in their names.
        surface: surface motion; None if the run did not finish.
        analysis: of the surface motion; None if the run did not finish.
        folder: where the results are, if anywhere.
    """

    case: Case
    outcome: Outcome
    history: dict[str, NDArray[np.float64]]
    fields: FieldStore
    mesh: GridMesh
    snapshots: list[FieldFrame] = field(default_factory=list)
    summary: dict[str, Any] = field(default_factory=dict)
    surface: xr.Dataset | None = None
    analysis: Analysis | None = None
    folder: Path | None = None


def simulate(
    case: Case | str | Path,
    *,
    out: str | Path | None = None,
    threads: int | None = None,
    device: str = "cpu",
    overrides: Sequence[str] = (),
    resume: bool = False,
    overwrite: bool = False,
    keep_checkpoint: bool = False,
    progress: Callable[[Progress], None] = lambda state: None,
) -> Run:
    """Simulate a case and analyse its surface motion.

    Args:
        case: a case, or the path of a case file.
        out: folder for checkpoints and results; without it everything stays in memory.
        threads: default all cores that this process may use. Results do not depend on it.
        device: ``cpu``, ``cuda``, or ``auto`` for the GPU if there is one. Results do not depend on it beyond rounding.
        overrides: ``"key=value"`` on top of the case file.
        resume: go on from the checkpoint in ``out``, if there is one.
        overwrite: replace an earlier run in ``out``.
        keep_checkpoint: also of a finished run, until its report is written and :meth:`RunFolder.close` is called.
        progress: called now and then.

    Raises:
        InputError: if the case, or what ``out`` holds, does not allow the run.
        RunError: if the simulation cannot go on; what was computed is kept in ``out``.
    """
    case = _resolved(case, overrides)
    threads, chosen = _use_threads(threads), choose_device(device)
    started = start(case, out, threads=threads, device=chosen, resume=resume, overwrite=overwrite)
    running = started.to_the_end(interruptible, progress, keep_checkpoint=keep_checkpoint)
    return answered(running, started.simulation.backend.march)


@dataclass(frozen=True, eq=False)
class Started:
    """A run that can go on: from rest, or from a checkpoint."""

    case: Case
    simulation: Simulation
    recording: Recording
    folder: RunFolder | None
    threads: int

    def to_the_end(
        self,
        interruptible: Interruptible,
        progress: Callable[[Progress], None],
        *,
        keep_checkpoint: bool = False,
    ) -> Generator[March, Sample, Run]:
        """Ask for all marches, and write what they lead to; returns the run.

        Raises:
            RunError: as :func:`simulate`.
        """
        begin = time.perf_counter()
        try:
            with interruptible() as wished, self.recording:
                outcome = yield from _run(self, wished, progress)
        except RunError as error:
            run = self._run(Outcome.FAILED)
            run.summary = self._summary(run, begin) | {"message": str(error)}
            if self.folder:
                self.folder.write_unfinished(run)
                raise RunError(f"{error}\n  {self.folder.describe_checkpoint()}") from error
            raise
        run = self._run(outcome)
        if outcome is Outcome.FINISHED:
            run.surface = simulated_surface(self.case, run.mesh.X[-1], self.recording.surface.to_record())
            run.analysis = analyse(run.surface, self.case.analysis)
            run.snapshots = run.fields.nearest(self.case.analysis.times)
        run.summary = self._summary(run, begin)
        if self.folder:
            self.folder.write_finished(run) if run.surface is not None else self.folder.write_unfinished(run)
            if run.surface is not None and not keep_checkpoint:
                self.folder.close(run)
        return run

    def _run(self, outcome: Outcome) -> Run:
        history, mesh = _history(self.simulation), self.simulation.model.mesh
        place = self.folder.path if self.folder else None
        return Run(self.case, outcome, history, self.recording.fields, mesh, folder=place)

    def _summary(self, run: Run, begin: float) -> dict[str, Any]:
        return run_summary(run, self.simulation, self.threads, time.perf_counter() - begin)


def _resolved(case: Case | str | Path, overrides: Sequence[str]) -> Case:
    if not isinstance(case, Case):
        return load_case(case, overrides)
    return case.overridden(*overrides) if overrides else case


def _use_threads(threads: int | None) -> int:
    available = processor().usable
    if threads is not None and not 1 <= threads <= available:
        raise InputError(
            f"{threads} threads",
            key="threads",
            expected=f"1 to {available}, the cores that this process may use",
        )
    return threads or available


def output_times(interval: float, end: float) -> NDArray[np.float64]:
    """0, interval, ... up to and including ``end`` [s]."""
    return np.append(np.arange(0.0, end - interval * 1e-6, interval), end)


def start(
    case: Case,
    out: str | Path | None,
    *,
    threads: int = 1,
    device: Device = "cpu",
    resume: bool = False,
    overwrite: bool = False,
) -> Started:
    """Make the folder of a run ready and build its model, at rest or in the state of the checkpoint to go on from.

    Raises:
        InputError: if the case, or what the folder holds, does not allow the run.
    """
    check_cutoff(case.analysis.filter_wavelength, laboratory_grid(case)[1])
    folder = RunFolder.prepare(Path(out), case, resume=resume, overwrite=overwrite) if out else None
    end = case.solver.end_time
    surface_times, field_times = (
        np.round(output_times(interval, end), 12)
        for interval in (case.output.surface_interval, case.output.field_interval)
    )
    simulation = Simulation(
        build_model(case, threads=threads),
        np.unique(np.concatenate([surface_times, field_times])),
        safety=case.solver.safety,
        history_interval=case.output.history_interval,
        device=device,
    )
    mesh = simulation.model.mesh
    surface = SurfaceRecorder(mesh, case.wrinkles.averaging_depth)
    if folder and resume and folder.checkpoint.exists():
        surface.restore(read_checkpoint(folder.checkpoint, simulation, case.to_toml()))
        folder.require_fields()
    file = FieldFile(folder.fields, mesh, field_times) if folder else None
    recording = Recording(frozenset(surface_times), surface, FieldStore(field_times, file))
    return Started(case, simulation, recording, folder, threads)


def _run(
    started: Started, wished: Callable[[], bool], progress: Callable[[Progress], None]
) -> Generator[March, Sample, Outcome]:
    case, simulation, recording, folder = started.case, started.simulation, started.recording, started.folder
    saved = time.perf_counter()
    clock = Clock(simulation)

    def save() -> None:
        if folder:
            recording.flush()
            write_checkpoint(folder.checkpoint, simulation, recording.surface.to_record(), case.to_toml())

    while simulation.has_events:
        event = yield from simulation.to_next_event()
        recording.take(event.time, simulation)
        now = time.perf_counter()
        progress(clock.progress())
        if wished():
            save()
            return Outcome.INTERRUPTED
        if now - saved > case.solver.checkpoint_interval:
            save()
            saved = now
    save()  # so that an interrupt while results are written costs none of the steps
    return Outcome.FINISHED


def _history(simulation: Simulation) -> dict[str, NDArray[np.float64]]:
    columns = np.array(simulation.history, dtype=float).reshape(-1, len(HISTORY))
    return dict(zip(HISTORY, columns.T, strict=True))
