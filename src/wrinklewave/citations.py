"""Which publications stand behind a run: the method, and where it is described (``references.bib``)."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

from wrinklewave import __version__

if TYPE_CHECKING:
    from wrinklewave.config.case import Case


@dataclass(frozen=True)
class Use:
    """A method, the key of its publication, and whether a case uses it."""

    key: str
    method: str
    is_used: Callable[[Case], bool]


USES = (
    Use("AbiGhanem2018", "the experiment, and wrinkles tied to material points", lambda case: True),
    Use("Simo1987", "finite-strain viscoelasticity", lambda case: bool(case.substrate.prony)),
    Use(
        "Flanagan1981", "one-point elements, hourglass control", lambda case: case.mesh.element == "one-point"
    ),
    Use("Hughes1980", "mean-dilatation elements", lambda case: case.mesh.element == "mean-dilatation"),
    Use("VonNeumann1950", "bulk viscosity", lambda case: any(case.solver.bulk_viscosity)),
    Use(
        "Lew2003",
        "steps of their own for rows of elements",
        lambda case: case.wrinkles.model == "resolved" and case.solver.subcycling,
    ),
    Use("Brau2011", "quasi-static wrinkling", lambda case: case.wrinkles.model == "quasi-static"),
    Use(
        "Huang2005",
        "wrinkling on viscoelastic substrates",
        lambda case: case.wrinkles.model == "rate-dependent",
    ),
    Use("Allen1969", "critical strain and wavelength of films", lambda case: case.film is not None),
    Use("Lam2015", "compiled kernels", lambda case: True),
)


def bibtex(case: Case | None = None) -> str:
    """Return BibTeX for this package and the methods that ``case`` uses, or for all methods."""
    entries = references()
    used = [use for use in USES if case is None or use.is_used(case)]
    return "\n\n".join([_software(), *(f"% {use.method}\n{entries[use.key]}" for use in used)]) + "\n"


def references() -> dict[str, str]:
    """Return the entries of ``references.bib`` by key."""
    text = (Path(__file__).parent / "references.bib").read_text(encoding="utf-8")
    entries = (entry.strip() for entry in text.split("\n\n"))
    return {entry[entry.index("{") + 1 : entry.index(",")]: entry for entry in entries}


def _software() -> str:
    return (
        "% this software\n@software{wrinklewave,\n  author = {{The wrinklewave developers}},\n"
        f"  title = {{wrinklewave}},\n  version = {{{__version__}}},\n}}"
    )
