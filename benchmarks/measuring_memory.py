"""How much memory a measurement takes, for recordings of two lengths: what a longer one takes must not be more.

    python benchmarks/measuring_memory.py [--frames N] [--folder DIR]

Recordings of N and 2 N frames of 1280 x 256 px are written (an impact, then the sample after it) and measured by the
command line, each in a process of its own whose largest resident memory is read from the operating system. What that
means for a recording of 20 GB is extrapolated from the difference.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

from measuring_speed import SHAPE, UNDEFORMED, recording

from wrinklewave.imaging.frames import FrameSource, Image
from wrinklewave.imaging.writing import write_recording

EXPERIMENT = """
experiment = {{ kind = "impact", name = "{name}" }}
video = {{ file = "{name}.tif", undeformed_frames = {undeformed}, frame_rate = "32 kHz" }}
calibration = {{ kind = "scale", pixel_size = "41.6667 um", x_axis = "right", y_axis = "up" }}
sample = {{ length = "50.4 mm", height = "37 mm", critical_strain = 0.043, critical_wavelength = "2 mm" }}
wires = {{ count = 3 }}
"""
GIGABYTES = 20


class Prolonged(FrameSource):
    """Some frames, and then the last of them again and again."""

    def __init__(self, frames: list[Image], n_frames: int) -> None:
        super().__init__()
        self._some, self.n_frames, self.shape = frames, n_frames, SHAPE
        self.bit_depth, self.white_level, self.frame_rate, self.description = 12, 4095, 32e3, "prolonged"

    def _read(self, index: int) -> Image:
        return self._some[min(index, len(self._some) - 1)]


def main() -> None:
    """Write, measure, print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--frames", type=int, default=2500)
    parser.add_argument("--folder", type=Path, default=Path("runs/measuring-memory"))
    arguments = parser.parse_args()
    arguments.folder.mkdir(parents=True, exist_ok=True)
    some = recording(104)
    peaks = {}
    for n_frames in (arguments.frames, 2 * arguments.frames):
        peaks[n_frames] = measured(Prolonged(some, n_frames), arguments.folder)
        size = n_frames * SHAPE[0] * SHAPE[1] * 2
        print(f"{n_frames} frames, {size / 1e9:.2f} GB: at most {peaks[n_frames]:.0f} MB")
    short, long = peaks.values()
    growth = (long - short) / (arguments.frames * SHAPE[0] * SHAPE[1] * 2 / 1e9)
    print(
        f"growth: {growth:+.1f} MB per GB of frames, {GIGABYTES * max(growth, 0.0):.0f} MB over {GIGABYTES} GB"
    )


def measured(source: FrameSource, folder: Path) -> float:
    """Largest resident memory of the process that measures a recording [MB]."""
    name = f"prolonged-{source.n_frames}"
    video, experiment = folder / f"{name}.tif", folder / f"{name}.toml"
    write_recording(source, video)
    experiment.write_text(EXPERIMENT.format(name=name, undeformed=UNDEFORMED), "utf-8")
    command = [
        sys.executable,
        "-m",
        "wrinklewave",
        "measure",
        str(experiment),
        "--out",
        str(folder / name),
        "--overwrite",
    ]
    process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(process.pid, 0)
    video.unlink()
    if status != 0:
        raise SystemExit(f"{' '.join(command)} failed")
    return usage.ru_maxrss / 1e3


if __name__ == "__main__":
    main()
