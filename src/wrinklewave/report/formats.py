"""Numbers for people: results carry SI units in their names; here they get words, digits and handy units."""

from __future__ import annotations

from typing import NamedTuple

UNITS = (  # ending of a name, unit to show, factor from SI
    ("_updates_per_s", "million/s", 1e-6),
    ("_J_per_m", "J/m", 1.0),
    ("_N_per_m", "N/m", 1.0),
    ("_m_per_s", "m/s", 1.0),
    ("_per_s", "1/s", 1.0),
    ("_hz", "Hz", 1.0),
    ("_pa", "kPa", 1e-3),
    ("_share", "%", 1e2),
    ("_m", "mm", 1e3),
    ("_s", "ms", 1e3),
)


class Shown(NamedTuple):
    """A result as it is shown."""

    label: str
    value: str
    unit: str


def shown(name: str, value: float | None) -> Shown:
    """Label, digits and unit of a result named like ``wavefront_speed_m_per_s`` [SI]."""
    for ending, unit, factor in UNITS:
        if name.endswith(ending):
            return Shown(_words(name.removesuffix(ending)), _digits(value, factor), unit)
    return Shown(_words(name), _digits(value, 1.0), "")


def number(value: float | None) -> str:
    """Four significant digits, or a dash for None."""
    return "–" if value is None else f"{value:.4g}"


def _digits(value: float | None, factor: float) -> str:
    return number(None if value is None else factor * value)


def _words(name: str) -> str:
    return name.replace("_", " ")
