"""Errors that a user can mend: each says what was found, what was expected and what to do."""

from __future__ import annotations


class WrinklewaveError(Exception):
    """Base of every error that is a message to the user; the command line prints it without a traceback.

    ``exit_code`` is what the command line returns: 2 for a mistake in the input, 1 for a run that failed.
    """

    exit_code = 1


class InputError(WrinklewaveError):
    """Something the user wrote is wrong: a file, a key, a value.

    Args:
        problem: what was found, with the value.
        file: the file that holds it, if any.
        key: the dotted key in that file, if any.
        expected: what would have been accepted.
        cure: what to do about it.
    """

    exit_code = 2

    def __init__(
        self,
        problem: str,
        *,
        file: object = None,
        key: str | None = None,
        expected: str | None = None,
        cure: str | None = None,
    ) -> None:
        self.problem, self.file, self.key, self.expected, self.cure = problem, file, key, expected, cure
        place = ": ".join(str(part) for part in (file, key) if part)
        lines = [f"{place}: {problem}" if place else problem]
        if expected:
            lines.append(f"  expected: {expected}")
        if cure:
            lines.append(f"  to mend:  {cure}")
        super().__init__("\n".join(lines))


class RunError(WrinklewaveError):
    """A computation could not go on (element inversion, NaN, collapsing step, damaged recording)."""
