"""Imports go one way: a room may import only from rooms above it (docs/developing.md)."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[2] / "src" / "wrinklewave"
ROOMS = (
    *(
        "errors",
        "_version",
        "_jit",
        "processes",
        "compiling",
        "units",
        "config",
        "materials",
        "theory",
        "surface",
        "laboratory_frame",
    ),
    *("wrinkling", "mesh", "dynamics", "imaging", "analysis", "environment", "citations", "experiments"),
    *("figures", "report", "cli"),
)


def imported_rooms(file: Path) -> Iterator[str]:
    """Rooms of this package that a module imports, type hints apart."""
    tree = ast.parse(file.read_text(encoding="utf-8"))
    hints = {
        id(inner)
        for node in ast.walk(tree)
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING"
        for inner in ast.walk(node)
    }
    for node in ast.walk(tree):
        if id(node) in hints:
            continue
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("wrinklewave."):
            yield node.module.split(".")[1]
        elif isinstance(node, ast.ImportFrom) and node.module == "wrinklewave":
            yield from (alias.name for alias in node.names if alias.name != "__version__")


@pytest.mark.parametrize("room", ROOMS)
def test_a_room_imports_only_from_rooms_above_it(room: str) -> None:
    place = PACKAGE / room
    files = list(place.rglob("*.py")) if place.is_dir() else [place.with_suffix(".py")]
    found = {other for file in files for other in imported_rooms(file)}
    assert not {other for other in found if ROOMS.index(other) > ROOMS.index(room)}


def test_every_module_is_in_a_room() -> None:
    names = {
        path.stem for path in PACKAGE.iterdir() if path.suffix == ".py" or (path / "__init__.py").exists()
    }
    assert names - {"__init__", "__main__"} == set(ROOMS)
