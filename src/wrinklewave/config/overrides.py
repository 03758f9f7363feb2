"""``--set key=value``: replace values of a case file before it is checked."""

from __future__ import annotations

import copy
import re
import tomllib
from collections.abc import Sequence
from typing import Any

from wrinklewave.errors import InputError

_SEPARATED = re.compile(r"""(?:\[[^\]]*\]|"[^"]*"|'[^']*'|[^,])+""")
"""A stretch between commas; those in brackets and quotes are part of it."""


def apply_overrides(data: dict[str, Any], overrides: Sequence[str]) -> tuple[dict[str, Any], tuple[str, ...]]:
    """Return a copy of ``data`` with the overrides in it, and their dotted keys.

    Args:
        data: nested tables as read from TOML.
        overrides: ``section.key=value``; values are TOML, or else plain text (``drive.velocity=5 m/s``);
            numbers in the key count a list's entries from 0 (``substrate.prony.0.relaxation_time=60 us``).

    Raises:
        InputError: if an override is not of that form, or its key leads nowhere.
    """
    changed = copy.deepcopy(data)
    keys = []
    for override in overrides:
        key, equals, text = override.partition("=")
        key = key.strip()
        if not equals or not all(key.split(".")):
            raise InputError(
                f'"{override}" is no override',
                file="--set",
                expected="section.key=value",
                cure='write, for instance, --set "drive.velocity=5 m/s"',
            )
        _set(changed, key, _value(text.strip()))
        keys.append(key)
    return changed, tuple(keys)


def alternatives(text: str) -> tuple[str, tuple[str, ...]]:
    """Return the key of ``key=value, value, ...`` and its values; commas in brackets or quotes separate nothing.

    Raises:
        InputError: if the text is not of that form.
    """
    key, equals, values = text.partition("=")
    found = tuple(part.strip() for part in _SEPARATED.findall(values) if part.strip())
    if not equals or not all(key.strip().split(".")) or not found:
        raise InputError(
            f'"{text}" names no values to go over',
            file="--over",
            expected="section.key=value, value, ...",
            cure='write, for instance, --over "drive.velocity=5 m/s, 10 m/s"',
        )
    return key.strip(), found


def _value(text: str) -> Any:
    """The TOML value that ``text`` is, or else the text itself."""
    try:
        parsed = tomllib.loads(f"value = {text}")
    except tomllib.TOMLDecodeError:
        return text
    return parsed["value"] if len(parsed) == 1 else text


def _set(data: dict[str, Any], key: str, value: Any) -> None:
    *parents, last = key.split(".")
    table: Any = data
    for part in parents:
        table = table.setdefault(part, {}) if isinstance(table, dict) else _entry(table, part, key)
    if isinstance(table, dict):
        table[last] = value
    else:
        _entry(table, last, key)
        table[int(last)] = value


def _entry(parent: Any, part: str, key: str) -> Any:
    if not isinstance(parent, list):
        raise InputError(f'"{part}" is inside a single value', file="--set", key=key, cure="check the key")
    if not part.isdecimal() or int(part) >= len(parent):
        raise InputError(
            f'no entry "{part}" in this list',
            file="--set",
            key=key,
            expected=f"a number from 0 to {len(parent) - 1}" if parent else "a list that is not empty",
        )
    return parent[int(part)]
