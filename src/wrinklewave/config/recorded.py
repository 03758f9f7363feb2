"""Parameters of the analysis that surface motions carry along: in the case or experiment that they came from."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from wrinklewave import units
from wrinklewave.config.case import Analysis
from wrinklewave.config.defaults import fill_defaults
from wrinklewave.config.fields import Section
from wrinklewave.config.reading import parse_toml, read_model
from wrinklewave.config.writing import toml_text

SOURCES = ("case", "experiment")
"""Attributes of a surface motion that may hold the text of the file behind it."""


class _AnalysisAlone(Section):
    analysis: Analysis


def recorded_analysis(attributes: Sequence[Mapping[str, Any]], overrides: Sequence[str] = ()) -> Analysis:
    """Parameters of the analysis of the first surface motion that records them, with overrides on top.

    Where none does they are those of a case file that leaves them out, in proportion to the first one's
    length. ``times`` is empty if nobody gave any.

    Args:
        attributes: of the surface motions.
        overrides: ``"analysis.key=value"``.

    Raises:
        InputError: if an override, or what is recorded, cannot be used.
    """
    given = next((found for found in map(_recorded, attributes) if found is not None), {})
    tables: dict[str, Any] = {
        "block": {"length": _length(attributes[0]["length"])},
        "analysis": {"times": [], **given},
    }
    if "critical_wavelength" in attributes[0]:
        tables["film"] = {"critical_wavelength": _length(attributes[0]["critical_wavelength"])}
    text = toml_text({"analysis": fill_defaults(tables)["analysis"]})
    return read_model(_AnalysisAlone, text, overrides=overrides, source="recorded analysis").analysis


def _recorded(attributes: Mapping[str, Any]) -> dict[str, Any] | None:
    for source in SOURCES:
        if source in attributes:
            tables = parse_toml(str(attributes[source]), f"{attributes.get('name')}: {source}")
            return tables.get("analysis")
    return None


def _length(value: Any) -> str:
    return units.format_si(float(value), units.LENGTH)
