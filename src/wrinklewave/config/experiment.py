"""The experiment file: what a recording shows, in the same TOML, units and errors as the case file.

Positions in the image are [column, row] in pixels as the file has them, pixel centres at whole numbers,
[0, 0] in the upper left corner. Times are those of the recording's clock: the camera's own, or counted from
the first frame at the given frame rate.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BeforeValidator, Field, PlainSerializer, model_validator

from wrinklewave import units
from wrinklewave.config.case import Analysis
from wrinklewave.config.defaults import fill_defaults
from wrinklewave.config.experiment_checks import experiment_errors
from wrinklewave.config.fields import (
    Count,
    File,
    Frequency,
    NotNegative,
    PositiveLength,
    Section,
    Strain,
    reject,
)
from wrinklewave.config.reading import read_model, read_text

Direction = Literal["right", "left", "up", "down"]
PixelPosition = tuple[NotNegative, NotNegative]
PixelRange = Annotated[tuple[int, int], Field(description="first, and the one after the last")]
HORIZONTAL = ("right", "left")


def _read_moment(value: Any) -> float | None:
    if value == "detect":
        return None
    try:
        return units.parse(value, units.TIME)
    except units.UnitError as error:
        raise reject(str(error), expected='a time with its unit, or "detect"', cure=error.cure) from error


Moment = Annotated[
    float | None,
    units.TIME,
    BeforeValidator(_read_moment),
    PlainSerializer(lambda value: units.format_si(value, units.TIME), when_used="json-unless-none"),
]
"""A time on the recording's clock; None stands for ``"detect"``."""


class About(Section):
    """What was done."""

    kind: Annotated[Literal["impact", "quasi-static"], Field(description="which procedure measures it")]
    name: Annotated[str, Field(min_length=1, description="short name, used in titles")]
    description: str = ""


class Video(Section):
    """The recording, and what its file does not say."""

    file: Annotated[File, Field(description="TIFF stack, folder of images, .cine, AVI, MP4 or MOV")]
    frame_rate: Annotated[
        Frequency | None, Field(description="of the camera; needed where the file has no camera clock")
    ] = None
    frames: Annotated[PixelRange | None, Field(description="which frames to use, all if left out")] = None
    undeformed_frames: Annotated[
        Count, Field(description="how many of them, from the first on, show the undeformed sample")
    ] = 1
    bit_depth: Annotated[
        int | None, Field(ge=8, le=16, description="significant bits, if the file stores more than it means")
    ] = None


class Calibration(Section):
    """Directions in the image: ``x_axis`` from struck to held end, ``y_axis`` out of the sample's surface."""

    x_axis: Annotated[Direction, Field(description="direction from the struck to the held end")]
    y_axis: Annotated[Direction, Field(description="direction out of the sample, away from its body")]

    @model_validator(mode="after")
    def _perpendicular(self) -> Calibration:
        if (self.x_axis in HORIZONTAL) == (self.y_axis in HORIZONTAL):
            raise reject(
                f'x_axis = "{self.x_axis}" and y_axis = "{self.y_axis}" lie along the same line',
                expected="one axis along the rows of the image, the other along its columns",
                cure='for a sample below its surface, struck from the left: x_axis = "right", y_axis = "up"',
            )
        return self


class ScaleCalibration(Calibration):
    """The size of a pixel in the plane of the surface is known."""

    kind: Literal["scale"]
    pixel_size: Annotated[PositiveLength, Field(description="metres per pixel, in the plane of the surface")]


class TwoPointCalibration(Calibration):
    """Two points in the image lie a known distance apart."""

    kind: Literal["two-points"]
    points: Annotated[tuple[PixelPosition, PixelPosition], Field(description="[column, row] of each")]
    distance: Annotated[PositiveLength, Field(description="between the two points")]

    @model_validator(mode="after")
    def _apart(self) -> TwoPointCalibration:
        if self.pixels < 2:
            raise reject(
                f"the points are {self.pixels:.3g} px apart",
                expected="two points far apart, better a hundred pixels than ten",
                cure="choose two marks near opposite sides of the image",
            )
        return self

    @property
    def pixels(self) -> float:
        """Distance between the points in pixels."""
        (column_1, row_1), (column_2, row_2) = self.points
        return float(((column_1 - column_2) ** 2 + (row_1 - row_2) ** 2) ** 0.5)

    @property
    def pixel_size(self) -> float:
        """Metres per pixel."""
        return self.distance / self.pixels


class SampleLengthCalibration(Calibration):
    """The undeformed length of the sample (``sample.length``) is the scale, seen in the first frame used."""

    kind: Literal["sample-length"]
    ends: Annotated[
        tuple[NotNegative, NotNegative] | None,
        Field(description="where struck and held end are along x_axis [px]; detected if left out"),
    ] = None

    @model_validator(mode="after")
    def _apart(self) -> SampleLengthCalibration:
        if self.ends is not None and abs(self.ends[1] - self.ends[0]) < 2:
            raise reject(
                f"the ends are {abs(self.ends[1] - self.ends[0]):.3g} px apart",
                expected="the pixel positions of both ends of the sample",
                cure="read them off the first frame, or leave ends out to have them detected",
            )
        return self


AnyCalibration = Annotated[
    ScaleCalibration | TwoPointCalibration | SampleLengthCalibration, Field(discriminator="kind")
]


class Region(Section):
    """The part of the image to look at; outside are lamps, stoppers and captions."""

    columns: Annotated[PixelRange | None, Field(description="first, and the one after the last")] = None
    rows: Annotated[PixelRange | None, Field(description="first, and the one after the last")] = None


class EdgeDetection(Section):
    """How the surface is found."""

    resolution: Annotated[
        float, Field(ge=4, le=200, description="shortest wavelength kept along the surface, in pixels")
    ] = 10.0


class Contact(Section):
    """When the striker touches the sample."""

    time: Annotated[Moment, Field(description='on the recording\'s clock, or "detect"')] = None


class Wires(Section):
    """Probe wires that stand out of the surface: material points to follow."""

    count: Annotated[Count | None, Field(description="how many to find in the undeformed frames")] = None
    positions: Annotated[
        tuple[PixelPosition, ...] | None,
        Field(min_length=1, description="[column, row] of each before impact"),
    ] = None

    @model_validator(mode="after")
    def _one_of_both(self) -> Wires:
        if (self.count is None) == (self.positions is None):
            raise reject(
                "count and positions are both given"
                if self.count
                else "neither count nor positions is given",
                expected="exactly one of count and positions",
                cure="give positions = [[column, row], ...], or count to have them found",
            )
        return self


class Sample(Section):
    """What is known of the sample."""

    length: Annotated[PositiveLength, Field(description="undeformed length L_0 along x")]
    height: Annotated[PositiveLength | None, Field(description="full height H")] = None
    critical_strain: Annotated[Strain | None, Field(description="eps_c of the film, if known")] = None
    critical_wavelength: Annotated[
        PositiveLength | None, Field(description="lambda_c of the film, undeformed length, if known")
    ] = None


class SecondSeries(Section):
    """A later quasi-static test on the same sample, compared with the first (Fig. S6)."""

    file: Annotated[File, Field(description="recording of the second test")]
    calibration: AnyCalibration | None = None


class Fit(Section):
    """Which images of a quasi-static test Eq. 1 is fitted to."""

    strains: Annotated[
        tuple[NotNegative, Strain],
        Field(
            description="smallest and largest strain; leave period doubling out, and what the film did not survive"
        ),
    ] = (0.0, 0.99)


class Experiment(Section):
    """A whole experiment file, made by :func:`load_experiment`, which checks it as a whole."""

    experiment: About
    video: Video
    calibration: AnyCalibration
    sample: Sample
    region: Region = Region()
    edge: EdgeDetection = EdgeDetection()
    contact: Contact = Contact()
    wires: Wires | None = None
    second_series: SecondSeries | None = None
    fit: Fit | None = None
    analysis: Analysis

    @model_validator(mode="before")
    @classmethod
    def _fill_defaults(cls, data: Any) -> Any:
        return {**data, "analysis": _analysis(data)} if isinstance(data, dict) else data

    @property
    def name(self) -> str:
        """Short name of the experiment."""
        return self.experiment.name

    @property
    def kind(self) -> Literal["impact", "quasi-static"]:
        """Which procedure measures it."""
        return self.experiment.kind

    @property
    def second_calibration(self) -> ScaleCalibration | TwoPointCalibration | SampleLengthCalibration:
        """The second series' calibration: the first's unless given."""
        given = self.second_series.calibration if self.second_series else None
        return given or self.calibration

    def to_toml(self) -> str:
        """Return the resolved experiment as a file in SI units; reading it gives an equal experiment."""
        from wrinklewave.config.writing import toml_text

        return toml_text(self.model_dump(mode="json", exclude_none=True))


def load_experiment(path: str | Path, overrides: Sequence[str] = ()) -> Experiment:
    """Read an experiment file, replace values by ``key=value`` overrides, complete and check it.

    Args:
        path: the TOML file; files that it names are relative to its folder.
        overrides: as for ``--set``, such as ``"video.frame_rate=50 kHz"``.

    Raises:
        InputError: naming file, key, value, what is expected and the cure; all mistakes of a file at once.
    """
    return experiment_from_text(read_text(path), overrides=overrides, source=path, folder=Path(path).parent)


def experiment_from_text(
    text: str, *, overrides: Sequence[str] = (), source: object = "experiment", folder: str | Path = "."
) -> Experiment:
    """Read an experiment from the text of an experiment file; see :func:`load_experiment`."""
    return read_model(
        Experiment, text, overrides=overrides, source=source, folder=folder, check=experiment_errors
    )


def _analysis(data: dict[str, Any]) -> Any:
    """The analysis section with the case file's defaults, in proportion to the sample.

    Times for profiles have no default: ``measure`` chooses them within the recording.
    """
    sample = data.get("sample")
    sample = sample if isinstance(sample, dict) else {}
    stand_in: dict[str, Any] = {
        "block": {"length": sample.get("length")},
        "film": {"critical_wavelength": sample["critical_wavelength"]}
        if "critical_wavelength" in sample
        else {},
        "analysis": {},
    }
    given = data.get("analysis", {})
    return {**fill_defaults(stand_in)["analysis"], "times": (), **given} if isinstance(given, dict) else given
