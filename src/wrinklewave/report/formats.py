"""Numbers for people: results carry SI units in their names; here they get words, digits and handy units."""

from __future__ import annotations

from typing import NamedTuple

UNITS = (  # ending of a name, unit to show, factor from SI
    ("_J_per_m", "J/m", 1.0),
    ("_N_per_m", "N/m", 1.0),
    ("_m_per_s", "m/s", 1.0),
    ("_per_s", "1/s", 1.0),
    ("_hz", "Hz", 1.0),
    ("_px", "px", 1.0),
    ("_rad", "mrad", 1e3),
    ("_m", "mm", 1e3),
)
SHARES = ("_share", "_share_max", "_share_end", "_imbalance_max")


class Shown(NamedTuple):
    """A result as it is shown."""

    label: str
    value: str
    unit: str


def shown(name: str, value: float | None) -> Shown:
    """Label, digits and unit of a result named like ``wavefront_speed_m_per_s`` [SI]."""
    if name.endswith(SHARES):
        return Shown(_words(name), _digits(value, 1e2), "%")
    if name.endswith("_updates_per_s"):
        return Shown(_words(name.removesuffix("_per_s")), _digits(value, 1e-6), "million/s")
    if name.endswith("pixel_size_m"):
        return Shown(_words(name.removesuffix("_m")), _digits(value, 1e6), "µm")
    for ending, unit, factor in UNITS:
        if name.endswith(ending):
            return Shown(_words(name.removesuffix(ending)), _digits(value, factor), unit)
    if name.endswith("_s"):
        unit, factor = ("s", 1.0) if value is not None and abs(value) >= 1.0 else ("ms", 1e3)
        return Shown(_words(name.removesuffix("_s")), _digits(value, factor), unit)
    return Shown(_words(name), number(value), "")


def with_sigma(name: str, value: float | None, sigma: float | None) -> str:
    """Digits of a result and of its standard uncertainty, if there is one."""
    text = shown(name, value).value
    return text if sigma is None else f"{text} ± {float(shown(name, sigma).value):.2g}"


def number(value: float | None) -> str:
    """Four significant digits, all digits of a whole number, a dash for None."""
    if value is None:
        return "–"
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def _digits(value: float | None, factor: float) -> str:
    return number(None if value is None else factor * float(value))


def _words(name: str) -> str:
    return name.replace("_", " ")
