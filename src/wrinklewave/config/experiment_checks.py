"""What an experiment must fulfil as a whole, once every value by itself is right."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from wrinklewave.config.experiment import Experiment


def experiment_errors(experiment: Experiment) -> Iterator[InputError]:
    """Yield an error for everything in ``experiment`` that does not fit together."""
    yield from _files(experiment)
    yield from _ranges(experiment)
    yield from _kind(experiment)
    yield from _windows(experiment)


def _files(experiment: Experiment) -> Iterator[InputError]:
    files = {"video.file": experiment.video.file}
    if experiment.second_series:
        files["second_series.file"] = experiment.second_series.file
    for key, file in files.items():
        if not file.exists():
            yield InputError(
                f"there is no {file}",
                key=key,
                expected="a recording, its path relative to the experiment file",
                cure="check the path",
            )


def _ranges(experiment: Experiment) -> Iterator[InputError]:
    ranges = {
        "video.frames": experiment.video.frames,
        "region.columns": experiment.region.columns,
        "region.rows": experiment.region.rows,
    }
    for key, bounds in ranges.items():
        if bounds is not None and not 0 <= bounds[0] < bounds[1]:
            yield InputError(
                f"{list(bounds)} is empty",
                key=key,
                expected="the first, counted from 0, and the one after the last",
                cure="swap or change them",
            )
    frames, undeformed = experiment.video.frames, experiment.video.undeformed_frames
    if frames is not None and undeformed > frames[1] - frames[0] > 0:
        yield InputError(
            f"{undeformed} of {frames[1] - frames[0]} frames",
            key="video.undeformed_frames",
            expected="fewer than video.frames holds",
            cure="lower it",
        )


def _kind(experiment: Experiment) -> Iterator[InputError]:
    if experiment.kind == "impact" and experiment.second_series:
        yield _misplaced("second_series", "quasi-static")
    if experiment.kind == "impact" and experiment.fit:
        yield _misplaced("fit", "quasi-static")
    if experiment.kind == "quasi-static" and experiment.wires:
        yield _misplaced("wires", "impact")
    if experiment.kind == "quasi-static" and experiment.contact.time is not None:
        yield _misplaced("contact", "impact")


def _misplaced(section: str, kind: str) -> InputError:
    return InputError(
        "has no meaning in this kind of experiment",
        key=section,
        expected=f'[{section}] only with experiment.kind = "{kind}"',
        cure=f"remove [{section}], or change experiment.kind",
    )


def _windows(experiment: Experiment) -> Iterator[InputError]:
    if experiment.fit and not experiment.fit.strains[0] < experiment.fit.strains[1]:
        yield InputError(
            f"{list(experiment.fit.strains)} is empty",
            key="fit.strains",
            expected="the smallest strain, then the largest",
            cure="swap or change them",
        )
    length = experiment.sample.length
    for name in ("front_window", "amplitude_window"):
        low, high = getattr(experiment.analysis, name)
        if not low < high <= length * (1 + 1e-9):
            yield InputError(
                f"{low * 1e3:.6g} mm to {high * 1e3:.6g} mm does not lie on the sample",
                key=f"analysis.{name}",
                expected=f"the smaller value, then the larger, within {length * 1e3:.6g} mm",
                cure="change them",
            )
