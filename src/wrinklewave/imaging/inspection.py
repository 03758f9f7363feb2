"""What a recording holds, and what a user should know before measuring with it."""

from __future__ import annotations

import os
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from wrinklewave.imaging.frames import FrameSource

SAMPLED_FRAMES = 24
CLIPPED_SHARE = 1e-3
"""Share of pixels at an end of the scale from which on a histogram is called clipped."""


@dataclass(frozen=True)
class Histogram:
    """How often each grey value occurs in a sample of frames.

    Attributes:
        counts: shape [number of grey values].
        white_level: grey value at which the recording clips.
    """

    counts: NDArray[np.int64]
    white_level: int

    @property
    def darkest(self) -> int:
        """Smallest grey value that occurs."""
        return int(np.flatnonzero(self.counts)[0])

    @property
    def brightest(self) -> int:
        """Largest grey value that occurs."""
        return int(np.flatnonzero(self.counts)[-1])

    @property
    def black_share(self) -> float:
        """Share of pixels at zero: their light is unknown."""
        return float(self.counts[0] / self.counts.sum())

    @property
    def white_share(self) -> float:
        """Share of pixels at the white level or above: their light is unknown."""
        return float(self.counts[self.white_level :].sum() / self.counts.sum())

    @property
    def unused_low_bits(self) -> int:
        """How many of the lowest bits are never set: a depth that was shifted up."""
        used = int(np.bitwise_or.reduce(np.flatnonzero(self.counts)))
        return (used & -used).bit_length() - 1 if used else 0


def histogram(source: FrameSource, sampled_frames: int = SAMPLED_FRAMES) -> Histogram:
    """Grey values of frames spread evenly over the recording; damaged ones are left out."""
    counts = np.zeros(1 << (8 * source.dtype.itemsize), dtype=np.int64)
    for _, image in source.frames(step=max(1, source.n_frames // sampled_frames)):
        counts += np.bincount(image.reshape(-1), minlength=counts.size)
    return Histogram(counts, source.white_level)


def grey_warnings(source: FrameSource, grey: Histogram) -> Iterator[str]:
    """Sentences about clipping and about a bit depth that does not fit the grey values."""
    if grey.brightest >> source.bit_depth:
        yield f"a grey value of {grey.brightest} does not fit in {source.bit_depth} bits: is the file damaged?"
    if grey.white_share > CLIPPED_SHARE:
        yield f"{grey.white_share:.2%} of the pixels are clipped at white ({grey.white_level}): expose less"
    if grey.black_share > CLIPPED_SHARE:
        yield f"{grey.black_share:.2%} of the pixels are clipped at zero: add light, or raise the black level"
    shift = grey.unused_low_bits
    if source.bit_depth > 8 and shift >= 2:
        yield (
            f"all grey values are multiples of {1 << shift}: "
            f"{source.bit_depth - shift} significant bits, stored in the upper ones"
        )
    needed = max(8, grey.brightest.bit_length())
    if source.bit_depth - needed >= 2 and shift == 0:
        yield (
            f"no grey value is above {grey.brightest}: if the camera has {needed} bits, "
            f"set video.bit_depth = {needed}, or clipping goes unnoticed"
        )


def facts(source: FrameSource, grey: Histogram) -> dict[str, str]:
    """What a recording holds, as a table for people."""
    height, width = source.shape
    damaged = ", ".join(f"{index} ({why})" for index, why in source.unreadable[:5])
    more = f" and {len(source.unreadable) - 5} more" if len(source.unreadable) > 5 else ""
    return {
        "recording": str(source.path or source.description),
        "format": source.description,
        "frames": str(source.n_frames),
        "size": f"{width} x {height} pixels",
        "bit depth": f"{source.bit_depth} (black {source.black_level}, white {source.white_level})",
        "grey values": f"{grey.darkest} to {grey.brightest}",
        "frame rate": _rate(source),
        "times": _times(source),
        "unreadable": damaged + more or "none",
    }


def suggested_experiment(source: FrameSource, folder: Path) -> str:
    """Text of an experiment file for this recording, to be put into ``folder``.

    What only the experimenter knows is left as comments: read as it is, the file gives one error for each.
    """
    assert source.path is not None
    file = os.path.relpath(source.path, folder).replace(os.sep, "/")
    if source.clock == "camera" and source.frame_rate:
        rate = f'# frame_rate = "{source.frame_rate:.9g} Hz"   # leave out: the recording has its own times'
    else:
        why = "the file only knows how fast to play it" if source.frame_rate else "it is not in the file"
        rate = f'# frame_rate = "50 kHz"   # GIVE the camera\'s: {why}'
    undeformed = max(1, min(10, source.n_frames // 4))
    return TEMPLATE.format(name=source.path.stem, file=file, frame_rate=rate, undeformed=undeformed)


def _rate(source: FrameSource) -> str:
    if source.frame_rate is None:
        return "not in the file: give video.frame_rate"
    if source.clock == "camera":
        return f"{source.frame_rate:.6g} per second"
    return f"{source.frame_rate:.6g} per second for playback, not the camera's: give video.frame_rate"


def _times(source: FrameSource) -> str:
    if source.times is None or source.clock != "camera":
        return "not in the file"
    return f"{source.times[0] * 1e3:.6g} ms to {source.times[-1] * 1e3:.6g} ms"


TEMPLATE = """\
# Suggested by `wrinklewave inspect`. GIVE what is marked so: remove the # and write your own value.
# Positions are [column, row] in pixels of the recording, [0, 0] in the upper left corner.

[experiment]
kind = "impact"               # or "quasi-static"
name = "{name}"

[video]
file = "{file}"
{frame_rate}
undeformed_frames = {undeformed}        # how many frames at the beginning show the sample at rest

[calibration]
# GIVE which way things are in the image: "right", "left", "up" or "down"
# x_axis = "right"            # from the struck end to the held end
# y_axis = "up"               # out of the sample
# GIVE one of three ways to know the scale
# kind = "scale"
# pixel_size = "50 um"
# kind = "two-points"
# points = [[100, 80], [1100, 80]]
# distance = "50 mm"
# kind = "sample-length"      # sample.length, seen in the first frame

[sample]
# length = "50.4 mm"          # GIVE the undeformed length along x
# height = "37 mm"
# critical_strain = 0.043     # of the film, if known
# critical_wavelength = "2.0 mm"

[contact]
time = "detect"               # or a time on the recording's clock

# [region]                    # look at this part of the image only
# columns = [0, 1000]
# rows = [0, 200]

# [wires]                     # probe wires to follow
# count = 3                   # or positions = [[300, 70], [500, 70]]
"""
