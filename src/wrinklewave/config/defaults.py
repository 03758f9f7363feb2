"""Values that a case file may leave out because they follow from others: sizes in proportion to the block.

They are filled in before validation, so that the resolved case names every one of them.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from wrinklewave import units
from wrinklewave.units import LENGTH, PRESSURE, TIME, Dimension

Table = Mapping[str, Any]


def fill_defaults(data: Table) -> dict[str, Any]:
    """Return the raw case with the missing values that follow from others; given values stay as they are."""
    filled = dict(data)
    length, height = _si(data, "block", "length", LENGTH), _si(data, "block", "height", LENGTH)
    end = _si(data, "solver", "end_time", TIME)
    wavelength = _si(data, "film", "critical_wavelength", LENGTH, otherwise=length / 25)
    derived: dict[str, dict[str, Any]] = {
        "case": {"name": "unnamed"},
        "wrinkles": {
            "model": "quasi-static" if "film" in data else "none",
            "averaging_depth": _m(height / 2),
            "wavelength": "kept" if _imperfection(data) in (None, "sinusoidal") else "fastest",
        },
        "output": {
            "surface_interval": _s(end / 500),
            "field_interval": _s(end / 50),
            "history_interval": _s(end / 500),  # energies are computed at every surface frame in any case
            "pixel_size": _m(length / 1000),
        },
        "analysis": {
            "front_window": (_m(0.25 * length), _m(0.8 * length)),
            "wrinkle_threshold": _m(wavelength / 40),
            "filter_wavelength": _m(2.5 * wavelength),
            "amplitude_window": (_m(length / 3), _m(0.95 * length)),
            "positions": (_m(0.3 * length), _m(0.5 * length), _m(0.9 * length)),
            "times": (_s(0.1 * end), _s(0.25 * end), _s(0.7 * end)),
        },
    }
    if "film" in data:
        derived["film"] = _from_substrate(data.get("substrate"))
    for name, values in derived.items():
        section = data.get(name, {})
        if isinstance(section, Mapping):
            filled[name] = {**values, **section}
    return filled


def _imperfection(data: Table) -> object:
    """Kind of the film's imperfection, None without one."""
    film = data.get("film")
    given = film.get("imperfection") if isinstance(film, Mapping) else None
    return given.get("kind") if isinstance(given, Mapping) else None


def _from_substrate(substrate: object) -> dict[str, Any]:
    """The film's values that are the substrate's unless given; one missing there is an error anyway."""
    given = substrate if isinstance(substrate, Mapping) else {}
    return {
        "poisson_ratio": given.get("poisson_ratio", _poisson_ratio(given)),
        "density": given.get("density", "1 kg/m^3"),
        "bulk_response": given.get("bulk_response", "elastic-long-term"),
    }


def _poisson_ratio(substrate: Table) -> float:
    """nu = (3K - 2mu)/(2(3K + mu)) of a substrate that gives its bulk modulus."""
    mu = _si({"substrate": substrate}, "substrate", "shear_modulus", PRESSURE)
    K = _si({"substrate": substrate}, "substrate", "bulk_modulus", PRESSURE)
    return (3 * K - 2 * mu) / (2 * (3 * K + mu))


def _si(data: Table, section: str, key: str, dimension: Dimension, *, otherwise: float = 1.0) -> float:
    """SI value of a quantity; where it is missing or wrong any number will do: validation says so later."""
    table = data.get(section)
    try:
        return units.parse(table[key], dimension) if isinstance(table, Mapping) else otherwise
    except (KeyError, units.UnitError):
        return otherwise


def _m(value: float) -> str:
    return units.format_si(_rounded(value), LENGTH)


def _s(value: float) -> str:
    return units.format_si(_rounded(value), TIME)


def _rounded(value: float) -> float:
    """Without the last digits that a product leaves behind: 0.04536, not 0.045360000000000004."""
    return float(f"{value:.12g}")
