"""The case: everything that a simulation needs to know, as typed, frozen sections with SI floats."""

from __future__ import annotations

from typing import Annotated, Any, Literal

from pydantic import Field, model_validator

from wrinklewave.config.defaults import fill_defaults
from wrinklewave.config.drives import Drive
from wrinklewave.config.fields import (
    Count,
    Frequency,
    NotNegative,
    NotNegativeLength,
    NotNegativeTime,
    PositiveLength,
    PositiveTime,
    PositiveVelocity,
    Section,
    Strain,
    Window,
)
from wrinklewave.config.solids import Film, Substrate

WrinkleModel = Literal["none", "quasi-static", "rate-dependent", "resolved"]
Grading = Annotated[float, Field(ge=0.01, le=100)]


class About(Section):
    """Who this case is."""

    name: Annotated[str, Field(min_length=1, description="short name, used in titles")]
    description: Annotated[str, Field(description="free text, shown in the report")] = ""


class Block(Section):
    """The undeformed rectangular block, 0 <= x <= length; y = 0 at mid-height, the film's side up."""

    length: Annotated[PositiveLength, Field(description="L_0, along the film")]
    height: Annotated[PositiveLength, Field(description="full height H")]
    symmetry: Annotated[bool, Field(description="mesh the upper half only, u_y = 0 at mid-height")] = True

    @property
    def meshed_height(self) -> float:
        """Height of the meshed part [m]: H/2 with symmetry, else H."""
        return self.height / 2 if self.symmetry else self.height


class Wrinkles(Section):
    """Which model makes the wrinkles, and over which depth it averages the strain."""

    model: Annotated[WrinkleModel, Field(description='left out: "quasi-static" with a film, else "none"')]
    averaging_depth: Annotated[PositiveLength, Field(description="D, in the undeformed state")]
    wavelength: Annotated[
        Literal["kept", "fastest"],
        Field(
            description="of rate-dependent wrinkles: one that they keep once selected, or several of which the fastest "
            'grow; left out: "kept" with a sinusoidal imperfection, else "fastest"'
        ),
    ]


class Hourglass(Section):
    """Control of the modes that one-point integration does not see."""

    stiffness: Annotated[NotNegative, Field(description="relative to the fully integrated element's")] = 1.0


class Mesh(Section):
    """A structured mesh of quadrilaterals."""

    elements: Annotated[tuple[Count, Count], Field(description="along x, and through the meshed height")]
    element: Annotated[
        Literal["one-point", "mean-dilatation"], Field(description="kind of quadrilateral")
    ] = "one-point"
    grading: Annotated[
        tuple[Grading, Grading], Field(description="ratio of last to first element size along x and y")
    ] = (1.0, 1.0)
    hourglass: Hourglass = Hourglass()


class Boundaries(Section):
    """What holds the block, the struck end apart."""

    right: Annotated[Literal["fixed", "roller", "free"], Field(description="the end x = L_0")] = "fixed"
    top: Annotated[Literal["free", "roller"], Field(description="the surface")] = "free"
    wall: Annotated[bool, Field(description="rigid plate at x = L_0 that the surface may not cross")] = True
    slip: Annotated[
        NotNegativeLength,
        Field(description="depth below a free surface down to which a fixed right end slips along its plate"),
    ] = 0.0


class Solver(Section):
    """Time integration."""

    end_time: Annotated[PositiveTime, Field(description="simulated time")]
    safety: Annotated[float, Field(gt=0, le=1, description="fraction of the stable step")] = 0.9
    bulk_viscosity: Annotated[
        tuple[NotNegative, NotNegative], Field(description="linear and quadratic coefficient")
    ] = (0.06, 1.2)
    checkpoint_interval: Annotated[PositiveTime, Field(description="wall-clock time between checkpoints")] = (
        60.0
    )
    mass_scaling: Annotated[float, Field(ge=1, description="factor on the mass, quasi-static runs only")] = (
        1.0
    )
    precision: Annotated[
        Literal["double", "mixed"],
        Field(description="mixed: state and elements in single precision, edges and energies in double"),
    ] = "double"
    subcycling: Annotated[
        bool, Field(description="with a resolved film: steps of its own for every row of elements")
    ] = True


class Output(Section):
    """What is written, and how often (simulated time)."""

    surface_interval: Annotated[PositiveTime, Field(description="between frames of surface.nc")]
    field_interval: Annotated[PositiveTime, Field(description="between frames of fields.vtkhdf")]
    history_interval: Annotated[
        PositiveTime,
        Field(description="between rows of history.csv; a row costs two or three steps, but none at frames"),
    ]
    probes: Annotated[
        tuple[NotNegativeLength, ...], Field(description="undeformed x of the surface points in probes.csv")
    ] = ()
    pixel_size: Annotated[PositiveLength, Field(description="laboratory grid of the surface motion")]


class Analysis(Section):
    """Parameters of the analysis, those of the paper by name."""

    front_fraction: Annotated[
        Strain, Field(description="the wavefront is where U_y reaches this fraction of its maximum")
    ] = 0.1
    front_window: Annotated[Window, Field(description="x over which speeds are fitted")]
    wrinkle_threshold: Annotated[PositiveLength, Field(description="amplitude at which wrinkles are there")]
    filter_wavelength: Annotated[PositiveLength, Field(description="cutoff between wrinkles and pulse")]
    amplitude_window: Annotated[Window, Field(description="x over which amplitude and wavelength are taken")]
    positions: Annotated[tuple[NotNegativeLength, ...], Field(description="for displacement against time")]
    times: Annotated[tuple[NotNegativeTime, ...], Field(description="for displacement against position")]
    measured_front_speed: Annotated[
        PositiveVelocity | None, Field(description="c of an experiment, for the theory's delay lambda_c/c")
    ] = None
    loss_frequency: Annotated[
        Frequency | None, Field(description="for storage and loss modulus in the theory")
    ] = None


class Case(Section):
    """A whole case file, made by :func:`load_case` and :func:`case_from_text`, which check it as a whole."""

    case: About
    block: Block
    substrate: Substrate
    film: Film | None = None
    wrinkles: Wrinkles
    mesh: Mesh
    drive: Drive
    boundaries: Boundaries = Boundaries()
    solver: Solver
    output: Output
    analysis: Analysis

    @model_validator(mode="before")
    @classmethod
    def _fill_defaults(cls, data: Any) -> Any:
        return fill_defaults(data) if isinstance(data, dict) else data

    @property
    def name(self) -> str:
        """Short name of the case."""
        return self.case.name

    def to_toml(self) -> str:
        """Return the resolved case as a case file in SI units; reading it gives an equal case."""
        from wrinklewave.config.writing import toml_text

        return toml_text(self.model_dump(mode="json", exclude_none=True))

    def overridden(self, *overrides: str) -> Case:
        """Return a checked copy with values replaced, as in ``case.overridden("drive.velocity=5 m/s")``.

        Values that were derived when the case was read, such as windows in proportion to the block, stay.

        Raises:
            InputError: as :func:`load_case`.
        """
        from wrinklewave.config.reading import case_from_text

        return case_from_text(self.to_toml(), overrides=overrides, source=self.name)
