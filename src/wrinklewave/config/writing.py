"""Writing TOML: the resolved case goes into every result."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any


def toml_text(data: Mapping[str, Any]) -> str:
    """Return nested tables of strings, numbers, booleans, lists and lists of tables as TOML text."""
    return "\n".join(_lines(data, ())).lstrip("\n") + "\n"


def _lines(table: Mapping[str, Any], path: tuple[str, ...]) -> list[str]:
    """Plain values first, then sub-tables, as TOML wants it."""
    lines = [f"{key} = {_literal(value)}" for key, value in table.items() if not _tables(value)]
    for key, value in table.items():
        header = ".".join((*path, key))
        if isinstance(value, Mapping):
            lines += ["", f"[{header}]", *_lines(value, (*path, key))]
        elif _tables(value):
            for entry in value:
                lines += ["", f"[[{header}]]", *_lines(entry, (*path, key))]
    return lines


def _tables(value: Any) -> bool:
    """Is this a table or a list of tables?"""
    if isinstance(value, Mapping):
        return True
    return (
        isinstance(value, Sequence)
        and not isinstance(value, str)
        and any(isinstance(v, Mapping) for v in value)
    )


def _literal(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return "[" + ", ".join(_literal(item) for item in value) + "]"
    return repr(value)
