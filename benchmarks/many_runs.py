"""Runs per minute of a sweep on the processor: ``python -m benchmarks.many_runs``.

The paper's case at speeds of the plate that differ little, for two bulk moduli, one run at a time and one per core:
from nothing to the table of results, start of the processes included, and by the pace between first and last run.
"""

from __future__ import annotations

import argparse
import tempfile
import time
from pathlib import Path

from benchmarks.machine import keep, offer_to_keep
from benchmarks.problem import PAPER_CASE
from wrinklewave.environment import processor
from wrinklewave.experiments.sweep import sweep

RUNS = 8
BULK = {"K_0": "elastic-long-term", "K_i": "elastic-instantaneous"}


def runs_per_minute(bulk: str, jobs: int) -> dict[str, float]:
    """Of a whole sweep, and of its runs after the first ``jobs``."""
    ended: list[float] = []
    speeds = ", ".join(f"{9.9 + 0.01 * k:.2f} m/s" for k in range(RUNS))
    with tempfile.TemporaryDirectory() as scratch:
        begin = time.perf_counter()
        sweep(
            PAPER_CASE,
            [f"drive.velocity={speeds}"],
            out=Path(scratch) / "sweep",
            overrides=[f"substrate.bulk_response={bulk}"],
            jobs=jobs,
            progress=lambda state: ended.append(time.perf_counter()),
        )
        whole = time.perf_counter() - begin
    pace = (RUNS - jobs) / (ended[-1] - ended[jobs - 1])
    return {"whole": 60 * RUNS / whole, "pace": 60 * pace}


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    offer_to_keep(parser)
    options = parser.parse_args()
    print("| bulk | at a time | runs per minute, the whole sweep | once it runs |\n| --- | --- | --- | --- |")
    found = {}
    for name, bulk in BULK.items():
        for jobs in range(1, processor().usable + 1):
            found[f"{name}, {jobs} at a time"] = rates = runs_per_minute(bulk, jobs)
            print(f"| {name} | {jobs} | {rates['whole']:.0f} | {rates['pace']:.0f} |", flush=True)
    keep(found, options.out)


if __name__ == "__main__":
    main()
