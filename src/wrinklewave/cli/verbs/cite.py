"""``wrinklewave cite``: what to cite."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer


def cite(
    case: Annotated[
        Path | None, typer.Argument(metavar="[CASE]", help="Case file; without one, every method is listed.")
    ] = None,
) -> None:
    """Print BibTeX for the methods that a case uses."""
    from wrinklewave.citations import bibtex
    from wrinklewave.config import load_case

    print(bibtex(None if case is None else load_case(case)), end="")
