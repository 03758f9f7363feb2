"""From what pydantic found to messages a user can act on: key, value, what is expected, how to mend it."""

from __future__ import annotations

import difflib
import json
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Any, get_args

from pydantic import BaseModel

from wrinklewave.config.anatomy import (
    Place,
    example,
    find_place,
    members,
    quoted,
    sections_with,
    tags,
    type_text,
    unwrap,
)
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from pydantic import ValidationError
    from pydantic_core import ErrorDetails

Explanation = tuple[str, str | None, str | None]  # problem, what is expected, cure
_NOTHING = object()
LIMITS = ("greater_than", "greater_than_equal", "less_than", "less_than_equal")


class CombinedInputError(InputError):
    """Several mistakes in one input; ``errors`` holds each, the message lists all."""

    def __init__(self, errors: Sequence[InputError]) -> None:
        self.errors = tuple(errors)
        super().__init__(f"{len(errors)} mistakes in the input")

    def __str__(self) -> str:
        return "\n".join([f"{self.problem}:", *(str(error) for error in self.errors)])


def raise_all(errors: Sequence[InputError]) -> None:
    """Raise what was found: the one error, or all of them as one; nothing if there is none."""
    if len(errors) == 1:
        raise errors[0]
    if errors:
        raise CombinedInputError(errors)


def input_errors(
    failure: ValidationError, *, model: type[BaseModel], data: Mapping[str, Any]
) -> list[InputError]:
    """Return one error for each mistake that pydantic found.

    Args:
        failure: what pydantic raised.
        model: the model that was being made, for the names and descriptions of its keys.
        data: the tables as the user wrote them.
    """
    found = failure.errors(include_url=False)
    # a default that follows from a wrong value is wrong as well; only the value itself is the user's mistake
    own = [details for details in found if details["type"] == "missing" or _is_written(details, model, data)]
    return [_input_error(details, model, data) for details in own or found]


def _is_written(details: ErrorDetails, model: type[BaseModel], data: Mapping[str, Any]) -> bool:
    return _written(data, find_place(model, details["loc"]).key, _NOTHING) is not _NOTHING


def _input_error(details: ErrorDetails, model: type[BaseModel], data: Mapping[str, Any]) -> InputError:
    place = find_place(model, details["loc"])
    problem, expected, cure = _explain(details, place, model, data)
    if details["type"].startswith("union_tag"):
        place = replace(place, key=f"{place.key}.kind")
    if expected and place.description:
        expected = f"{expected} ({place.description})"
    return InputError(problem, key=place.key or None, expected=expected, cure=cure)


def _explain(
    details: ErrorDetails, place: Place, model: type[BaseModel], data: Mapping[str, Any]
) -> Explanation:
    name = place.key.rpartition(".")[2]
    written = _shown(_written(data, place.key, details["input"]))
    match details["type"]:
        case "rejected":
            context = details["ctx"]
            return context["problem"], context["expected"] or None, context["cure"] or None
        case "missing":
            return _missing(place, name)
        case "extra_forbidden":
            return _unknown(place, name, model)
        case "literal_error":
            return _no_choice(written, get_args(unwrap(place.accepts)[0]))
        case "union_tag_invalid":
            return _no_choice(_shown(details["ctx"]["tag"]), _kinds(place))
        case "union_tag_not_found":
            return "has no kind", quoted(_kinds(place)), f'add kind = "{_kinds(place)[0]}" or another'
        case kind if kind in LIMITS:
            return f"{written} is out of range", type_text(place.accepts), "give a value in that range"
        case "model_type" | "model_attributes_type" | "dict_type":
            return f"{written} is no table", "a table", f"write a section [{place.key}] with its keys"
        case _:
            assignment = "" if name.isdecimal() else f"{name} = "
            cure = f"write, for instance, {assignment}{example(place.accepts)}"
            return f"{written} does not fit", type_text(place.accepts), cure


def _missing(place: Place, name: str) -> Explanation:
    kinds = members(unwrap(place.accepts)[0])
    if len(kinds) > 1:
        return "missing", f"a table with kind = {quoted(_kinds(place))}", f"add a section [{place.key}]"
    if kinds:
        needed = [key for key, field in kinds[0].model_fields.items() if field.is_required()]
        return "missing", f"a table with {', '.join(needed)}", f"add a section [{place.key}]"
    if name.isdecimal():
        return "too few values in this list", type_text(place.accepts), "add the value that is missing"
    return "missing", type_text(place.accepts), f"add {name} = {example(place.accepts)}, with your value"


def _unknown(place: Place, name: str, model: type[BaseModel]) -> Explanation:
    known = tuple(place.parent.model_fields)
    cure = _did_you_mean(name, known)
    if cure is None:
        elsewhere = list(sections_with(model, name))
        cure = f"{name} belongs to {' or '.join(elsewhere)}" if elsewhere else "remove it"
    return "unknown key", f"one of {', '.join(known)}", cure


def _no_choice(written: str, choices: Sequence[str]) -> Explanation:
    cure = _did_you_mean(written.strip('"'), choices) or "choose one of these"
    return f"{written} is not a choice", quoted(choices), cure


def _kinds(place: Place) -> tuple[str, ...]:
    return tuple(tag for member in members(unwrap(place.accepts)[0]) for tag in tags(member))


def _did_you_mean(word: str, known: Sequence[str]) -> str | None:
    close = difflib.get_close_matches(word, known, n=1)
    return f'did you mean "{close[0]}"?' if close else None


def _written(data: Any, key: str, otherwise: Any) -> Any:
    """The value as the user wrote it, "-5 m/s" rather than -5.0; ``otherwise`` if there is none."""
    for part in key.split("."):
        if isinstance(data, Mapping) and part in data:
            data = data[part]
        elif (
            isinstance(data, Sequence)
            and not isinstance(data, str)
            and part.isdecimal()
            and int(part) < len(data)
        ):
            data = data[int(part)]
        else:
            return otherwise
    return data


def _shown(value: Any) -> str:
    """A value as TOML would have it, cut to a length that fits into a message."""
    text = json.dumps(value, ensure_ascii=False, default=str)
    return text if len(text) <= 60 else text[:57] + "..."
