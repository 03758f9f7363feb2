"""Steps of their own for rows of elements against one step for all: the resolved film's impact, in turns in one run.

Run it as ``python -m benchmarks.subcycling``; about two minutes on two cores.
"""

from __future__ import annotations

from pathlib import Path

import numpy as np

from wrinklewave.experiments.simulate import Run, simulate

CASE = Path(__file__).parents[1] / "examples" / "paper_resolved.toml"
CHOICES = {
    "one step for all": ("solver.subcycling=false",),
    "steps of their own": (),
    "half as long": ("solver.safety=0.45",),
    "mixed precision": ("solver.precision=mixed",),
}


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


def main() -> None:
    reference = None
    for threads in (1, 2):
        for name, overrides in CHOICES.items():
            run = simulate(CASE, threads=threads, overrides=list(overrides))
            reference = reference or run
            s = run.summary
            changes = ", ".join(f"{n} {s[n] / reference.summary[n] - 1:+.1e}" for n in NUMBERS)
            updates = s["element_updates_per_s"] * s["stepping_time_s"]
            print(
                f"{name}, {threads} thread(s): stepping {s['stepping_time_s']:.2f} s, whole {s['wall_time_s']:.2f} s, "
                f"{s['steps']} steps, {updates / 1e6:.0f} million updates, imbalance {s['energy_imbalance_max']:.1e}, "
                f"surface off by {distance(run, reference) * 1e6:.2f} um, {changes}",
                flush=True,
            )


if __name__ == "__main__":
    main()
