"""The names of the package: all there, all documented, none paid for before it is used."""

from __future__ import annotations

import inspect
import subprocess
import sys
from importlib import import_module

import pytest

import wrinklewave as ww


@pytest.mark.parametrize("name", [name for name in ww.__all__ if name != "__version__"])
def test_every_public_name_is_its_modules_own_and_documented(name: str) -> None:
    module, _, attribute = ww._HOMES[name].partition(":")
    found = getattr(ww, name)
    assert found is getattr(import_module(f"wrinklewave.{module}"), attribute)
    assert found.__module__ == f"wrinklewave.{module}"
    assert inspect.getdoc(found)
    assert inspect.signature(found)


def test_the_lists_of_names_agree() -> None:
    assert set(ww._HOMES) == set(ww.__all__) - {"__version__"}
    assert set(ww.__all__) <= set(dir(ww))


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="no attribute 'simulat'"):
        ww.simulat  # noqa: B018 - looking it up is the test


def test_importing_the_package_imports_nothing_that_is_not_in_the_standard_library() -> None:
    code = (
        "import sys\n"
        "before = set(sys.modules)\n"
        "import wrinklewave\n"
        "dir(wrinklewave)\n"
        "new = {name.partition('.')[0] for name in set(sys.modules) - before}\n"
        "print(sorted(new - set(sys.stdlib_module_names)))\n"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "['wrinklewave']"
