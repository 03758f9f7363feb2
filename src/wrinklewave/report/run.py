"""What a finished run shows: figures, the comparison with the paper, and one page with all of it."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave.experiments.bulk_choices import with_bulk_response
from wrinklewave.experiments.paper_table import Row, as_json, paper_table
from wrinklewave.figures import FIGURES, FigureInputs, StrainSnapshots, figure_inputs
from wrinklewave.report.page import ReportContext, write
from wrinklewave.theory.report import is_papers
from wrinklewave.theory.report import report as theory_report

if TYPE_CHECKING:
    from wrinklewave.experiments.simulate import Run
    from wrinklewave.figures.beside import Helper

IMBALANCE_LIMIT, HOURGLASS_LIMIT = 1e-3, 1e-2


def compare_with_paper(run: Run, summaries: Mapping[str, Mapping[str, Any]]) -> list[Row]:
    """The comparison table of a run and of the other bulk choices that were simulated with it; empty for other cases
    than the paper's.
    """
    if not is_papers(run.case):
        return []
    theory = {
        choice: theory_report(with_bulk_response(run.case, choice))
        for choice in summaries
        if choice != "custom"
    }
    return paper_table(summaries, theory)


def present(run: Run, comparison: Sequence[Row], helper: Helper | None = None) -> None:
    """Write ``figures/``, ``comparison.json`` and ``report.html`` into the folder of a finished run.

    ``helper`` draws part of the figures beside this process.
    """
    assert run.folder is not None  # only runs with a folder are presented
    figures = FIGURES.write(run.folder / "figures", inputs_of(run), kinds={"simulation"}, helper=helper)
    (run.folder / "comparison.json").write_text(
        json.dumps(as_json(comparison), indent=2) + "\n", encoding="utf-8"
    )
    write(
        run.folder / "report.html",
        ReportContext(
            title=run.case.name,
            description=run.case.case.description,
            outcome=run.outcome.value,
            summary={name: value for name, value in run.summary.items() if name != "versions"},
            figures=figures,
            comparison=comparison,
            history=run.history,
            warnings=warnings(run.summary),
            case=run.case.to_toml(),
            versions=run.summary["versions"],
        ),
    )


def inputs_of(run: Run) -> FigureInputs:
    """What the figures of a finished run are drawn from."""
    assert run.surface is not None  # a finished run has one
    assert run.analysis is not None  # ... and this
    settings = run.case.analysis
    return figure_inputs(
        run.surface,
        run.analysis,
        positions=settings.positions,
        times=settings.times,
        snapshots=_snapshots(run),
        history=run.history,
    )


def warnings(summary: Mapping[str, Any]) -> list[str]:
    """Sentences about what makes a run less trustworthy than it should be."""
    found = []
    if summary["energy_imbalance_max"] > IMBALANCE_LIMIT:
        found.append(
            f"The energy balance is off by {summary['energy_imbalance_max']:.2%} of the external work "
            f"(limit {IMBALANCE_LIMIT:.1%}): take a smaller output.history_interval or solver.safety."
        )
    if summary["hourglass_energy_share_max"] > HOURGLASS_LIMIT:
        found.append(
            f"Hourglass control holds {summary['hourglass_energy_share_max']:.2%} of the internal energy "
            f'(limit {HOURGLASS_LIMIT:.0%}): refine the mesh or take mesh.element = "mean-dilatation".'
        )
    return found


def _snapshots(run: Run) -> StrainSnapshots | None:
    if not run.snapshots:
        return None
    X, Y = run.mesh.X, run.mesh.Y
    nodal = np.stack([frame.nodal for frame in run.snapshots]).astype(float)
    return StrainSnapshots(
        time=np.array([frame.time for frame in run.snapshots]),
        X=X,
        Y=Y,
        x=X + nodal[:, 0],
        y=Y + nodal[:, 1],
        strain_xx=np.stack([frame.elements[0] for frame in run.snapshots]).astype(float),
    )
