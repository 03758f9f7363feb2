"""Run the verification tests and keep every number that they check: ``python -m benchmarks.verification_table``.

Writes ``docs/verification.md``: what was found, what was required, and whether it holds; pytest's own verdicts follow.
"""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import pytest

REPOSITORY = Path(__file__).parents[1]
PAGE = REPOSITORY / "docs" / "verification.md"
HEAD = """# Verification

Every number below is checked by a test against a closed form, an identity, a conservation law or an independent code:
on every run of the tests, but for those of the paper case at its full size, which only the command that writes this
page runs, `python -m benchmarks.verification_table`.
"""


class Collector:
    """Gathers the verified numbers of all tests, by module."""

    def __init__(self) -> None:
        self.found: dict[str, list[Any]] = {}

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        """Keep what a test has recorded."""
        if report.when == "call":
            entries = [value for name, value in report.user_properties if name == "verified"]
            module = Path(report.nodeid.partition("::")[0]).stem.removeprefix("test_").replace("_", " ")
            self.found.setdefault(module, []).extend(entries)

    def page(self) -> str:
        """The page, one table per module that verified numbers."""
        parts = [HEAD]
        for module, entries in self.found.items():
            if entries:
                rows = [
                    f"| {e.what} | {e.found} | {e.required} | {'yes' if e.holds else '**no**'} |"
                    for e in entries
                ]
                parts.append(
                    f"## {module.capitalize()}\n\n| what | found | required | holds |\n| --- | --- | --- | --- |"
                )
                parts[-1] += "\n" + "\n".join(rows) + "\n"
        return "\n".join(parts)


def main() -> int:
    collector = Collector()
    everything = ["-m", "paper_size or not paper_size", str(REPOSITORY / "tests" / "verification")]
    code = pytest.main([*everything, *sys.argv[1:]], plugins=[collector])
    PAGE.write_text(collector.page(), encoding="utf-8")
    return int(code)


if __name__ == "__main__":
    sys.exit(main())
