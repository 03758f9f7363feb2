"""The substrate and the film: what a case file says about materials."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from wrinklewave.config.fields import (
    Count,
    Density,
    NotNegativeLength,
    NotNegativePressure,
    PoissonRatio,
    PositiveLength,
    PositivePressure,
    PositiveTime,
    Section,
    Strain,
    reject,
)
from wrinklewave.config.imperfections import Imperfection

BulkResponse = Literal["elastic-long-term", "elastic-instantaneous", "relaxing", "custom"]


class PronyTerm(Section):
    """One relaxing share of the moduli: mu(t) = mu_0 + sum_k mu_k exp(-t/tau_k), and likewise K(t)."""

    shear_modulus: Annotated[NotNegativePressure, Field(description="mu_k, the share of this term")]
    relaxation_time: Annotated[PositiveTime, Field(description="tau_k")]
    bulk_modulus: Annotated[
        NotNegativePressure | None, Field(description='K_k; only with bulk_response = "custom"')
    ] = None


class Solid(Section):
    """What substrate and film have in common."""

    law: Annotated[Literal["neo-hookean"], Field(description="hyperelastic law")] = "neo-hookean"
    bulk_response: Annotated[
        BulkResponse,
        Field(description="which bulk modulus, and does it relax; no default for a material that does"),
    ] = "elastic-long-term"
    prony: Annotated[
        tuple[PronyTerm, ...], Field(description="relaxing shares, none for an elastic solid")
    ] = ()

    @model_validator(mode="after")
    def _bulk_modulus_of_every_term_or_of_none(self) -> Self:
        custom = self.bulk_response == "custom"
        for number, term in enumerate(self.prony):
            if custom and term.bulk_modulus is None:
                raise reject(
                    f"prony term {number} has no bulk_modulus",
                    expected='with bulk_response = "custom" every term has its own bulk_modulus',
                    cure='add it to each term; "0 Pa" for one that does not relax in bulk',
                )
            if not custom and term.bulk_modulus is not None:
                raise reject(
                    f'prony term {number} has a bulk_modulus, but bulk_response is "{self.bulk_response}"',
                    expected='a bulk_modulus in the terms only with bulk_response = "custom"',
                    cure='set bulk_response = "custom", or drop bulk_modulus from the terms',
                )
        return self


class Substrate(Solid):
    """The soft block. Exactly one of ``poisson_ratio`` and ``bulk_modulus`` (long-term values) is given."""

    density: Annotated[Density, Field(description="mass density before deformation")]
    shear_modulus: Annotated[PositivePressure, Field(description="long-term mu_0")]
    poisson_ratio: Annotated[PoissonRatio | None, Field(description="long-term nu")] = None
    bulk_modulus: Annotated[PositivePressure | None, Field(description="long-term K_0")] = None

    @model_validator(mode="after")
    def _one_compressibility(self) -> Self:
        given = [name for name in ("poisson_ratio", "bulk_modulus") if getattr(self, name) is not None]
        if len(given) != 1:
            raise reject(
                "both poisson_ratio and bulk_modulus are given" if given else "no compressibility is given",
                expected="exactly one of poisson_ratio and bulk_modulus (long-term values)",
                cure="drop one of the two" if given else "add, for instance, poisson_ratio = 0.49",
            )
        return self

    @model_validator(mode="after")
    def _bulk_response_is_chosen(self) -> Self:
        if self.prony and "bulk_response" not in self.model_fields_set:
            raise reject(
                "the material relaxes, but bulk_response is not given",
                expected='"elastic-long-term", "elastic-instantaneous", "relaxing" or "custom"',
                cure='choose one, the wave speeds depend on it; the paper case has "elastic-long-term"',
            )
        return self


class Film(Solid):
    """The stiff film on the surface: measured wrinkling, and what a resolved film needs beyond it.

    ``poisson_ratio``, ``density`` and ``bulk_response`` are the substrate's unless given.
    """

    thickness: Annotated[PositiveLength, Field(description="h")]
    critical_strain: Annotated[
        Strain | None, Field(description="measured eps_c, nominal, compression > 0")
    ] = None
    critical_wavelength: Annotated[
        PositiveLength | None, Field(description="measured lambda_c, undeformed material length")
    ] = None
    shear_modulus: Annotated[PositivePressure | None, Field(description="long-term film modulus")] = None
    modulus_from: Annotated[
        Literal["critical_strain", "critical_wavelength"] | None,
        Field(description="derive the film modulus from what was measured"),
    ] = None
    poisson_ratio: Annotated[PoissonRatio, Field(description="long-term nu of the film")]
    density: Annotated[Density, Field(description="mass density of the film")]
    end_gap: Annotated[NotNegativeLength, Field(description="the film ends this far before the held end")] = (
        0.0
    )
    elements_through_thickness: Annotated[Count, Field(description="elements through the film")] = 4
    imperfection: Annotated[Imperfection | None, Field(description="what the sample brings along")] = None

    @model_validator(mode="after")
    def _one_modulus(self) -> Self:
        if self.shear_modulus is not None and self.modulus_from is not None:
            raise reject(
                "both shear_modulus and modulus_from are given",
                expected="at most one of the two",
                cure="drop one of them",
            )
        if self.modulus_from is not None and getattr(self, self.modulus_from) is None:
            raise reject(
                f'modulus_from = "{self.modulus_from}", but {self.modulus_from} is not given',
                expected="what the modulus is to be derived from",
                cure=f"add the measured {self.modulus_from}",
            )
        return self
