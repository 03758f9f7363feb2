"""What is learnt of a recording before it is measured: how the sample and its wires look at rest."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.errors import InputError
from wrinklewave.imaging.appearance import Appearance, learn_appearance
from wrinklewave.imaging.compiling import compile_kernels
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.imaging.prepared import PreparedSource, named_as_in_the_recording
from wrinklewave.imaging.wires import WireLook, learn_wires

if TYPE_CHECKING:
    from wrinklewave.config.experiment import Experiment
    from wrinklewave.imaging.frames import Image

LEARNT_BYTES = 100e6
MOST_LEARNT, FEWEST_LEARNT = 32, 4
"""Frames that say what the sample looks like at rest: so many bytes and at most so many, spread over all that do."""
OTHER_FRAMES = 24
MOVED = 1.0
"""Pixels by which the struck end of a sample at rest may move."""


def learn(experiment: Experiment, source: PreparedSource) -> tuple[Appearance, WireLook | None]:
    """What the sample and its wires look like at rest, from the undeformed frames and some others."""
    compile_kernels()
    size = source.shape[0] * source.shape[1] * 4
    most = int(np.clip(LEARNT_BYTES / size, FEWEST_LEARNT, MOST_LEARNT))
    undeformed = _spread(source, experiment.video.undeformed_frames, most)
    if not undeformed:
        raise InputError(
            "none of the undeformed frames can be read",
            key="video.undeformed_frames",
            expected="at least one whole frame of the sample at rest at the beginning of the recording",
            cure="begin later with video.frames",
        )
    others = _spread(source, source.n_frames, min(most, OTHER_FRAMES))
    with named_as_in_the_recording(source):
        _check_at_rest(undeformed, others, experiment.video.undeformed_frames)
        appearance = learn_appearance(undeformed, others)
    if experiment.wires is None:
        return appearance, None
    mean = np.asarray(np.mean(undeformed, axis=0, dtype=np.float64), dtype=np.float32)
    given = experiment.wires.positions
    places = None if given is None else np.array([source.position(place)[0] for place in given])
    names = [f"[{column:g}, {row:g}]" for column, row in given or ()]
    count = experiment.wires.count
    return appearance, learn_wires(mean, appearance, count=count, positions=places, names=names)


def _check_at_rest(undeformed: Sequence[Image], others: Sequence[Image], n_frames: int) -> None:
    """Whether the struck end is in the same place in all undeformed frames; those learnt from, spread evenly."""
    look = learn_appearance(undeformed[:1], others)
    measurer = FrameMeasurer(look)
    ends = [measurer.measure(image).end for image in undeformed]
    columns = np.array(
        [end.column if end.gain > 0.0 or not np.isfinite(end.touch) else end.touch for end in ends]
    )
    moved = np.flatnonzero(np.abs(columns - columns[0]) > MOVED)
    if moved.size:
        frame = round(moved[0] * (n_frames - 1) / (len(undeformed) - 1))
        raise InputError(
            f"{n_frames}, but in frame {frame} the struck end has moved by "
            f"{columns[moved[0]] - columns[0]:+.1f} px",
            key="video.undeformed_frames",
            expected="how many frames at the beginning show the sample at rest",
            cure=f"lower it to {frame} or fewer",
        )


def _spread(source: PreparedSource, stop: int, most: int) -> list[Image]:
    """Up to ``most`` readable frames spread evenly over the first ``stop`` ones."""
    wanted = np.unique(np.linspace(0, stop - 1, min(most, stop)).round().astype(int))
    return [image for index in wanted for _, image in source.frames(int(index), int(index) + 1)]
