"""What would spoil a measurement, and is better said before all frames are measured, or before they are evaluated."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.filters import check_cutoff
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from wrinklewave.config.experiment import Experiment
    from wrinklewave.experiments.impact_moments import EndTrack, Impact
    from wrinklewave.imaging.appearance import Appearance
    from wrinklewave.imaging.prepared import PreparedSource

FEWEST_FRAMES = 4
WRONG_SCALE = 0.25
"""Relative difference between the length that is seen and the one that is given that can only be a mistake."""
ASTRAY = 0.2
"""Share of frames in which the struck end may be taken for something else, and of the length by which it is astray."""


def check_early(experiment: Experiment, source: PreparedSource) -> None:
    """Whether the experiment file suits the recording: its filter, its number of frames, its time of contact.

    Raises:
        InputError: if not.
    """
    if experiment.calibration.kind != "sample-length":
        check_cutoff(experiment.analysis.filter_wavelength, experiment.calibration.pixel_size)
    check_frames(source.n_frames)
    contact = experiment.contact.time
    assert source.times is not None  # impacts have a clock
    first, last = source.times[0], source.times[-1]
    if contact is not None and not first < contact < last:
        raise InputError(
            f"{1e3 * contact:g} ms is not within the frames used",
            key="contact.time",
            expected=f"after {1e3 * first:.6g} ms and before {1e3 * last:.6g} ms, on the recording's clock",
            cure='correct it, or have it found: time = "detect"',
        )


def check_frames(n_frames: int) -> None:
    """Whether there are frames enough for a surface motion.

    Raises:
        InputError: if not.
    """
    if n_frames < FEWEST_FRAMES:
        raise InputError(
            f"too few frames that can be used: {n_frames}",
            key="video.frames",
            expected=f"{FEWEST_FRAMES} at least: the sample at rest, and what follows",
            cure="use more of the recording, or another one",
        )


def check_scale(experiment: Experiment, appearance: Appearance) -> None:
    """Whether the undeformed sample is roughly as long in the images as it is said to be.

    Raises:
        InputError: if not; small differences are warned of later.
    """
    if experiment.calibration.kind == "sample-length":
        return
    columns = (appearance.held_end - appearance.struck_end) * np.hypot(1.0, appearance.line[1])
    seen = columns * experiment.calibration.pixel_size
    if np.isfinite(seen) and abs(seen / experiment.sample.length - 1.0) > WRONG_SCALE:
        raise InputError(
            f"in the undeformed images the sample is {1e3 * seen:.4g} mm long ({columns:.0f} px), "
            f"not {1e3 * experiment.sample.length:.4g} mm",
            key="calibration",
            expected=f"a scale by which it is as long as sample.length says, to {WRONG_SCALE:.0%} at least",
            cure="correct one of the two; give region if something else is taken for an end of the sample",
        )


def check_direction(track: EndTrack, length: float) -> None:
    """Whether the struck end stays where one of a sample of this ``length`` [px] can be.

    Raises:
        InputError: if not.
    """
    way = (track.column - track.rest)[np.isfinite(track.column)] / length
    astray = (way < -ASTRAY) | (way > 0.5 + ASTRAY)
    if astray.mean() > ASTRAY:
        raise InputError(
            f"in {astray.mean():.0%} of the frames the struck end is seen at {np.median(way[astray]):.0%} "
            "of the sample's length",
            key="calibration.x_axis",
            expected="the direction in the image from the struck to the held end",
            cure="turn it if the striker comes from the other side; give region if something stands before the sample",
        )


def check_contact(impact: Impact) -> None:
    """Whether there is an impact at all.

    Raises:
        InputError: if not.
    """
    if not np.isfinite(impact.contact.time):
        raise InputError(
            "no contact is seen: neither does a striker touch, nor does the struck end move",
            key="contact.time",
            expected="an impact within the frames used",
            cure='give it, as in time = "1.2 ms" on the recording\'s clock, or check video.frames',
        )
