"""Steps of their own for rows of elements against one step for all: the resolved film's impact, in turns in one run.

Run it as ``python -m benchmarks.subcycling``; about two minutes on two cores.
"""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.machine import keep, offer_to_keep
from wrinklewave.experiments.simulate import Run, simulate

CASE = Path(__file__).parents[1] / "examples" / "paper_resolved.toml"
CHOICES = {
    "one step for all": ("solver.subcycling=false",),
    "steps of their own": (),
    "half as long": ("solver.safety=0.45",),
    "mixed precision": ("solver.precision=mixed",),
}
SHORT = ("solver.end_time=0.1 ms", "analysis.times=[]")

NUMBERS = (
    "wrinkle_amplitude_max_m",
    "wavefront_speed_m_per_s",
    "wrinkle_speed_m_per_s",
    "strain_rate_max_per_s",
)


def distance(run: Run, reference: Run) -> float:
    """Largest distance between the points of two surfaces, at all times [m]."""
    surfaces = run.surface, reference.surface
    x, y = (np.subtract(*(s[name].values for s in surfaces if s is not None)) for name in ("x_p", "y_p"))
    return float(np.hypot(x, y).max())


def of_run(run: Run, reference: Run) -> dict[str, float]:
    """What a run took, and how far it is from another."""
    s: dict[str, Any] = run.summary
    return {
        "stepping_s": s["stepping_time_s"],
        "whole_s": s["wall_time_s"],
        "steps": s["steps"],
        "element_updates": s["element_updates_per_s"] * s["stepping_time_s"],
        "energy_imbalance_max": s["energy_imbalance_max"],
        "surface_off_by_m": distance(run, reference),
        **{f"change of {name}": s[name] / reference.summary[name] - 1 for name in NUMBERS},
    }


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    offer_to_keep(parser)
    options = parser.parse_args()
    for overrides in CHOICES.values():  # whatever is new to this machine is compiled now
        simulate(CASE, overrides=[*overrides, *SHORT])
    reference, found = None, {}
    for threads in (1, 2):
        for name, overrides in CHOICES.items():
            run = simulate(CASE, threads=threads, overrides=list(overrides))
            reference = reference or run
            found[f"{name}, {threads} threads"] = numbers = of_run(run, reference)
            print(
                f"{name}, {threads} thread(s):",
                ", ".join(f"{n} {v:.3g}" for n, v in numbers.items()),
                flush=True,
            )
    keep(found, options.out)


if __name__ == "__main__":
    main()
