"""Copies the pictures of README and pages from the paper's run: ``python docs/pictures.py runs/paper_impact``."""

import shutil
import sys
from pathlib import Path

PICTURES = {
    "displacement": "fig_2c_displacement",
    "wrinkles": "fig_4b_wrinkles",
    "energy_balance": "energy_balance",
}

if __name__ == "__main__":
    target = Path(__file__).parent / "images"
    target.mkdir(exist_ok=True)
    for name, figure in PICTURES.items():
        shutil.copyfile(Path(sys.argv[1]) / "figures" / f"{figure}.png", target / f"{name}.png")
