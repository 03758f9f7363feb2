"""Looking into the models of a file: which field stands at a place, what it accepts, where a key is known."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from annotated_types import Ge, Gt, Le, Lt
from pydantic import BaseModel

from wrinklewave.units import Dimension

Part = int | str


@dataclass(frozen=True)
class Place:
    """A place in a file.

    Args:
        key: dotted key, list entries counted from 0.
        parent: the model of the table that the key is in.
        accepts: type that the value must have; None for a key that nobody knows.
        description: what the value is.
    """

    key: str
    parent: type[BaseModel]
    accepts: Any
    description: str = ""


def find_place(model: type[BaseModel], location: Sequence[Part]) -> Place:
    """Follow pydantic's location of an error through ``model``; the union tags in it are no keys."""
    accepts: Any = model
    parent, keys, description = model, [], ""
    for part in location:
        core, _ = unwrap(accepts)
        if len(members(core)) > 1:
            accepts = next(member for member in members(core) if part in tags(member))
            continue
        keys.append(str(part))
        if isinstance(core, type) and issubclass(core, BaseModel):
            parent = core
            field = core.model_fields.get(str(part))
            accepts = field and Annotated[field.annotation, field, *field.metadata]
            description = (field and field.description) or ""
        else:
            accepts = _entry(core, part)
    return Place(".".join(keys), parent, accepts, description)


def unwrap(accepts: Any) -> tuple[Any, tuple[Any, ...]]:
    """Return the type inside ``Annotated`` and ``| None``, and all annotations on the way."""
    if get_origin(accepts) is Annotated:
        inner, *annotations = get_args(accepts)
        core, more = unwrap(inner)
        return core, (*annotations, *more)
    if get_origin(accepts) in (Union, UnionType):
        present = [part for part in get_args(accepts) if part is not NoneType]
        return unwrap(present[0]) if len(present) == 1 else (accepts, ())
    return accepts, ()


def members(core: Any) -> tuple[type[BaseModel], ...]:
    """Return the models that a type allows: several for a union of kinds, none for a plain value."""
    if get_origin(core) in (Union, UnionType):
        return tuple(model for part in get_args(core) for model in members(unwrap(part)[0]))
    return (core,) if isinstance(core, type) and issubclass(core, BaseModel) else ()


def tags(model: type[BaseModel]) -> tuple[str, ...]:
    """Return the values of ``kind`` that choose this model in a union."""
    return tuple(get_args(model.model_fields["kind"].annotation)) if "kind" in model.model_fields else ()


def sections_with(model: type[BaseModel], key: str, path: str = "") -> Iterator[str]:
    """Yield the sections of a file in which ``key`` is known, as a reader would name them."""
    for name, field in model.model_fields.items():
        core, _ = unwrap(field.annotation)
        if get_origin(core) is tuple:
            core, _ = unwrap(get_args(core)[0])
        kinds = members(core)
        for kind in kinds:
            section = f"{path}.{name}" if path else name
            if key in kind.model_fields:
                yield f"[{section}]" + (f' with kind = "{tags(kind)[0]}"' if len(kinds) > 1 else "")
            yield from sections_with(kind, key, section)


def type_text(accepts: Any) -> str:
    """Say what a place accepts: ``a length with its unit, > 0``."""
    core, annotations = unwrap(accepts)
    bounds = "".join(f", {bound}" for bound in _bounds(annotations))
    dimension = next((item for item in annotations if isinstance(item, Dimension)), None)
    if dimension:
        return f"a {dimension.name} with its unit{bounds}"
    if get_origin(core) is Literal:
        return quoted(get_args(core))
    if get_origin(core) is tuple:
        entries = [entry for entry in get_args(core) if entry is not Ellipsis]
        number = "a list" if Ellipsis in get_args(core) else f"a list of {len(entries)}"
        return f"{number}, each {type_text(entries[0])}"
    if members(core):
        return "a table"
    return {bool: "true or false", int: "a whole number", float: "a number"}.get(
        core, "text in quotes"
    ) + bounds


def example(accepts: Any) -> str:
    """Return a value that a place accepts, written as TOML."""
    core, annotations = unwrap(accepts)
    dimension = next((item for item in annotations if isinstance(item, Dimension)), None)
    if dimension:
        return f'"{dimension.example}"'
    if get_origin(core) is Literal:
        return f'"{get_args(core)[0]}"'
    if get_origin(core) is tuple:
        entries = [entry for entry in get_args(core) if entry is not Ellipsis]
        return "[" + ", ".join(example(entry) for entry in entries) + "]"
    return {bool: "true", int: "100", float: "0.1"}.get(core, '"..."')


def quoted(choices: Sequence[object]) -> str:
    """Return choices for a sentence: ``"free" or "fixed"``."""
    *first, last = [f'"{choice}"' for choice in choices]
    return f"{', '.join(first)} or {last}" if first else last


def _entry(core: Any, part: Part) -> Any:
    """The type of an entry of a list."""
    entries = get_args(core)
    if not entries:
        return None
    return entries[0] if Ellipsis in entries else entries[min(int(part), len(entries) - 1)]


def _bounds(annotations: Sequence[Any]) -> Iterator[str]:
    signs = ((Gt, "gt", ">"), (Ge, "ge", ">="), (Lt, "lt", "<"), (Le, "le", "<="))
    found = [
        item for annotation in annotations for item in (annotation, *getattr(annotation, "metadata", ()))
    ]
    for kind, name, sign in signs:
        limits = {getattr(item, name) for item in found if isinstance(item, kind)}
        for limit in sorted(limits):
            yield f"{sign} {limit:g}"
