"""Kill a simulation at random moments and resume it: the results must equal those of an undisturbed run, bit for bit.

    python benchmarks/random_kills.py [--kills 20] [--seed 0]

Each trial starts the quick case in a process of its own, kills it (SIGKILL) after a random time, resumes it, kills it
again with probability one half, and so on until it ends. Every array and number of the results is then compared; only
wall-clock times may differ.
"""

from __future__ import annotations

import argparse
import json
import random
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import h5py
import numpy as np

CASE = Path(__file__).parents[1] / "examples" / "quick.toml"
SETTINGS = ("solver.checkpoint_interval=0.02 s", "mesh.elements=[100, 37]", "output.field_interval=20 us")
CLOCK = {"wall_time_s", "stepping_time_s", "element_updates_per_s"}


def command(folder: Path, *, resume: bool) -> list[str]:
    """The command line of a run."""
    if resume and (folder / "case.toml").exists():
        return [sys.executable, "-m", "wrinklewave", "restart", str(folder)]
    settings = [word for setting in SETTINGS for word in ("--set", setting)]
    return [sys.executable, "-m", "wrinklewave", "simulate", str(CASE), "--out", str(folder), *settings]


def contents(folder: Path) -> dict[str, object]:
    """All that a run has written, but for wall-clock times."""
    found: dict[str, object] = {"history": (folder / "history.csv").read_text()}
    summary = json.loads((folder / "summary.json").read_text())
    found["summary"] = {name: value for name, value in summary.items() if name not in CLOCK}
    for name in ("surface.nc", "fields.vtkhdf"):
        with h5py.File(folder / name) as file:
            file.visititems(lambda key, item, name=name: found.update(_dataset(f"{name}/{key}", item)))
    return found


def _dataset(key: str, item: h5py.Dataset | h5py.Group) -> dict[str, bytes]:
    return {key: np.ascontiguousarray(item[()]).tobytes()} if isinstance(item, h5py.Dataset) else {}


def trial(folder: Path, longest: float, generator: random.Random) -> int:
    """Run with kills until the end; returns their number."""
    kills = 0
    while True:
        process = subprocess.Popen(
            command(folder, resume=kills > 0), stdout=subprocess.DEVNULL, stderr=subprocess.PIPE
        )
        if kills == 0 or generator.random() < 0.5:
            time.sleep(generator.uniform(0.0, longest))
            if process.poll() is None:
                process.kill()
                process.wait()
                kills += 1
                continue
        _, errors = process.communicate()
        if process.returncode != 0:
            raise SystemExit(f"resuming failed: {errors.decode()}")
        return kills


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--kills", type=int, default=20, help="at least so many kills in total")
    parser.add_argument("--seed", type=int, default=0)
    options = parser.parse_args()
    generator = random.Random(options.seed)
    with tempfile.TemporaryDirectory() as scratch:
        subprocess.run(command(Path(scratch) / "warm", resume=False), check=True, capture_output=True)
        begin = time.monotonic()
        subprocess.run(command(Path(scratch) / "reference", resume=False), check=True, capture_output=True)
        longest = time.monotonic() - begin
        reference = contents(Path(scratch) / "reference")
        kills, trials = 0, 0
        while kills < options.kills:
            folder = Path(scratch) / f"trial-{trials}"
            kills += trial(folder, longest, generator)
            trials += 1
            found = contents(folder)
            different = [key for key in reference if found.get(key) != reference[key]]
            if different or found.keys() != reference.keys():
                raise SystemExit(f"trial {trials}: {', '.join(different) or 'other files'} differ")
            print(f"trial {trials}: {kills} kills so far, identical in {len(reference)} items", flush=True)
        print(
            f"{kills} kills in {trials} runs of {longest:.1f} s: every result identical to the undisturbed run"
        )


if __name__ == "__main__":
    main()
