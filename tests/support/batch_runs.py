"""A sweep in batches on the GPU, interrupted and resumed, and the same runs one by one.

``python -m support.batch_runs FOLDER`` leaves ``sweep``, ``single`` and ``interrupted`` there, each with the folders of
its runs.
"""

from __future__ import annotations

import json
import signal
import sys
from pathlib import Path

from support.cases import EXAMPLES
from wrinklewave.config import Case, load_case
from wrinklewave.errors import RunError
from wrinklewave.experiments.batch import simulate_together
from wrinklewave.experiments.interruption import Outcome
from wrinklewave.experiments.run_progress import Progress
from wrinklewave.experiments.simulate import simulate
from wrinklewave.experiments.sweep import SweepProgress, sweep

QUICK = EXAMPLES / "quick.toml"
SMALL = (
    *("solver.end_time=0.2 ms", "output.surface_interval=0.05 ms", "output.field_interval=0.1 ms"),
    *("drive.rise_time=0 ms", "drive.stop_distance=7.9 mm", "solver.bulk_viscosity=[0, 0]"),
)
MESHES, SPEEDS = ("[6, 3]", "[6, 2]"), ("10 m/s", "3000 m/s")
"""Of two shapes; the higher speed takes the plate nearly to the end of the first elements in one step."""
OVER = [f"mesh.elements={', '.join(MESHES)}", f"drive.velocity={', '.join(SPEEDS)}"]


def cases() -> list[Case]:
    """Of the sweep, in its order."""
    own = ((f"mesh.elements={mesh}", f"drive.velocity={speed}") for mesh in MESHES for speed in SPEEDS)
    return [load_case(QUICK, [*SMALL, *choices]) for choices in own]


def one_by_one(folder: Path) -> None:
    """Every case by a run of its own."""
    for n, case in enumerate(cases()):
        try:
            simulate(case, out=folder / f"{n:04d}", device="cuda")
        except RunError:
            continue


def in_batches(folder: Path) -> None:
    """The sweep, interrupted after its first batch."""

    def interrupt(state: SweepProgress) -> None:
        if state.done == len(SPEEDS):
            signal.raise_signal(signal.SIGINT)

    first, _ = sweep(QUICK, OVER, out=folder, overrides=SMALL, jobs=1, device="cuda", progress=interrupt)
    written = {str(file): file.stat().st_mtime_ns for file in folder.glob("runs/*/summary.json")}
    second, _ = sweep(QUICK, OVER, out=folder, overrides=SMALL, jobs=1, device="cuda", resume=True)
    outcomes = {"first": first.name, "second": second.name, "written": written}
    (folder / "outcomes.json").write_text(json.dumps(outcomes))


def interrupted(folder: Path) -> None:
    """A batch that is interrupted half way, and goes on."""

    def interrupt(state: Progress) -> None:
        if state.share == 0.5:
            signal.raise_signal(signal.SIGTERM)  # every member says so; a second SIGINT would act at once

    case = cases()[0]
    runs = [(case, folder / "0000"), (case.overridden("drive.velocity=6 m/s"), folder / "slower")]
    for progress, outcome in ((interrupt, Outcome.INTERRUPTED), (lambda state: None, Outcome.FINISHED)):
        ends = [end for _, end in simulate_together(runs, progress)]
        assert [not isinstance(end, RunError) and end.outcome for end in ends] == [outcome, outcome]


def main(folder: Path) -> None:
    """All of them."""
    sys.setswitchinterval(1e-4)  # as in support.backend_runs
    one_by_one(folder / "single")
    in_batches(folder / "sweep")
    interrupted(folder / "interrupted")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
