"""How fast frames are measured once they have been read: frames per second, and what their parts take.

    python benchmarks/measuring_speed.py [--frames N] [--threads N]

A synthetic impact of 1280 x 256 px and 12 bit with striker and three wires is rendered first. Beside the rate stands
its ratio to a yardstick of the same machine: a Gaussian blur of the same frames (``scipy.ndimage``, blur 1.2 px), one
thread.
"""

from __future__ import annotations

import argparse
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import numpy as np
from scipy.ndimage import gaussian_filter

from wrinklewave.imaging.appearance import learn_appearance
from wrinklewave.imaging.camera import Camera, Striker, Wires, film
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.imaging.frames import Image
from wrinklewave.imaging.wires import learn_wires
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

SHAPE = (256, 1280)
SCALE = 24e3
UNDEFORMED = 8
REPEATS = 3


def main() -> None:
    """Render, measure, print."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--frames", type=int, default=96)
    parser.add_argument("--threads", type=int, default=2)
    arguments = parser.parse_args()
    frames = recording(arguments.frames)
    measurer = measurer_of(frames)
    measurer.measure(frames[-1])  # compiles
    blur = rate(lambda: [gaussian_filter(np.float32(image), 1.2) for image in frames[:16]], 16)
    print(
        f"{len(frames)} frames of {SHAPE[1]} x {SHAPE[0]} px, 12 bit; a Gaussian blur alone: {blur:.0f} frames/s"
    )
    for threads in sorted({1, arguments.threads}):
        with ThreadPoolExecutor(threads) as pool:
            found = rate(lambda pool=pool: list(pool.map(measurer.measure, frames)), len(frames))
        print(f"measured, {threads} thread(s): {found:.0f} frames/s, {found / blur:.2f} of the blur's rate")


def recording(n_frames: int) -> list[Image]:
    """Frames spread over an impact, the first ones at rest."""
    surface = TravellingPulse(interval=20e-6, end_time=3e-3).surface()
    camera = Camera(shape=SHAPE, scale=SCALE, origin=(36.0, 170.0)).at_contrast_to_noise(20.0)
    times = np.append(
        np.linspace(-0.1e-3, -0.02e-3, UNDEFORMED), np.linspace(0.0, 3e-3, n_frames - UNDEFORMED)
    )
    scene = film(
        surface,
        camera,
        striker=Striker(velocity=10.0, stop_distance=6e-3),
        wires=Wires(X=(12e-3, 25e-3, 38e-3)),
        times=times,
    )
    return [scene.frame(index) for index in range(scene.n_frames)]


def measurer_of(frames: list[Image]) -> FrameMeasurer:
    """What the frames look like at rest, learnt."""
    appearance = learn_appearance(frames[:UNDEFORMED], frames[UNDEFORMED::8])
    mean = np.mean(frames[:UNDEFORMED], axis=0, dtype=np.float64).astype(np.float32)
    return FrameMeasurer(appearance, wires=learn_wires(mean, appearance, count=3))


def rate(work: Callable[[], object], n_frames: int) -> float:
    """Frames per second, the best of a few tries: other work on the machine only ever slows down."""
    best = np.inf
    for _ in range(REPEATS):
        begin = time.perf_counter()
        work()
        best = min(best, time.perf_counter() - begin)
    return n_frames / best


if __name__ == "__main__":
    main()
