"""What a sample's surface looks like before the test: the seed of wrinkles, always explicit and recorded."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from wrinklewave.config.fields import File, NotNegativeLength, PositiveLength, Section, Window

Seed = Annotated[int, Field(ge=0, le=2**63 - 1, description="seed of the random phases")]
Amplitude = Annotated[PositiveLength, Field(description="largest height of the imperfection")]


class SinusoidalImperfection(Section):
    """Height amplitude * cos(2 pi X / wavelength)."""

    kind: Literal["sinusoidal"]
    amplitude: Amplitude
    wavelength: Annotated[PositiveLength, Field(description="in undeformed material length")]


class RandomImperfection(Section):
    """Band-limited random height: equal power between two wavelengths, random phases from ``seed``."""

    kind: Literal["random"]
    amplitude: Annotated[PositiveLength, Field(description="root-mean-square height times sqrt(2)")]
    wavelengths: Annotated[Window, Field(description="shortest and longest wavelength")]
    seed: Seed


class BumpImperfection(Section):
    """A single Gaussian bump."""

    kind: Literal["bump"]
    amplitude: Amplitude
    position: Annotated[NotNegativeLength, Field(description="undeformed x of its top")]
    width: Annotated[PositiveLength, Field(description="standard deviation of the Gaussian")]


class ProfileImperfection(Section):
    """Heights from a file with columns x_m, height_m, such as the measured surface before impact."""

    kind: Literal["profile"]
    file: Annotated[File, Field(description="CSV with columns x_m, height_m")]
    scale: Annotated[float, Field(gt=0, description="factor on the heights")] = 1.0


Imperfection = Annotated[
    SinusoidalImperfection | RandomImperfection | BumpImperfection | ProfileImperfection,
    Field(discriminator="kind"),
]
