"""Where the verbs print to."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console

FILE_WIDTH = 140


def console() -> Console:
    """Return the console; a pipe or a file gets lines long enough for tables."""
    from rich.console import Console

    found = Console()
    return found if found.is_terminal else Console(width=FILE_WIDTH)
