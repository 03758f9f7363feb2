"""From what pydantic found to messages a user can act on: key, value, what is expected, how to mend it."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from pydantic import BaseModel

from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from pydantic import ValidationError


def raise_all(errors: Sequence[InputError]) -> None:
    """Raise what was found: the one error, or all of them as one; nothing if there is none."""
    if errors:
        raise errors[0]


def input_errors(
    failure: ValidationError, *, model: type[BaseModel], file: object, overridden: Iterable[str] = ()
) -> list[InputError]:
    """One InputError for each of pydantic's."""
    return [
        InputError(details["msg"], file=file, key=".".join(map(str, details["loc"])))
        for details in failure.errors()
    ]
