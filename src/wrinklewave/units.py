"""Quantities with units, at the border only: ``"10 m/s"`` comes in, 10.0 goes on; inside everything is SI.

The units that case files are full of are in a table, so that reading one does not cost the import of pint;
every other unit ("inch", "psi", "kg/mm^3") goes to pint. A test holds the table against pint.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import pint


@dataclass(frozen=True)
class Dimension:
    """A kind of quantity: its name in messages, its SI unit, and what a user might write."""

    name: str
    si: str
    example: str


LENGTH = Dimension("length", "m", "2.0 mm")
TIME = Dimension("time", "s", "0.1 ms")
VELOCITY = Dimension("velocity", "m/s", "10 m/s")
DENSITY = Dimension("density", "kg/m^3", "965 kg/m^3")
PRESSURE = Dimension("pressure", "Pa", "44 kPa")
FREQUENCY = Dimension("frequency", "Hz", "400 Hz")
NUMBER = Dimension("number", "1", "0.49")

# unit -> (dimension, factor to SI); factors are decimal text, so that "90 us" is exactly the float 9e-05
COMMON_UNITS: dict[str, tuple[Dimension, str]] = {
    "m": (LENGTH, "1"),
    "cm": (LENGTH, "1e-2"),
    "mm": (LENGTH, "1e-3"),
    "um": (LENGTH, "1e-6"),
    "nm": (LENGTH, "1e-9"),
    "s": (TIME, "1"),
    "ms": (TIME, "1e-3"),
    "us": (TIME, "1e-6"),
    "ns": (TIME, "1e-9"),
    "min": (TIME, "60"),
    "h": (TIME, "3600"),
    "m/s": (VELOCITY, "1"),
    "mm/s": (VELOCITY, "1e-3"),
    "mm/ms": (VELOCITY, "1"),
    "mm/us": (VELOCITY, "1e3"),
    "km/s": (VELOCITY, "1e3"),
    "kg/m^3": (DENSITY, "1"),
    "g/cm^3": (DENSITY, "1e3"),
    "Pa": (PRESSURE, "1"),
    "kPa": (PRESSURE, "1e3"),
    "MPa": (PRESSURE, "1e6"),
    "GPa": (PRESSURE, "1e9"),
    "Hz": (FREQUENCY, "1"),
    "kHz": (FREQUENCY, "1e3"),
    "MHz": (FREQUENCY, "1e6"),
}

_QUANTITY = re.compile(r"\s*([+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d{1,4})?)(?![\d.,_])\s*(.*?)\s*")
_PREFIXES = {-9: "n", -6: "u", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}
_SPELLINGS = str.maketrans({"µ": "u", "μ": "u", "³": "^3"})
_BLANKS = re.compile(r"\s*([/^])\s*")


class UnitError(ValueError):
    """A text is not a quantity of the dimension that is wanted; ``cure`` says how to mend it."""

    def __init__(self, problem: str, cure: str) -> None:
        super().__init__(problem)
        self.cure = cure


def parse(text: object, dimension: Dimension) -> float:
    """Return the SI value of a quantity written as text, such as ``parse("140 um", LENGTH)`` = 1.4e-4.

    Raises:
        UnitError: if it is a bare number, no quantity at all, or one of another dimension.
    """
    if isinstance(text, (int, float)) and not isinstance(text, bool):
        raise UnitError(f"{text} has no unit", f'write it with one, in quotes: "{text} {dimension.si}"')
    if not isinstance(text, str):
        raise UnitError(f"{text!r} is no quantity", f'write number and unit in quotes: "{dimension.example}"')
    match = _QUANTITY.fullmatch(text)
    if match is None:
        raise UnitError(f'"{text}" is no quantity', f'write a number and a unit: "{dimension.example}"')
    number, unit = match.groups()
    if not unit:
        raise UnitError(f'"{text}" has no unit', f'write "{number} {dimension.si}"')
    value = float(Decimal(number) * Decimal(_factor(unit, dimension)))
    if not math.isfinite(value):
        raise UnitError(f'"{text}" is not finite', f'write a finite number: "{dimension.example}"')
    return value


def format_si(value: float, dimension: Dimension) -> str:
    """Return an SI value as text that :func:`parse` reads back to the same float."""
    return f"{value!r} {dimension.si}"


def engineering(value: float | Decimal, unit: str, digits: int | None = 4) -> str:
    """Return a value with an SI prefix where its unit takes one: ``131.1 kPa``, ``45.5 us``, ``0.125``.

    Args:
        value: in ``unit``; a ``Decimal`` keeps its own digits if ``digits`` is None.
        unit: SI unit, "1" for a pure number.
        digits: significant digits, None for all.
    """
    exponent = 0
    if unit in ("m", "s", "Pa", "Hz") and value and math.isfinite(value):
        exponent = min(max(3 * (Decimal(value).adjusted() // 3), -9), 9)
    scaled = Decimal(value).scaleb(-exponent)
    if digits is None:
        text = f"{scaled:f}"
    elif 1e3 <= abs(scaled) < 1e6:
        text = f"{scaled:.0f}"
    else:
        text = f"{float(scaled):#.{digits}g}".rstrip(".")
    return text if unit == "1" else f"{text} {_PREFIXES[exponent]}{unit}"


def _factor(unit: str, dimension: Dimension) -> str:
    known = COMMON_UNITS.get(_BLANKS.sub(r"\1", unit.translate(_SPELLINGS)))
    if known is None:
        return _factor_by_pint(unit, dimension)
    if known[0] != dimension:
        raise _wrong_dimension(unit, known[0].name, dimension)
    return known[1]


def _factor_by_pint(unit: str, dimension: Dimension) -> str:
    registry = _registry()
    try:
        found = registry.Quantity(1.0, registry.parse_units(unit)).to_base_units()
    except Exception as error:  # pint and the tokeniser below it raise a dozen types on text that is no unit
        raise UnitError(f'"{unit}" is no unit', _use(dimension)) from error
    # base units rather than dimensions: to pint, radians have none, and 400 rad/s would pass for 400 Hz
    if found.units != registry.Quantity(1.0, dimension.si).to_base_units().units:
        raise _wrong_dimension(unit, f"{found.units:~C}" or "pure numbers", dimension)
    return repr(float(found.magnitude))


def _wrong_dimension(unit: str, found: str, dimension: Dimension) -> UnitError:
    what = "no unit" if found == unit else f"a unit of {found}, not"
    return UnitError(f'"{unit}" is {what} of {dimension.name}', _use(dimension))


def _use(dimension: Dimension) -> str:
    return f'use a unit of {dimension.name}, as in "{dimension.example}"'


@cache
def _registry() -> pint.UnitRegistry:
    import pint

    return pint.UnitRegistry()
