"""How well the wrinkling models agree: one impact with a resolved film, and with each model on the substrate alone.

Amplitudes are compared at material points, away from both ends, where wrinkles have grown noticeably.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.analyse import analyse
from wrinklewave.analysis.fronts import arrival_times
from wrinklewave.analysis.wrinkles import analytic_signal
from wrinklewave.config import Case, case_from_text
from wrinklewave.errors import InputError
from wrinklewave.experiments.resolved_surface import resolved_wrinkles
from wrinklewave.experiments.simulate import simulate
from wrinklewave.experiments.simulated_surface import rewrinkled
from wrinklewave.experiments.wrinkle_models import surface_strain
from wrinklewave.experiments.wrinkle_seeds import model_wavelength

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.laboratory_frame import Array

MODELS = ("resolved", "rate-dependent", "quasi-static")
MATERIAL_WINDOW = (0.2, 0.8)
"""Of the block's length: undeformed positions that are compared."""
NOTICEABLE_GROWTH = 1.2
"""Amplitudes are compared once the resolved one is this many times the imperfection."""
ONSET_GROWTH = 2.0
"""Wrinkles have set in where their amplitude is this many times the imperfection."""
FAINT = 0.5
"""Of the mean amplitude: what is fainter in a random pattern is no measure of a model."""
POINTS = 121


@dataclass(frozen=True, eq=False)
class Member:
    """One member of the study: a name, and the surface motion under each of :data:`MODELS`."""

    name: str
    case: Case
    surfaces: dict[str, xr.Dataset]


@dataclass(frozen=True)
class Agreement:
    """A model against the resolved film.

    Args:
        median, low, high: of its amplitude over the resolved one, with the 5th and 95th percentile over points and
            times.
        mean: the same of amplitudes averaged over the points, the median over times.
        onset: median over the points of the ratio of the times at which the amplitude has doubled.
    """

    median: float
    low: float
    high: float
    mean: float
    onset: float


@dataclass(frozen=True)
class Delay:
    """How wrinkles follow the strain below them in a resolved film, medians over the points.

    Args:
        strain: of the surface where and when the amplitude has doubled.
        delay: from the critical strain to then [s].
        spread: of the delay, 5 to 95 % of the points [s].
        phase_shift: of the crests against the material from then to the end, root mean square [m].
    """

    strain: float
    delay: float
    spread: tuple[float, float]
    phase_shift: float


def run_member(name: str, case: Case, substrate: xr.Dataset, *, out: Path) -> Member:
    """Simulate a resolved case, or read what an earlier run left in ``out``, and put the models beside it.

    Args:
        name: of the member.
        case: with ``wrinkles.model = "resolved"``.
        substrate: surface motion of the same impact without a film, at least as long.
        out: folder of the run.

    Raises:
        InputError, RunError: as :func:`wrinklewave.experiments.simulate.simulate`.
    """
    resolved = surface_of_run(case, out)
    surfaces = {"resolved": resolved}
    alone = substrate.isel(time=slice(0, resolved.sizes["time"]))
    for model in MODELS[1:]:
        surfaces[model] = rewrinkled(alone, case.overridden(f"wrinkles.model={model}"))
    return Member(name, case, surfaces)


def surface_of_run(case: Case, out: Path) -> xr.Dataset:
    """Surface motion of a case: of the finished run of the same case in ``out``, or of a new one."""
    from wrinklewave import surface

    if _finished(case, out):
        return surface.read(out / "surface.nc")
    run = simulate(case, out=out, overwrite=True, threads=1)
    assert run.surface is not None  # it was not interrupted, or an exception would have left this function
    return run.surface


def _finished(case: Case, out: Path) -> bool:
    """Whether ``out`` holds a run of the same case, newer than the files that the case names."""
    result, same = out / "surface.nc", out / "case.toml"
    try:
        if not result.exists() or case_from_text(same.read_text(encoding="utf-8"), source=same) != case:
            return False
    except InputError:  # a run of another version, whose case is none any more
        return False
    named = [getattr(case.drive, "file", None), getattr(case.film and case.film.imperfection, "file", None)]
    return all(Path(file).stat().st_mtime <= result.stat().st_mtime for file in named if file is not None)


def amplitudes(member: Member, model: str, X: Array) -> Array:
    """Amplitude [m] under a model at material points ``X`` [m], at its output times, shape [n_times, n_points]."""
    data = member.surfaces[model]
    return np.stack([np.interp(X, data["X"].values, row) for row in data["amplitude"].values])


def compared_points(member: Member) -> Array:
    """Undeformed positions [m] at which models are compared."""
    return np.linspace(*MATERIAL_WINDOW, POINTS) * member.case.block.length


def agreement(member: Member, model: str) -> Agreement:
    """How a model compares with the resolved film."""
    X = compared_points(member)
    reference, other = amplitudes(member, "resolved", X), amplitudes(member, model, X)
    grown = (reference > NOTICEABLE_GROWTH * reference[0]) & (
        reference > FAINT * reference.mean(axis=1, keepdims=True)
    )
    ratio = other[grown] / reference[grown]
    means = other.mean(axis=1) / reference.mean(axis=1)
    late = reference.mean(axis=1) > NOTICEABLE_GROWTH * reference[0].mean()
    onset = _onsets(member, other) / _onsets(member, reference)
    median, low, high = (float(value) for value in np.percentile(ratio, [50, 5, 95]))
    return Agreement(median, low, high, float(np.median(means[late])), _median(onset))


def delay(member: Member) -> Delay:
    """When wrinkles of the resolved film set in after the strain has become critical, and whether they stay put."""
    assert member.case.film is not None
    assert member.case.film.critical_strain is not None  # the study's case gives it
    data, X = member.surfaces["resolved"], compared_points(member)
    time, nodes = data["time"].values, data["X"].values
    cutoff = member.case.analysis.filter_wavelength
    strain = surface_strain(nodes, data["x_p"].values, data["y_p"].values, filter_wavelength=cutoff)
    strain = np.stack([np.interp(X, nodes, row) for row in strain])
    onset = _onsets(member, amplitudes(member, "resolved", X))
    critical = arrival_times(time, strain, member.case.film.critical_strain)
    there = np.array([np.interp(t, time, column) for t, column in zip(onset, strain.T, strict=True)])
    behind = onset - critical
    low, high = (
        (float(value) for value in np.nanpercentile(behind, [5, 95]))
        if np.isfinite(behind).any()
        else (np.nan,) * 2
    )
    return Delay(_median(there), _median(behind), (low, high), _phase_shift(member, onset, X))


def _onsets(member: Member, amplitude: Array) -> Array:
    """When the amplitude [n_times, n_points] has doubled at each point [s], NaN where it never does."""
    time = member.surfaces["resolved"]["time"].values
    return arrival_times(time, amplitude, ONSET_GROWTH * amplitude[0])


def _phase_shift(member: Member, onset: Array, X: Array) -> float:
    """Root mean square over points of how far crests have moved along the material from onset to the end [m]."""
    data, wavelength = member.surfaces["resolved"], model_wavelength(member.case)
    nodes, time = data["X"].values, data["time"].values
    wrinkles = resolved_wrinkles(
        nodes,
        data["x_p"].values,
        data["y_p"].values,
        filter_wavelength=member.case.analysis.filter_wavelength,
    )
    wave = analytic_signal(wrinkles.height) * np.exp(-2j * np.pi / wavelength * nodes)
    columns = np.searchsorted(nodes, X)
    known = np.isfinite(onset)
    rows = np.searchsorted(time, onset[known])
    turned = np.angle(wave[-1, columns[known]] / wave[rows, columns[known]])
    return float(np.sqrt((turned**2).mean())) / (2 * np.pi) * wavelength if known.any() else float("nan")


def member_rows(member: Member) -> list[dict[str, str | float]]:
    """One row per model: what the paper reports of its experiment, from the common analysis."""
    late = delay(member)
    rows: list[dict[str, str | float]] = []
    expected = None
    for model in reversed(MODELS):  # the quasi-static one first: the others are measured by it
        summary = analyse(member.surfaces[model], member.case.analysis).summary
        expected = expected or summary
        fit = agreement(member, model)
        number = {key: _number(summary, key) for key in SUMMARY_KEYS}
        row: dict[str, str | float] = {"member": member.name, "model": model} | number
        row["amplitude_over_quasi_static"] = number["wrinkle_amplitude_max_m"] / _number(
            expected, "wrinkle_amplitude_max_m"
        )
        uncertain = [
            _number(summary, f"{front}_speed_sigma_m_per_s") / number[f"{front}_speed_m_per_s"]
            for front in ("wrinkle", "wavefront")
        ]
        row["wrinkle_to_wavefront_speed_ratio_sigma"] = number[
            "wrinkle_to_wavefront_speed_ratio"
        ] * math.hypot(*uncertain)
        row["origin_line_speed_ratio"] = (
            number["wrinkle_speed_origin_line_m_per_s"] / number["wavefront_speed_origin_line_m_per_s"]
        )
        row |= {
            "over_resolved_median": fit.median,
            "over_resolved_5_percent": fit.low,
            "over_resolved_95_percent": fit.high,
            "mean_over_resolved": fit.mean,
            "onset_over_resolved": fit.onset,
        }
        if model == "resolved":
            row |= {
                "strain_at_onset": late.strain,
                "onset_delay_s": late.delay,
                "onset_delay_5_percent_s": late.spread[0],
                "onset_delay_95_percent_s": late.spread[1],
                "crest_shift_rms_m": late.phase_shift,
            }
        rows.append(row)
    return rows[::-1]


SUMMARY_KEYS = (
    "wavefront_speed_m_per_s",
    "wrinkle_speed_m_per_s",
    "wrinkle_to_wavefront_speed_ratio",
    "wavefront_speed_origin_line_m_per_s",
    "wrinkle_speed_origin_line_m_per_s",
    "wrinkle_amplitude_max_m",
    "wrinkle_amplitude_over_expected",
    "wavelength_m",
    "wavelength_over_expected",
)


def _number(summary: Mapping[str, object], key: str) -> float:
    value = summary.get(key)
    return float(value) if isinstance(value, int | float) else float("nan")


def _median(values: Array) -> float:
    known = values[np.isfinite(values)]
    return float(np.median(known)) if known.size else float("nan")
