"""The measured impact, from a recording to a surface motion and its analysis."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave import surface as surfaces
from wrinklewave.analysis.analyse import analyse
from wrinklewave.config.experiment import Experiment, load_experiment
from wrinklewave.errors import InputError
from wrinklewave.experiments.frame_blocks import BlockStore, MeasuringProgress, measure_frames, origin
from wrinklewave.experiments.impact_moments import find_moments, with_exposure_uncertainty
from wrinklewave.experiments.interruption import Outcome
from wrinklewave.experiments.learning import learn
from wrinklewave.experiments.measured_surface import (
    end_track,
    frame_series,
    laboratory_grid,
    track_columns,
    write_surface,
)
from wrinklewave.experiments.measurement_checks import (
    check_contact,
    check_direction,
    check_early,
    check_frames,
    check_scale,
)
from wrinklewave.experiments.measurement_folder import MeasurementFolder, opened_folder
from wrinklewave.experiments.measurement_summary import (
    measurement_summary,
    scale_warnings,
    surface_attributes,
)
from wrinklewave.imaging.appearance import Appearance
from wrinklewave.imaging.calibration import PixelMap, calibrate
from wrinklewave.imaging.edges.locking import PixelLocking
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.imaging.inspection import grey_warnings, histogram
from wrinklewave.imaging.prepared import PreparedSource, named_as_in_the_recording, open_experiment

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.analysis.results import Analysis

ANALYSED_VALUES = 1_000_000
"""Heights that are analysed at most: of a longer recording the first part after contact."""
FRAMES_BEFORE = 20
SPREAD_TIMES = (0.1, 0.25, 0.7)
"""Times for profiles where the experiment file names none: shares of the time after contact."""


@dataclass(eq=False)
class Measurement:
    """A measurement that has ended.

    Args:
        experiment: as resolved.
        outcome: how it ended.
        summary: scalar results with units in their names.
        warnings: sentences about what makes it less trustworthy than it should be.
        surface: the surface motion; None if the measurement did not finish. Of a long recording, the part that
            was analysed: ``surface.nc`` holds all.
        analysis: of the surface motion; None if the measurement did not finish.
        appearance: of the recording at rest.
        pixels: the calibration; None if the measurement did not finish.
        locking: residuals of single columns against the sub-pixel phase, over all frames.
        folder: where the results are, if anywhere.
    """

    experiment: Experiment
    outcome: Outcome
    appearance: Appearance
    summary: dict[str, Any] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    surface: xr.Dataset | None = None
    analysis: Analysis | None = None
    pixels: PixelMap | None = None
    locking: PixelLocking = field(default_factory=PixelLocking.none)
    folder: Path | None = None


def measure(
    experiment: Experiment | str | Path,
    *,
    out: str | Path | None = None,
    threads: int | None = None,
    overrides: Sequence[str] = (),
    resume: bool = False,
    overwrite: bool = False,
    progress: Callable[[MeasuringProgress], None] = lambda state: None,
) -> Measurement:
    """Measure the recording of an impact and analyse its surface motion.

    Every frame is measured by itself; results depend neither on the number of threads nor on interruptions.

    Args:
        experiment: an experiment, or the path of an experiment file.
        out: folder for the results; without it only what is returned is kept.
        threads: that measure; default all cores that this process may use.
        overrides: ``"key=value"`` on top of the experiment file, if that is given by its path.
        resume: go on with an interrupted measurement in ``out``, if there is one.
        overwrite: replace an earlier measurement in ``out``.
        progress: called now and then.

    Raises:
        InputError: if the experiment file or the recording cannot be used, or ``out`` holds something else.
    """
    experiment = experiment if isinstance(experiment, Experiment) else load_experiment(experiment, overrides)
    if experiment.kind != "impact":
        raise InputError(
            f'kind = "{experiment.kind}"',
            key="experiment.kind",
            expected='"impact"',
            cure="other kinds have procedures of their own",
        )
    begin = time.perf_counter()
    with (
        open_experiment(experiment) as source,
        opened_folder(experiment, out, resume=resume, overwrite=overwrite) as folder,
    ):
        check_early(experiment, source)
        appearance, wires = learn(experiment, source)
        check_scale(experiment, appearance)
        store = folder.blocks(origin(experiment, source))
        measurer = FrameMeasurer(appearance, wires=wires, resolution=experiment.edge.resolution)
        kept = Path(out) if out else None
        if not measure_frames(source, measurer, store, threads, progress):
            return Measurement(experiment, Outcome.INTERRUPTED, appearance, folder=kept)
        found = _evaluate(experiment, source, measurer, store, folder)
        found.folder = kept
        found.summary["wall_time_s"] = time.perf_counter() - begin
        assert found.surface is not None
        folder.write_finished(found.surface, found.summary)
        store.remove()
    return found


def _evaluate(
    experiment: Experiment,
    source: PreparedSource,
    measurer: FrameMeasurer,
    store: BlockStore,
    folder: MeasurementFolder,
) -> Measurement:
    """Surface motion and analysis from measured frames."""
    appearance = measurer.appearance
    series = frame_series(store.blocks(source))
    check_frames(series.frame.size)
    assert source.times is not None  # impacts have a clock
    clock = source.times[series.frame]
    track = end_track(series, clock, experiment.video.undeformed_frames, appearance)
    with named_as_in_the_recording(source):
        pixels = calibrate(experiment, appearance, track.rest)
    check_direction(track, experiment.sample.length / pixels.pixel_size)
    impact = find_moments(track, experiment.contact.time)
    check_contact(impact)
    track = with_exposure_uncertainty(track, impact)
    tracks = write_surface(
        folder.surface,
        blocks=store.blocks(source),
        time=clock - impact.contact.time,
        track=track,
        wires=measurer.wires,
        series=series,
        pixels=pixels,
        grid=laboratory_grid(appearance, pixels, measurer.finder.resolution),
        attrs=surface_attributes(experiment, appearance, pixels, impact),
    )
    folder.write_tracks(track_columns(clock - impact.contact.time, track, tracks, pixels))
    surface = _analysed_part(folder.surface)
    experiment = _with_times(experiment, surface)
    analysis = analyse(surface, experiment.analysis)
    summary, warnings = measurement_summary(
        source, appearance, pixels, series, track, impact, tracks, surface, analysis
    )
    warnings += grey_warnings(source, histogram(source))
    warnings += scale_warnings(experiment, appearance, pixels, track.rest)
    return Measurement(
        experiment,
        Outcome.FINISHED,
        appearance,
        summary=summary,
        warnings=warnings,
        surface=surface,
        analysis=analysis,
        pixels=pixels,
        locking=series.locking,
    )


def _analysed_part(path: Path) -> xr.Dataset:
    """The surface motion, or as much of it as memory is meant for: a little before contact and what follows."""
    import xarray as xr

    with xr.open_dataset(path, engine="h5netcdf") as whole:
        n_times = max(ANALYSED_VALUES // whole.sizes["x"], 2)
        first = 0
        if whole.sizes["time"] > n_times:
            first = max(int(np.searchsorted(whole["time"].values, 0.0)) - FRAMES_BEFORE, 0)
        part = whole.isel(time=slice(first, first + n_times)).load()
    return surfaces.check(part, source=path)


def _with_times(experiment: Experiment, surface: xr.Dataset) -> Experiment:
    """The experiment with times for profiles, if it names none."""
    if experiment.analysis.times:
        return experiment
    last = float(surface["time"].values[-1])
    times = tuple(float(f"{share * last:.3g}") for share in SPREAD_TIMES)
    return experiment.model_copy(update={"analysis": experiment.analysis.model_copy(update={"times": times})})
