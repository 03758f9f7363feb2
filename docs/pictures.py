"""Pictures of README and pages: ``python docs/pictures.py runs/paper_impact runs/measured``.

From the paper's run, and from the measurement of the quick start.
"""

import shutil
import sys
from pathlib import Path

from PIL import Image

IMAGES = Path(__file__).parent / "images"
PICTURES = {
    "displacement": "fig_2c_displacement",
    "wrinkles": "fig_4b_wrinkles",
    "energy_balance": "energy_balance",
}
FRAMES, SHOWN = 6, (1, 2)
"""Frames one below the other in the picture of a measurement, and which of them README shows."""


def copy_figures(run: Path) -> None:
    """The run's figures, as they are."""
    for name, figure in PICTURES.items():
        shutil.copyfile(run / "figures" / f"{figure}.png", IMAGES / f"{name}.png")


def shrink_detections(measurement: Path) -> None:
    """Two of the frames with what was detected in them, small enough for README."""
    with Image.open(measurement / "figures" / "detections.png") as picture:
        each = picture.height / FRAMES
        first, last = SHOWN[0] * each, (SHOWN[-1] + 1) * each
        part = picture.convert("RGB").crop((0, round(first), picture.width, round(last)))
    small = part.resize((1000, round(1000 * part.height / part.width)), Image.Resampling.LANCZOS)
    small.save(IMAGES / "measured.jpg", quality=80, subsampling=0)  # noise makes large PNG files


if __name__ == "__main__":
    IMAGES.mkdir(exist_ok=True)
    copy_figures(Path(sys.argv[1]))
    shrink_detections(Path(sys.argv[2]))
