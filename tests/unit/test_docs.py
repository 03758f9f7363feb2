"""What README and the pages say is what the program does."""

from __future__ import annotations

import re
import runpy
import shlex
import sys
from pathlib import Path
from types import SimpleNamespace

import pytest
from pydantic import BaseModel

from wrinklewave.cli import application, main
from wrinklewave.config.anatomy import members, unwrap
from wrinklewave.config.case import Case
from wrinklewave.config.experiment import Experiment

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("*.md"))
LINK = re.compile(r"\]\(([^)#:]+?)(?:#[^)]*)?\)")
TOCTREE = re.compile(r"```\{toctree\}\n(.*?)```", re.DOTALL)


def commands_of(page: Path) -> list[str]:
    return re.findall(r"```sh\n(.*?)```", page.read_text(encoding="utf-8"), re.DOTALL)


def reference_text() -> SimpleNamespace:
    return SimpleNamespace(**runpy.run_path(str(DOCS / "_ext" / "reference_text.py")))


def keys_of(model: type[BaseModel]) -> set[str]:
    """Every key that a file of this model may hold."""
    found: set[str] = set()
    for name, field in model.model_fields.items():
        core, _ = unwrap(field.annotation)
        entries = [core, *(unwrap(entry)[0] for entry in getattr(core, "__args__", ()))]
        models = {inner for entry in entries for inner in members(entry)}
        found |= {name}.union(*(keys_of(inner) for inner in models))
    return found


def test_checks_run_the_readmes_test_command_word_for_word() -> None:
    run, test, *_ = commands_of(ROOT / "README.md")
    assert test.strip() in (ROOT / ".ci" / "run").read_text(encoding="utf-8").splitlines()
    case = shlex.split(run.rpartition("&&")[2])[2]
    assert (ROOT / case).is_file()


@pytest.mark.parametrize(
    "page", [ROOT / "README.md", ROOT / "CHANGELOG.md", *PAGES], ids=lambda page: page.name
)
def test_links_and_pictures_lead_somewhere(page: Path) -> None:
    text = re.sub(r"```.*?```|`[^`\n]*`", "", page.read_text(encoding="utf-8"), flags=re.DOTALL)
    missing = [link for link in LINK.findall(text) if not (page.parent / link).exists()]
    assert not missing


def test_every_page_can_be_reached() -> None:
    listed = {
        line.strip()
        for page in PAGES
        for block in TOCTREE.findall(page.read_text(encoding="utf-8"))
        for line in block.splitlines()
        if line and not line.startswith(":")
    }
    assert listed - {"gallery/index"} == {page.stem for page in PAGES} - {"index"}


def test_the_mistakes_that_the_case_page_shows_are_answered_as_it_says(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    command, _, answer = (DOCS / "tables" / "bad_case.txt").read_text(encoding="utf-8").partition("\n")
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(sys, "argv", shlex.split(command.removeprefix("$ ")))
    with pytest.raises(SystemExit) as left:
        main()
    assert left.value.code == 2
    assert capsys.readouterr().err == answer


@pytest.mark.parametrize("model", [Case, Experiment])
def test_the_reference_has_every_key(model: type[BaseModel]) -> None:
    text = "\n".join(reference_text().model_reference(model))
    assert {key for key in keys_of(model) if f"`{key}`" not in text and f"{key}]" not in text} == set()


def test_derived_values_are_shown_with_what_they_follow_from() -> None:
    derived = reference_text().derived_defaults()
    assert derived["wrinkles", "averaging_depth"] == "0.5 `height`"
    assert derived["analysis", "front_window"] == "[0.25 `length`, 0.8 `length`]"
    assert derived["output", "surface_interval"] == "0.002 `end_time`"


def test_the_command_reference_has_every_verb() -> None:
    text = "\n".join(reference_text().command_reference())
    for command in application().registered_commands:
        assert f"## {command.name}\n" in text
