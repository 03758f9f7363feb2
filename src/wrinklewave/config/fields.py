"""The types of a case file's values: quantities with units outside, SI floats inside."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated, Any

from pydantic import (
    AfterValidator,
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PlainSerializer,
    ValidationInfo,
)
from pydantic_core import PydanticCustomError

from wrinklewave import units
from wrinklewave.units import Dimension


class Section(BaseModel):
    """A table of a case file: typed, frozen, no unknown keys, no silent conversions, no NaN."""

    model_config = ConfigDict(frozen=True, extra="forbid", strict=True, allow_inf_nan=False)


def reject(problem: str, *, expected: str = "", cure: str = "") -> PydanticCustomError:
    """Return the error that a validator raises; its parts become those of an ``InputError``."""
    return PydanticCustomError(
        "rejected", "{problem}", {"problem": problem, "expected": expected, "cure": cure}
    )


def _reader(dimension: Dimension) -> BeforeValidator:
    def read(value: Any) -> float:
        try:
            return units.parse(value, dimension)
        except units.UnitError as error:
            raise reject(str(error), expected=f"a {dimension.name} with its unit", cure=error.cure) from error

    return BeforeValidator(read)


def _writer(dimension: Dimension) -> PlainSerializer:
    return PlainSerializer(lambda value: units.format_si(value, dimension), when_used="json-unless-none")


def _from_folder(file: Path, info: ValidationInfo) -> Path:
    """A file that a case names is relative to the folder of the case."""
    return Path((info.context or {}).get("folder", ".")).absolute() / file


File = Annotated[Path, Field(strict=False), AfterValidator(_from_folder)]

Length = Annotated[float, units.LENGTH, _reader(units.LENGTH), _writer(units.LENGTH)]
Time = Annotated[float, units.TIME, _reader(units.TIME), _writer(units.TIME)]
Velocity = Annotated[float, units.VELOCITY, _reader(units.VELOCITY), _writer(units.VELOCITY)]
Density = Annotated[float, units.DENSITY, _reader(units.DENSITY), _writer(units.DENSITY), Field(gt=0)]
Pressure = Annotated[float, units.PRESSURE, _reader(units.PRESSURE), _writer(units.PRESSURE)]
Frequency = Annotated[float, units.FREQUENCY, _reader(units.FREQUENCY), _writer(units.FREQUENCY), Field(gt=0)]

PositiveLength = Annotated[Length, Field(gt=0)]
NotNegativeLength = Annotated[Length, Field(ge=0)]
PositiveTime = Annotated[Time, Field(gt=0)]
NotNegativeTime = Annotated[Time, Field(ge=0)]
PositiveVelocity = Annotated[Velocity, Field(gt=0)]
PositivePressure = Annotated[Pressure, Field(gt=0)]
NotNegativePressure = Annotated[Pressure, Field(ge=0)]

Positive = Annotated[float, Field(gt=0)]
NotNegative = Annotated[float, Field(ge=0)]
Strain = Annotated[float, Field(gt=0, lt=1)]
PoissonRatio = Annotated[float, Field(gt=-1, lt=0.5)]
Count = Annotated[int, Field(ge=1)]
Window = tuple[NotNegativeLength, NotNegativeLength]
