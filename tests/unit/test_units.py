"""Quantities with units: what is accepted, to which value, and what an error says."""

from __future__ import annotations

import pint
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave import units
from wrinklewave.units import COMMON_UNITS, DENSITY, FREQUENCY, LENGTH, PRESSURE, TIME, VELOCITY


def test_table_of_common_units_agrees_with_pint() -> None:
    registry = pint.UnitRegistry()
    for unit, (dimension, factor) in COMMON_UNITS.items():
        by_pint = registry.Quantity(1, unit).to(dimension.si).magnitude
        assert by_pint == pytest.approx(float(factor), rel=1e-14), unit


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("90 us", TIME, 9e-5),
        ("90us", TIME, 9e-5),
        ("90 µs", TIME, 9e-5),  # micro sign
        ("90 μs", TIME, 9e-5),  # Greek mu
        ("3.35 MPa", PRESSURE, 3.35e6),
        (" 1.4e2 um ", LENGTH, 1.4e-4),
        ("965 kg / m^3", DENSITY, 965.0),
        ("965 kg/m³", DENSITY, 965.0),
        ("-10 mm/ms", VELOCITY, -10.0),
        (".5 kHz", FREQUENCY, 500.0),
    ],
)
def test_common_quantities_are_exact(text: str, dimension: units.Dimension, value: float) -> None:
    assert units.parse(text, dimension) == value


@pytest.mark.parametrize(
    ("text", "dimension", "value"),
    [
        ("1 inch", LENGTH, 0.0254),
        ("1 psi", PRESSURE, 6894.757293168),
        ("2 mile/hour", VELOCITY, 0.89408),
        ("1 lb/ft^3", DENSITY, 16.01846337396),
        ("5 1/ms", FREQUENCY, 5e3),
    ],
)
def test_other_units_by_pint(text: str, dimension: units.Dimension, value: float) -> None:
    assert units.parse(text, dimension) == pytest.approx(value, rel=1e-12)


@pytest.mark.parametrize(
    ("text", "problem", "cure"),
    [
        (10, "10 has no unit", '"10 m"'),
        ("10", '"10" has no unit', '"10 m"'),
        (True, "True is no quantity", '"2.0 mm"'),
        (None, "None is no quantity", '"2.0 mm"'),
        ("", '"" is no quantity', '"2.0 mm"'),
        ("long", '"long" is no quantity', '"2.0 mm"'),
        ("1,5 mm", '"1,5 mm" is no quantity', '"2.0 mm"'),
        ("nan m", '"nan m" is no quantity', '"2.0 mm"'),
        ("1e999 m", '"1e999 m" is not finite', '"2.0 mm"'),
        ("3 ms", '"ms" is a unit of time, not of length', '"2.0 mm"'),
        ("3 m s", '"m s" is a unit of m*s, not of length', '"2.0 mm"'),
        ("3 psi", '"psi" is a unit of kg/m/s**2, not of length', '"2.0 mm"'),
        ("3 kg", '"kg" is no unit of length', '"2.0 mm"'),
        ("3 %", '"%" is a unit of pure numbers, not of length', '"2.0 mm"'),
        ("3 Mm^", '"Mm^" is no unit', '"2.0 mm"'),
        ("3 m/0", '"m/0" is no unit', '"2.0 mm"'),
    ],
)
def test_what_is_no_length(text: object, problem: str, cure: str) -> None:
    with pytest.raises(units.UnitError) as caught:
        units.parse(text, LENGTH)
    assert str(caught.value) == problem
    assert cure in caught.value.cure


def test_radians_per_second_are_no_frequency() -> None:
    """2 pi would be lost without a word: to pint, radians have no dimension."""
    with pytest.raises(units.UnitError, match="rad/s"):
        units.parse("400 rad/s", FREQUENCY)


@pytest.mark.parametrize(
    ("value", "unit", "text"),
    [
        (131120.0, "Pa", "131.1 kPa"),
        (4.55e-5, "s", "45.50 us"),
        (-2e-3, "m", "-2.000 mm"),
        (0.125, "1", "0.1250"),
        (57.0, "m/s", "57.00 m/s"),  # no prefixes in compound units
        (123456.0, "kg/m^3", "123456 kg/m^3"),  # all digits before the point
        (0.0, "m", "0.000 m"),
        (3e-14, "m", "3.000e-05 nm"),  # beyond the prefixes
        (7.5e13, "Hz", "75000 GHz"),
    ],
)
def test_engineering_notation(value: float, unit: str, text: str) -> None:
    assert units.engineering(value, unit) == text


@given(st.floats(1e-9, 0.99e12), st.sampled_from([LENGTH, TIME, PRESSURE, FREQUENCY]))
def test_engineering_notation_reads_back(value: float, dimension: units.Dimension) -> None:
    text = units.engineering(value, dimension.si, digits=None)
    assert 1.0 <= float(text.split()[0]) < 1000.0
    assert units.parse(text, dimension) == pytest.approx(value, rel=1e-15)


@given(st.floats(allow_nan=False, allow_infinity=False))
def test_si_text_reads_back_to_the_same_float(value: float) -> None:
    assert units.parse(units.format_si(value, PRESSURE), PRESSURE) == value
