"""Text of the reference pages: keys of case and experiment files from the models that read them, help of the verbs."""

from __future__ import annotations

import inspect
from collections.abc import Iterator
from typing import Annotated, Any, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from wrinklewave import units
from wrinklewave.config.anatomy import members, quoted, tags, type_text, unwrap
from wrinklewave.config.defaults import fill_defaults

UNITS = {"length": "1 m", "height": "1 m", "end_time": "1 s", "critical_wavelength": "1 m"}
"""Quantities that others follow from, each one SI unit: what is derived from them is then a pure factor."""


def model_reference(model: type[BaseModel]) -> Iterator[str]:
    """Yield Markdown for the sections of a file."""
    derived, seen = derived_defaults(), dict[type[BaseModel], str]()
    for name, field in model.model_fields.items():
        yield from _section(name, field, derived, seen)


def command_reference() -> Iterator[str]:
    """Yield Markdown for the verbs."""
    from typer.main import get_command

    from wrinklewave.cli import application

    group: Any = get_command(application())
    with group.make_context("wrinklewave", [], resilient_parsing=True) as context:
        for verb, command in group.commands.items():
            with command.make_context(verb, [], parent=context, resilient_parsing=True) as inner:
                text = command.get_help(inner)
            yield from (f"## {verb}", "", "```text", text.rstrip(), "```", "")


def derived_defaults() -> dict[tuple[str, str], str]:
    """Return what keys are if they are left out because they follow from others, by section and key.

    Each is proportional to one of :data:`UNITS`; which one, and the factor, is found by doubling them in turn.
    """
    base = _filled({})
    found = {}
    for source in UNITS:
        doubled = _filled({source: UNITS[source].replace("1", "2", 1)})
        for place, value in base.items():
            if doubled[place] != value:
                found[place] = _proportional(value, source)
    return {place: found.get(place, text) for place, text in base.items()}


def _filled(changes: dict[str, str]) -> dict[tuple[str, str], str]:
    given = UNITS | changes
    same = "the substrate's"
    case = {
        "block": {"length": given["length"], "height": given["height"]},
        "solver": {"end_time": given["end_time"]},
        "film": {"critical_wavelength": given["critical_wavelength"]},
        "substrate": {"poisson_ratio": same, "density": same, "bulk_response": same},
    }
    filled = fill_defaults(case)
    places = (
        (section, key)
        for section, table in filled.items()
        for key in table
        if key not in case.get(section, {})
    )
    return {(section, key): filled[section][key] for section, key in places}


def _proportional(value: str | tuple[str, ...], source: str) -> str:
    if isinstance(value, tuple):
        return "[" + ", ".join(_proportional(entry, source) for entry in value) + "]"
    factor = units.parse(value, units.TIME if source == "end_time" else units.LENGTH)
    return f"{factor:.4g} `{source}`"


def _section(
    name: str,
    field: FieldInfo,
    derived: dict[tuple[str, str], str],
    seen: dict[type[BaseModel], str],
    path: str = "",
) -> Iterator[str]:
    """One section, or one per kind; what an earlier section says already is not said again."""
    core, many = _core(field)
    full = f"{path}{name}"
    heading = f"[[{full}]]" if many else f"[{full}]"
    kinds = members(core)
    if all(kind in seen for kind in kinds):
        yield from (f"## `{heading}`", "", f"As `{seen[kinds[0]]}`.", "")
        return
    for kind in kinds:
        seen[kind] = heading
        choice = f", kind = {quoted(tags(kind))}" if len(kinds) > 1 else ""
        yield from (f"## `{heading}`{choice}", "", _plain(kind.__doc__), "")
        yield from _table(name, kind, derived)
        for inner, sub in kind.model_fields.items():
            if _is_section(sub):
                yield from _section(inner, sub, derived, seen, f"{full}.")


def _table(section: str, model: type[BaseModel], derived: dict[tuple[str, str], str]) -> Iterator[str]:
    fields = {key: field for key, field in model.model_fields.items() if not _is_section(field)}
    if not fields:
        return
    yield from ("| key | takes | if left out | meaning |", "| --- | --- | --- | --- |")
    for key, field in sorted(fields.items(), key=lambda item: item[0] != "kind"):
        takes, default = type_text(_annotated(field)), _default(section, key, field, derived)
        yield f"| `{key}` | {takes} | {default} | {field.description or ''} |"
    yield ""


def _default(section: str, key: str, field: FieldInfo, derived: dict[tuple[str, str], str]) -> str:
    if (section, key) in derived:
        return derived[section, key]
    if field.is_required():
        return "**required**"
    value = field.get_default()
    if value is None or value == "" or value == ():
        return ""
    core, _ = unwrap(field.annotation)
    texts = [_value_text(entry, field) for entry in (value if isinstance(value, tuple) else (value,))]
    return f"`[{', '.join(texts)}]`" if get_origin(core) is tuple else f"`{texts[0]}`"


def _value_text(value: object, field: FieldInfo) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    dimension = next(
        (item for item in unwrap(_annotated(field))[1] if isinstance(item, units.Dimension)), None
    )
    return f'"{value:g} {dimension.si}"' if dimension and isinstance(value, float) else f"{value:g}"


def _annotated(field: FieldInfo) -> Any:
    return Annotated[field.annotation, field, *field.metadata]


def _is_section(field: FieldInfo) -> bool:
    return bool(members(_core(field)[0]))


def _core(field: FieldInfo) -> tuple[Any, bool]:
    """The type of a field, or of its entries, and whether it is a list."""
    core, _ = unwrap(field.annotation)
    many = get_origin(core) is tuple
    return (unwrap(get_args(core)[0])[0] if many else core), many


def _plain(docstring: str | None) -> str:
    """The docstring as Markdown: reST's double backticks are single ones there."""
    return inspect.cleandoc(docstring or "").replace("``", "`")
