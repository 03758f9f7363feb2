"""The command line: the workflow in verbs, one thin function each.

To add a verb, add a module to ``cli/verbs/``, named as the verb with underscores for dashes, with a public
function of the same name: its signature makes the arguments, its docstring the help. Nothing here changes.
Import what is heavy (numpy, xarray, numba, pydantic, rich) inside the function: ``--help`` imports the module
of every verb. Mistakes of a user are raised as :class:`wrinklewave.errors.InputError` and printed without a
traceback.
"""

from __future__ import annotations

import atexit
import gc
import sys
from collections.abc import Callable
from errno import EACCES, EEXIST, EISDIR, ENOENT, ENOSPC, ENOTDIR, EPERM, EROFS
from functools import wraps
from importlib import import_module
from pkgutil import iter_modules
from typing import Annotated

import typer

from wrinklewave import __version__
from wrinklewave.cli import verbs
from wrinklewave.errors import WrinklewaveError

ORDER = ("simulate", "restart", "sweep", "film", "inspect", "measure", "compare", "theory", "doctor", "cite")
"""Verbs as a user meets them; others come after them."""

USERS_MISTAKES = (ENOENT, EACCES, EPERM, EROFS, ENOTDIR, EISDIR, EEXIST)
"""Errors of the operating system that a wrong path explains; others, such as a full disk, are failures."""


COLLECTED_AFTER = 50_000
"""Objects made until the collector looks for cycles: by default 700, and every hundredth look goes through all that the
compiler has made, which takes 0.1 s and finds nothing."""
FULL = "No space left on device"
FREE_SOME = "  to mend:  free some, then go on with wrinklewave restart DIR, or --resume"


def main() -> None:
    """Entry point: run the verb; return 2 for a mistake in the input, 1 for a failure, 130 after Ctrl-C."""
    gc.set_threshold(COLLECTED_AFTER)
    atexit.register(
        gc.freeze
    )  # or the end of the process looks through all of it once more, for half a second
    try:
        application()()
    except WrinklewaveError as error:
        _fail(str(error), error.exit_code)
    except KeyboardInterrupt:
        _fail("stopped", 130)
    except OSError as error:
        _fail(_system_says(error), 2 if error.errno in USERS_MISTAKES else 1)
    except MemoryError as error:
        _fail(f"not enough memory ({error})\n  to mend:  a coarser mesh, or fewer outputs", 1)
    except RuntimeError as error:
        if FULL not in str(error):
            raise
        _fail(
            f"{FULL.lower()}\n{FREE_SOME}", 1
        )  # HDF5 fails so when it closes a file that it could not write


def application() -> typer.Typer:
    """Return the application with every verb that there is a module for."""
    app = typer.Typer(
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode=None,  # rich would double the time that --help takes
        pretty_exceptions_enable=False,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_wrinklewave)
    names = {module.name for module in iter_modules(verbs.__path__)}
    for name in sorted(names, key=lambda name: (ORDER.index(name) if name in ORDER else len(ORDER), name)):
        module = import_module(f"{verbs.__name__}.{name}")
        app.command(name.replace("_", "-"))(_telling_of_a_stop(getattr(module, name)))
    return app


def _telling_of_a_stop(verb: Callable[..., None]) -> Callable[..., None]:
    """The verb, which says so if Ctrl-C ends it: typer leaves without a word."""

    @wraps(verb)
    def told(*arguments: object, **options: object) -> None:
        try:
            verb(*arguments, **options)
        except KeyboardInterrupt:
            print("wrinklewave: stopped", file=sys.stderr)
            raise

    return told


def _print_version(wanted: bool) -> None:
    if wanted:
        print(f"wrinklewave {__version__}")
        raise typer.Exit


def _wrinklewave(
    version: Annotated[
        bool,
        typer.Option(
            "--version", is_eager=True, callback=_print_version, help="Print the version and leave."
        ),
    ] = False,
) -> None:
    """A laboratory for waves and wrinkles in soft layered materials: simulate, measure, compare."""


def _system_says(error: OSError) -> str:
    """What went wrong with which file, in the words of the operating system."""
    if error.errno == ENOSPC:
        return f"{f'{error.filename}: ' if error.filename else ''}{FULL.lower()}\n{FREE_SOME}"
    if error.filename is None or error.strerror is None:
        return str(error)
    if error.errno == EEXIST:
        return f"{error.filename}: is a file\n  expected: a folder for the results"
    problem = f"{error.filename}: {error.strerror[0].lower()}{error.strerror[1:]}"
    if error.errno not in USERS_MISTAKES:
        return problem
    return f"{problem}\n  to mend:  give a path in a folder that exists and that you may write to"


def _fail(message: str, exit_code: int) -> None:
    print(f"wrinklewave: {message}", file=sys.stderr)
    sys.exit(exit_code)
