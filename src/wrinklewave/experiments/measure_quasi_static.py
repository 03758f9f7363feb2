"""The measured quasi-static test, from series of images to critical strain and wavelength."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave import surface as surfaces
from wrinklewave.config.experiment import Experiment, load_experiment
from wrinklewave.environment import versions
from wrinklewave.errors import InputError
from wrinklewave.experiments.frame_blocks import BlockStore, MeasuringProgress, measure_frames, origin
from wrinklewave.experiments.interruption import Outcome
from wrinklewave.experiments.learning import learn
from wrinklewave.experiments.measured_surface import end_track, frame_series, laboratory_grid, write_surface
from wrinklewave.experiments.measurement_folder import opened_folder
from wrinklewave.experiments.measurement_summary import scale_warnings, surface_attributes
from wrinklewave.experiments.quasi_static_test import (
    ALL_STRAINS,
    QuasiStaticTest,
    quasi_static_test,
    series_columns,
)
from wrinklewave.experiments.run_folder import write_history
from wrinklewave.imaging.calibration import PixelMap, calibrate
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.imaging.inspection import grey_warnings, histogram
from wrinklewave.imaging.prepared import PreparedSource, named_as_in_the_recording, open_experiment

if TYPE_CHECKING:
    import xarray as xr

FEWEST_IMAGES = 4


@dataclass(frozen=True)
class MeasuredSeries:
    """One series of images, measured.

    Attributes:
        experiment: with the series' own recording and calibration.
        surface: the surface motion; its times are the camera's, or count the images.
        images: which image of the recording each time is, shape [n_images].
        pixels: the calibration.
        warnings: sentences.
    """

    experiment: Experiment
    surface: xr.Dataset
    images: np.ndarray
    pixels: PixelMap
    warnings: tuple[str, ...]


@dataclass(eq=False)
class QuasiStaticMeasurement:
    """A quasi-static test that has been measured.

    Args:
        experiment: as resolved.
        outcome: how it ended.
        series: the first test and, if there was one, the second; empty if the measurement did not finish.
        test: what they tell; None if the measurement did not finish.
        summary: scalar results with units in their names.
        warnings: sentences about what makes it less trustworthy than it should be.
        folder: where the results are, if anywhere.
    """

    experiment: Experiment
    outcome: Outcome
    series: tuple[MeasuredSeries, ...] = ()
    test: QuasiStaticTest | None = None
    summary: dict[str, Any] = field(default_factory=dict)
    warnings: list[str] = field(default_factory=list)
    folder: Path | None = None


def measure_quasi_static(
    experiment: Experiment | str | Path,
    *,
    out: str | Path | None = None,
    threads: int | None = None,
    overrides: Sequence[str] = (),
    resume: bool = False,
    overwrite: bool = False,
    progress: Callable[[MeasuringProgress], None] = lambda state: None,
) -> QuasiStaticMeasurement:
    """Measure the images of a slow compression, and of a second one on the same sample if the experiment names it.

    Args:
        experiment: an experiment of the kind "quasi-static", or the path of its file.
        out: folder for the results; without it only what is returned is kept.
        threads: that measure; default all cores that this process may use.
        overrides: ``"key=value"`` on top of the experiment file, if that is given by its path.
        resume: go on with an interrupted measurement in ``out``, if there is one.
        overwrite: replace an earlier measurement in ``out``.
        progress: called now and then.

    Raises:
        InputError: if the experiment file or a recording cannot be used, or ``out`` holds something else.
    """
    experiment = experiment if isinstance(experiment, Experiment) else load_experiment(experiment, overrides)
    if experiment.kind != "quasi-static":
        raise InputError(f'kind = "{experiment.kind}"', key="experiment.kind", expected='"quasi-static"')
    with opened_folder(experiment, out, resume=resume, overwrite=overwrite) as folder:
        kept = Path(out) if out else None
        series, stores = [], []
        for prefix, one in zip(_PREFIXES, _experiments(experiment), strict=False):
            with open_experiment(one) as source:
                appearance, _ = learn(one, source)
                store = folder.blocks(origin(one, source), prefix)
                measurer = FrameMeasurer(appearance, wires=None, resolution=one.edge.resolution)
                if not measure_frames(source, measurer, store, threads, progress):
                    return QuasiStaticMeasurement(experiment, Outcome.INTERRUPTED, folder=kept)
                surface = folder.path / f"{prefix}surface.nc"
                series.append(_measured_series(one, source, measurer, store, surface))
                stores.append(store)
        found = _evaluated(experiment, tuple(series), kept)
        assert found.test is not None
        for number, test in enumerate(found.test.tests):
            write_history(folder.path / f"{_PREFIXES[number]}series.csv", series_columns(test))
        folder.write_summary(found.summary)
        for store in stores:
            store.remove()
    return found


_PREFIXES = ("", "second_")


def _experiments(experiment: Experiment) -> Iterator[Experiment]:
    """The first test, and the second as an experiment of its own."""
    yield experiment
    if experiment.second_series:
        video = experiment.video.model_copy(update={"file": experiment.second_series.file, "frames": None})
        changes = {"video": video, "calibration": experiment.second_calibration, "second_series": None}
        yield experiment.model_copy(update=changes)


def _measured_series(
    experiment: Experiment, source: PreparedSource, measurer: FrameMeasurer, store: BlockStore, path: Path
) -> MeasuredSeries:
    """One series' surfaces, from measured images, written to ``path``."""
    appearance = measurer.appearance
    frames = frame_series(store.blocks(source))
    if frames.frame.size < FEWEST_IMAGES:
        raise InputError(
            f"{frames.frame.size} images that can be read",
            file=experiment.video.file,
            expected=f"at least {FEWEST_IMAGES}: the undeformed sample and the sample compressed more and more",
        )
    clock = frames.frame.astype(float) if source.times is None else source.times[frames.frame]
    track = end_track(frames, clock, experiment.video.undeformed_frames, appearance)
    with named_as_in_the_recording(source):
        pixels = calibrate(experiment, appearance, track.rest)
    write_surface(
        path,
        blocks=store.blocks(source),
        time=clock,
        track=track,
        wires=None,
        series=frames,
        pixels=pixels,
        grid=laboratory_grid(appearance, pixels, measurer.finder.resolution),
        attrs=surface_attributes(experiment, appearance, pixels) | {"procedure": "quasi-static"},
    )
    warnings = (
        *source.notes,
        *grey_warnings(source, histogram(source)),
        *scale_warnings(experiment, appearance, pixels, track.rest),
    )
    return MeasuredSeries(experiment, surfaces.read(path), frames.frame, pixels, warnings)


def _evaluated(
    experiment: Experiment, series: tuple[MeasuredSeries, ...], folder: Path | None
) -> QuasiStaticMeasurement:
    test = quasi_static_test(
        series[0].surface,
        experiment.analysis,
        second=series[1].surface if len(series) > 1 else None,
        undeformed_images=experiment.video.undeformed_frames,
        strains=experiment.fit.strains if experiment.fit else ALL_STRAINS,
    )
    summary: dict[str, Any] = {
        "name": experiment.name,
        "outcome": "finished",
        "message": "finished",
        **test.summary,
        "pixel_size_m": series[0].pixels.pixel_size,
        "surface_sigma_px": _surface_sigma(series[0]),
        "versions": versions(),
    }
    warnings = [warning for one in series for warning in one.warnings]
    return QuasiStaticMeasurement(
        experiment, Outcome.FINISHED, series, test, summary, [*test.warnings, *warnings], folder
    )


def _surface_sigma(series: MeasuredSeries) -> float:
    return float(np.nanmedian(series.surface["u_y_sigma"].values)) / series.pixels.pixel_size
