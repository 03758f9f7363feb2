"""Reading case files: TOML text, ``--set`` overrides, validation, checks of the case as a whole."""

from __future__ import annotations

import tomllib
from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, TypeVar

from pydantic import BaseModel, ValidationError

from wrinklewave.config.case import Case
from wrinklewave.config.checks import case_errors
from wrinklewave.config.overrides import apply_overrides
from wrinklewave.config.problems import input_errors, raise_all
from wrinklewave.errors import InputError

Model = TypeVar("Model", bound=BaseModel)


def load_case(path: str | Path, overrides: Sequence[str] = ()) -> Case:
    """Read a case file, replace values by ``key=value`` overrides, complete and check it.

    Args:
        path: the TOML file; files that it names are relative to its folder.
        overrides: as for ``--set``, such as ``"drive.velocity=5 m/s"``.

    Raises:
        InputError: naming file, key, value, what is expected and the cure; all mistakes of a file at once.
    """
    return case_from_text(read_text(path), overrides=overrides, source=path, folder=Path(path).parent)


def case_from_text(
    text: str, *, overrides: Sequence[str] = (), source: object = "case", folder: str | Path = "."
) -> Case:
    """Read a case from the text of a case file; ``source`` names it in errors. See :func:`load_case`."""
    return read_model(Case, text, overrides=overrides, source=source, folder=folder, check=case_errors)


def read_text(path: str | Path) -> str:
    """Return the text of a file that a user named.

    Raises:
        InputError: if it does not exist, cannot be read, or is no UTF-8 text.
    """
    file = Path(path)
    try:
        return file.read_text(encoding="utf-8")
    except FileNotFoundError as error:
        raise InputError("no such file", file=file, cure="check the path") from error
    except UnicodeDecodeError as error:
        raise InputError(
            f"is no text ({error})",
            file=file,
            expected="a TOML file in UTF-8",
            cure="of a recording: wrinklewave inspect writes an experiment file for it",
        ) from error
    except OSError as error:
        cure = f"give {file / 'case.toml'}" if (file / "case.toml").exists() else None
        raise InputError(
            f"cannot be read ({error.strerror})", file=file, expected="a TOML file", cure=cure
        ) from error


def read_model(
    model: type[Model],
    text: str,
    *,
    overrides: Sequence[str] = (),
    source: object,
    folder: str | Path = ".",
    check: Callable[[Model], Iterable[InputError]] = lambda _: (),
) -> Model:
    """Read TOML text into a pydantic model.

    Args:
        model: the model; its fields' types and descriptions make the messages.
        text: TOML.
        overrides: ``key=value`` with dotted keys.
        source: what to call the text in errors.
        folder: what relative paths in it are relative to (``context["folder"]`` of the validators).
        check: further checks of the whole, run when every value by itself is right.

    Raises:
        InputError: with all mistakes that were found.
    """
    written = parse_toml(text, source)
    _check_kind(model, written, source)
    data, overridden = apply_overrides(written, overrides)
    try:
        read = model.model_validate(_frozen(data), context={"folder": Path(folder).absolute()})
    except ValidationError as failure:
        found = input_errors(failure, model=model, data=data)
        raise_all([_placed(error, source, overridden) for error in found])
        raise  # a validation error without errors would be a mistake of pydantic's
    together = f"{source} (with --set {', '.join(overridden)})" if overridden else source
    raise_all([_placed(error, together, overridden) for error in check(read)])
    return read


def _check_kind(model: type[BaseModel], written: Mapping[str, Any], source: object) -> None:
    """One sentence, rather than one for each section, if a case stands in for an experiment or the reverse."""
    for section, kind, verb in (("video", "an experiment", "measure"), ("block", "a case", "simulate")):
        if section in written and section not in model.model_fields:
            raise InputError(
                f"describes {kind}: it has a section [{section}]",
                file=source,
                expected=f"sections {', '.join(model.model_fields)}",
                cure=f"wrinklewave {verb} takes it",
            )


def parse_toml(text: str, source: object) -> dict[str, Any]:
    """Parse TOML.

    Raises:
        InputError: with line and column, and the line itself.
    """
    try:
        return tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise InputError(
            f"is no valid TOML: {error}",
            file=source,
            expected='lines such as  length = "50.4 mm"  in [sections]',
            cure="look at that line: text needs quotes, a key may appear once only",
        ) from error


def _frozen(value: Any) -> Any:
    """Lists as tuples, all the way down: the models are frozen and take nothing else."""
    if isinstance(value, Mapping):
        return {key: _frozen(item) for key, item in value.items()}
    return tuple(_frozen(item) for item in value) if isinstance(value, list) else value


def _placed(error: InputError, source: object, overridden: Sequence[str]) -> InputError:
    """The error with the place where its value was written."""
    key = f"{error.key}."
    place = (
        "--set"
        if any(key.startswith(f"{changed}.") or changed.startswith(key) for changed in overridden)
        else source
    )
    return InputError(error.problem, file=place, key=error.key, expected=error.expected, cure=error.cure)
