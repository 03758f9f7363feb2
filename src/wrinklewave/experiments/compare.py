"""Two or more surface motions, measured or simulated, held against the first of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wrinklewave.analysis.analyse import analyse
from wrinklewave.analysis.subject import Subject, subject_of
from wrinklewave.analysis.summary import sigma_name
from wrinklewave.errors import InputError
from wrinklewave.experiments.common_grid import (
    CommonGrid,
    common_grid,
    contact_times,
    cropped,
    on_one_clock,
    resample,
    resample_rows,
)
from wrinklewave.laboratory_frame import Array

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.analysis.results import Analysis
    from wrinklewave.config.case import Analysis as Settings

FEWEST_IN_WINDOW = 16
NO_RATIO = (
    "recorded_contact_time_s",
    "low_frequency_misfit_m",
    "low_frequency_misfit_share",
    "compared_share",
)


@dataclass(frozen=True, eq=False)
class ComparedMotion:
    """A surface motion on the common clock, and its analysis with the common parameters.

    Attributes:
        clock_shift: what was added to its recorded times [s].
    """

    subject: Subject
    analysis: Analysis
    clock_shift: float


@dataclass(frozen=True, eq=False)
class Ratio:
    """A quantity over the first surface motion's, while that one has wrinkles.

    Attributes:
        values: shape [n_times of the common grid], NaN where there are no wrinkles.
        mean, deviation: over these times, NaN if there are none.
    """

    values: Array
    mean: float
    deviation: float


@dataclass(frozen=True, eq=False)
class Agreement:
    """How a surface motion agrees with the first one, on the common grid.

    Attributes:
        misfit: of the displacement without wrinkles: its difference from the first one's [m], shape
            [n_times, n_x], NaN where one of them is unknown.
        misfit_rms: its root mean square over all known times and positions [m].
        misfit_share: the same over the largest displacement of the first one.
        compared_share: share of the grid on which both are known.
        amplitude, wavelength: ratios of the wrinkles' amplitude (mean of the envelope in the window) and
            wavelength.
    """

    misfit: Array
    misfit_rms: float
    misfit_share: float
    compared_share: float
    amplitude: Ratio
    wavelength: Ratio


@dataclass(frozen=True)
class Quantity:
    """A row of the table: one number of each surface motion, None where it has none.

    Attributes:
        name: with its unit, as in ``summary.json``.
        values, sigmas: of each, in the order of the surface motions.
        ratios: values over the first one's; None where that says nothing.
    """

    name: str
    values: tuple[float | None, ...]
    sigmas: tuple[float | None, ...]
    ratios: tuple[float | None, ...]


@dataclass(frozen=True, eq=False)
class Comparison:
    """Results of ``compare``.

    Attributes:
        settings: parameters of the analysis, the same for all.
        aligned: whether all clocks were set by the contact.
        grid: times and positions in common.
        motions: by name; the first is the reference.
        agreements: of the others with the first, by name.
        quantities: the table.
    """

    settings: Settings
    aligned: bool
    grid: CommonGrid
    motions: Mapping[str, ComparedMotion]
    agreements: Mapping[str, Agreement]
    quantities: tuple[Quantity, ...]

    def as_json(self) -> dict[str, Any]:
        """Table and settings as plain dictionaries."""
        return {
            "motions": [
                {"name": name, "kind": motion.subject.kind, "clock_shift_s": motion.clock_shift}
                for name, motion in self.motions.items()
            ],
            "clocks_set_by_contact": self.aligned,
            "common_time_s": _range(self.grid.time),
            "common_x_m": _range(self.grid.x),
            "analysis": self.settings.model_dump(mode="json", exclude_none=True),
            "quantities": [asdict(quantity) for quantity in self.quantities],
        }


def compare(surfaces: Mapping[str, xr.Dataset], settings: Settings) -> Comparison:
    """Hold surface motions against the first of them.

    Their clocks are set so that all make contact (the struck end has moved by 50 um) when the first one does.
    Then all are analysed with the same parameters over the times and positions that they share: a maximum
    over a longer record is another quantity. Fields are subtracted after linear interpolation to a grid as
    coarse as the coarsest of them.

    Args:
        surfaces: at least two surface motions by name.
        settings: the section ``analysis`` of a case or an experiment.

    Raises:
        InputError: if there are fewer than two, one cannot be analysed with these parameters, or they share
            no time or no positions.
    """
    if len(surfaces) < 2:
        raise InputError(f"{len(surfaces)} surface motion", expected="at least two to compare")
    contacts = contact_times(surfaces)
    shifted = on_one_clock(surfaces)
    grid = common_grid(shifted)
    _check_window(grid, settings)
    motions = {name: _motion(cropped(surface, grid), settings) for name, surface in shifted.items()}
    first, *others = motions
    agreements = {name: _agreement(motions[name], motions[first], grid, settings) for name in others}
    return Comparison(
        settings=settings,
        aligned=bool(np.isfinite(contacts).all()),
        grid=grid,
        motions=motions,
        agreements=agreements,
        quantities=(*_quantities(motions, contacts), *_agreement_quantities(agreements)),
    )


def _motion(surface: xr.Dataset, settings: Settings) -> ComparedMotion:
    return ComparedMotion(subject_of(surface), analyse(surface, settings), surface.attrs["clock_shift"])


def _agreement(
    motion: ComparedMotion, first: ComparedMotion, grid: CommonGrid, settings: Settings
) -> Agreement:
    reference, other = (
        resample(m.analysis.pulse.displacement, m.subject.time, m.subject.x, grid) for m in (first, motion)
    )
    misfit = other - reference
    known = np.isfinite(misfit)
    rms = float(np.sqrt(np.mean(misfit[known] ** 2))) if known.any() else float("nan")
    largest = np.fmax.reduce(np.abs(reference), axis=None)
    amplitude, reference_amplitude, wavelength, reference_wavelength = (
        resample_rows(values, m.subject.time, grid.time)
        for m, values in (
            (motion, motion.analysis.wrinkles.amplitude),
            (first, first.analysis.wrinkles.amplitude),
            (motion, motion.analysis.wrinkles.spectra.peak),
            (first, first.analysis.wrinkles.spectra.peak),
        )
    )
    wrinkled = reference_amplitude >= settings.wrinkle_threshold
    return Agreement(
        misfit=misfit,
        misfit_rms=rms,
        misfit_share=rms / largest if largest > 0 else float("nan"),
        compared_share=float(known.mean()),
        amplitude=_ratio(amplitude, reference_amplitude, wrinkled),
        wavelength=_ratio(wavelength, reference_wavelength, wrinkled),
    )


def _ratio(values: Array, reference: Array, wrinkled: NDArray[np.bool_]) -> Ratio:
    ratio = np.divide(values, reference, out=np.full(values.shape, np.nan), where=wrinkled)
    known = ratio[np.isfinite(ratio)]
    if not known.size:
        return Ratio(ratio, float("nan"), float("nan"))
    return Ratio(ratio, float(known.mean()), float(known.std()))


def _quantities(motions: Mapping[str, ComparedMotion], contacts: tuple[float, ...]) -> tuple[Quantity, ...]:
    """What at least two of the analyses have in common; a name with ``_sigma`` in it goes with one without."""
    summaries = [motion.analysis.summary for motion in motions.values()]
    names = dict.fromkeys(name for summary in summaries for name in summary)
    rows = [
        _quantity("recorded_contact_time_s", [_known(value) for value in contacts], [None] * len(contacts))
    ]
    for name in names:
        values = [summary.get(name) for summary in summaries]
        if "_sigma_" in name or name == "contact_time_s" or sum(value is not None for value in values) < 2:
            continue
        rows.append(_quantity(name, values, [summary.get(sigma_name(name)) for summary in summaries]))
    return tuple(rows)


def _agreement_quantities(agreements: Mapping[str, Agreement]) -> tuple[Quantity, ...]:
    found = list(agreements.values())
    return tuple(
        _quantity(name, [None, *values], [None, *sigmas])
        for name, values, sigmas in (
            ("low_frequency_misfit_m", [_known(a.misfit_rms) for a in found], [None] * len(found)),
            ("low_frequency_misfit_share", [_known(a.misfit_share) for a in found], [None] * len(found)),
            ("compared_share", [a.compared_share for a in found], [None] * len(found)),
            (
                "wrinkle_amplitude_ratio",
                [_known(a.amplitude.mean) for a in found],
                [_known(a.amplitude.deviation) for a in found],
            ),
            (
                "wavelength_ratio",
                [_known(a.wavelength.mean) for a in found],
                [_known(a.wavelength.deviation) for a in found],
            ),
        )
    )


def _quantity(name: str, values: list[float | None], sigmas: list[float | None]) -> Quantity:
    reference = values[0]
    ratios = [
        None if name in NO_RATIO or not reference or value is None else value / reference for value in values
    ]
    return Quantity(name, tuple(values), tuple(sigmas), tuple(ratios))


def _check_window(grid: CommonGrid, settings: Settings) -> None:
    """Wrinkles must be seen in the window."""
    low, high = settings.amplitude_window
    if ((grid.x >= low) & (grid.x <= high)).sum() < FEWEST_IN_WINDOW:
        raise InputError(
            f"{1e3 * low:.4g} to {1e3 * high:.4g} mm hardly overlaps the positions that all share, "
            f"{1e3 * grid.x[0]:.4g} to {1e3 * grid.x[-1]:.4g} mm",
            key="analysis.amplitude_window",
            expected=f"at least {FEWEST_IN_WINDOW} of these positions",
            cure='choose another, as in --set \'analysis.amplitude_window=["5 mm", "20 mm"]\'',
        )


def _known(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _range(axis: Array) -> dict[str, float]:
    return {"from": float(axis[0]), "to": float(axis[-1]), "step": float(axis[1] - axis[0])}
