"""The examples of the documentation run, and find what they say they find."""

from __future__ import annotations

import os
import runpy
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

EXAMPLES = Path(__file__).parents[2] / "docs" / "examples"

FINDINGS: dict[str, Callable[[dict[str, Any]], bool]] = {
    # closed energy balance of a run that has a front
    "example_1_quick_impact": lambda names: names["imbalance"] < 1e-3 and 40 < names["speed"] < 90,
    # the surface ahead of the front is flat with K_0 only
    "example_2_bulk_response": lambda names: (
        names["ahead"]["elastic-long-term"] < 0.5 * names["ahead"]["relaxing"]
        and names["ahead"]["elastic-long-term"] < 0.5 * names["ahead"]["elastic-instantaneous"]
    ),
    # the speed and the wavelength that were put in
    "example_3_own_data": lambda names: (
        abs(names["wavefront"].speed / names["speed"] - 1) < 0.01
        and abs(names["peak"] / names["wavelength"] - 1) < 0.01
    ),
}


def test_every_example_has_a_finding() -> None:
    assert {path.stem for path in EXAMPLES.glob("*.py")} == set(FINDINGS)


@pytest.mark.parametrize("name", FINDINGS)
def test_an_example_finds_what_it_says(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(os.environ, "MPLBACKEND", "Agg")
    monkeypatch.chdir(EXAMPLES)
    import matplotlib.pyplot as plt

    try:
        assert FINDINGS[name](runpy.run_path(str(EXAMPLES / f"{name}.py")))
    finally:
        plt.close("all")
