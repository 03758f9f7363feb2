"""``wrinklewave compare``: surface motions, measured or simulated, side by side."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from wrinklewave.cli.options import Overrides

if TYPE_CHECKING:
    from collections.abc import Sequence

    import xarray as xr

    from wrinklewave.figures.beside import Helper

Motions = Annotated[
    list[Path],
    typer.Argument(
        metavar="A B ...", help="Folders of runs or measurements, or their surface.nc; A is the reference."
    ),
]
Folder = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder for the results.")]
Names = Annotated[
    str | None, typer.Option(metavar="A,B,...", help="What to call them; default: their own names.")
]


def compare(
    motions: Motions, out: Folder = Path("comparison"), names: Names = None, overrides: Overrides = None
) -> None:
    """Hold surface motions against the first: maps, curves, wrinkles, speeds, misfit; one table, one report.

    All are analysed with the parameters that the first one that records any has; --set "analysis.KEY=VALUE"
    changes them.
    """
    from wrinklewave.figures.beside import helper_beside

    with helper_beside() as helper:
        _compare(motions, out, names, overrides or (), helper)


def _compare(
    motions: list[Path], out: Path, names: str | None, overrides: Sequence[str], helper: Helper | None
) -> None:
    from wrinklewave import surface as surfaces
    from wrinklewave.cli.console import console
    from wrinklewave.config.recorded import recorded_analysis
    from wrinklewave.errors import InputError
    from wrinklewave.experiments.boundary_history import boundary_columns
    from wrinklewave.experiments.compare import compare as compare_surfaces
    from wrinklewave.experiments.run_folder import write_history
    from wrinklewave.report.side_by_side import headline_table, present_comparison

    if (out / "surface.nc").exists():
        raise InputError("holds a run or a measurement", file=out, cure="choose another folder with --out")
    found = [surfaces.read(path) for path in motions]
    named = dict(zip(_names(names, motions, found), found, strict=True))
    settings = recorded_analysis([surface.attrs for surface in found], overrides)
    comparison = compare_surfaces(named, settings)
    out.mkdir(parents=True, exist_ok=True)
    for earlier in (*out.glob("boundary-*.csv"), *out.glob("figures/*.png")):
        earlier.unlink()
    report = present_comparison(comparison, out, helper)
    for number, surface in enumerate(found, start=1):
        if surface["x_boundary"].notnull().sum() > 1:  # a struck end in sight
            write_history(out / f"boundary-{number}.csv", boundary_columns(surface))
    console().print(headline_table(comparison))
    print(f"look at {report}")


def _names(given: str | None, paths: list[Path], surfaces: list[xr.Dataset]) -> list[str]:
    """Names as given, or those of the surface motions, or else their paths; all different."""
    from wrinklewave.errors import InputError

    if given is None:
        own = [str(surface.attrs["name"]) for surface in surfaces]
        names = own if len(set(own)) == len(own) else [str(path) for path in paths]
    else:
        names = [name.strip() for name in given.split(",")]
    if len(names) != len(paths) or len(set(names)) < len(names) or not all(names):
        raise InputError(
            f"{', '.join(names)} for {len(paths)} surface motions",
            key="--names",
            expected="a name for each, all different",
            cure='write, for instance, --names "experiment,simulation"',
        )
    return names
