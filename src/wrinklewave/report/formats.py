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


class Scale(NamedTuple):
    """How a result is shown: its words, the unit, and the factor from SI."""

    label: str
    unit: str
    factor: float | None = None

    def digits(self, value: float | None) -> str:
        """The digits of a value [SI]; whole numbers without a unit keep all of theirs."""
        return number(value if value is None or self.factor is None else self.factor * float(value))

    def with_sigma(self, value: float | None, sigma: float | None) -> str:
        """Digits of a value and of its standard uncertainty, if there is one [SI]."""
        text = self.digits(value)
        return text if sigma is None else f"{text} ± {float(self.digits(sigma)):.2g}"


class Shown(NamedTuple):
    """A result as it is shown."""

    label: str
    value: str
    unit: str


def scale(name: str, largest: float | None) -> Scale:
    """Words and unit for results named like ``wavefront_speed_m_per_s`` of which ``largest`` [SI] is the largest."""
    if name.endswith(SHARES):
        return Scale(_words(name), "%", 1e2)
    if name.endswith("_updates_per_s"):
        return Scale(_words(name.removesuffix("_per_s")), "million/s", 1e-6)
    if name.endswith("pixel_size_m"):
        return Scale(_words(name.removesuffix("_m")), "µm", 1e6)
    for ending, unit, factor in UNITS:
        if name.endswith(ending):
            return Scale(_words(name.removesuffix(ending)), unit, factor)
    if name.endswith("_s"):
        unit, factor = ("s", 1.0) if largest is not None and abs(largest) >= 1.0 else ("ms", 1e3)
        return Scale(_words(name.removesuffix("_s")), unit, factor)
    return Scale(_words(name), "")


def shown(name: str, value: float | None, sigma: float | None = None) -> Shown:
    """Label, digits and unit of a single result [SI], with its standard uncertainty if there is one."""
    found = scale(name, value)
    return Shown(found.label, found.with_sigma(value, sigma), found.unit)


def number(value: float | None) -> str:
    """Four significant digits, all digits of a whole number, a dash for None."""
    if value is None:
        return "–"
    return str(value) if isinstance(value, int) else f"{value:.4g}"


def _words(name: str) -> str:
    return name.replace("_", " ")
