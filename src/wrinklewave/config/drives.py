"""What moves the struck end of the block: one section per kind of drive."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from wrinklewave.config.fields import (
    File,
    NotNegative,
    NotNegativeTime,
    PositiveLength,
    PositiveTime,
    PositiveVelocity,
    Section,
    Strain,
)

Speed = Annotated[PositiveVelocity, Field(description="speed towards the held end")]
RiseTime = Annotated[
    NotNegativeTime,
    Field(description="time in which the speed is reached; a striker also loses it in this time"),
]
StopDistance = Annotated[PositiveLength, Field(description="travel at which the stoppers halt the plate")]


class StrikerDrive(Section):
    """A rigid plate in unilateral contact with the struck end; the block may lift off."""

    kind: Literal["striker"]
    velocity: Speed
    rise_time: RiseTime
    stop_distance: StopDistance
    friction: Annotated[NotNegative, Field(description="Coulomb coefficient of the contact")] = 0.0


class EndMotionDrive(Section):
    """The end moves at ``velocity`` to ``stop_distance``, then slowly on to ``overshoot``.

    The overshoot takes ``overshoot_time``; a Gaussian of width ``smoothing`` smooths the whole motion.
    """

    kind: Literal["end-motion"]
    velocity: Speed
    stop_distance: StopDistance
    overshoot: Annotated[PositiveLength, Field(description="final travel, at least stop_distance")]
    overshoot_time: Annotated[PositiveTime, Field(description="time from stop_distance to overshoot")]
    smoothing: Annotated[NotNegativeTime, Field(description="standard deviation of the Gaussian")] = 0.0
    transverse: Annotated[
        Literal["free", "held", "linear"], Field(description="transverse motion of the end's nodes")
    ] = "free"


class HistoryDrive(Section):
    """The end follows a measured history: columns time_s, u_x_m and, if known, u_y_m of the top corner."""

    kind: Literal["history"]
    file: Annotated[File, Field(description="CSV with columns time_s, u_x_m[, u_y_m]")]
    smoothing: Annotated[NotNegativeTime, Field(description="standard deviation of the Gaussian")] = 0.0


class CompressionDrive(Section):
    """Quasi-static compression: the end moves by ``strain`` times the length along a cosine ramp."""

    kind: Literal["compression"]
    strain: Annotated[Strain, Field(description="largest nominal strain")]
    duration: Annotated[PositiveTime, Field(description="of the ramp")]
    unload: Annotated[bool, Field(description="return to zero along the same ramp")] = False


class VelocityStepDrive(Section):
    """The end plane moves at constant velocity for ever: plane waves."""

    kind: Literal["velocity-step"]
    velocity: Speed
    rise_time: RiseTime = 0.0


Drive = Annotated[
    StrikerDrive | EndMotionDrive | HistoryDrive | CompressionDrive | VelocityStepDrive,
    Field(discriminator="kind"),
]
