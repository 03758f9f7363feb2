"""How well the wrinkling models agree: one impact with a resolved film, and with each model on the substrate alone.

Amplitudes are compared at material points, away from both ends, where wrinkles have grown noticeably.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from wrinklewave.analysis.analyse import analyse
from wrinklewave.analysis.fronts import arrival_times
from wrinklewave.config import Case
from wrinklewave.experiments.simulate import simulate
from wrinklewave.experiments.simulated_surface import rewrinkled

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.laboratory_frame import Array

MODELS = ("resolved", "rate-dependent", "quasi-static")
MATERIAL_WINDOW = (0.2, 0.8)
"""Of the block's length: undeformed positions that are compared."""
NOTICEABLE_GROWTH = 1.2
"""Amplitudes are compared once the resolved one is this many times the imperfection."""


@dataclass(frozen=True, eq=False)
class Member:
    """One member of the study: a name, and the surface motion under each of :data:`MODELS`."""

    name: str
    case: Case
    surfaces: dict[str, xr.Dataset]


@dataclass(frozen=True)
class Agreement:
    """A model's amplitude over the resolved one: median, 5th and 95th percentile over points and times.

    ``onset_median`` is the median over the points of the ratio of the times at which the threshold is passed.
    """

    median: float
    low: float
    high: float
    onset_median: float


def run_member(name: str, case: Case, substrate: xr.Dataset, *, out: Path) -> Member:
    """Simulate a resolved case, or read what an earlier run left in ``out``, and put the models beside it.

    Args:
        name: of the member.
        case: with ``wrinkles.model = "resolved"``.
        substrate: surface motion of the same impact without a film.
        out: folder of the run.

    Raises:
        InputError, RunError: as :func:`wrinklewave.experiments.simulate.simulate`.
    """
    surfaces = {"resolved": surface_of_run(case, out)}
    for model in MODELS[1:]:
        surfaces[model] = rewrinkled(substrate, case.overridden(f"wrinkles.model={model}"))
    return Member(name, case, surfaces)


def surface_of_run(case: Case, out: Path) -> xr.Dataset:
    """Surface motion of a case: of the finished run of the same case in ``out``, or of a new one."""
    from wrinklewave import surface

    finished, same = out / "surface.nc", out / "case.toml"
    if finished.exists() and same.read_text(encoding="utf-8") == case.to_toml():
        return surface.read(finished)
    run = simulate(case, out=out, overwrite=True)
    assert run.surface is not None  # it was not interrupted, or an exception would have left this function
    return run.surface


def amplitudes(member: Member, model: str, X: Array) -> Array:
    """Amplitude [m] under a model at material points ``X`` [m], at its output times, shape [n_times, n_points]."""
    data = member.surfaces[model]
    return np.stack([np.interp(X, data["X"].values, row) for row in data["amplitude"].values])


def agreement(member: Member, model: str, *, n_points: int = 121) -> Agreement:
    """How a model compares with the resolved film."""
    X = np.linspace(*MATERIAL_WINDOW, n_points) * member.case.block.length
    time = member.surfaces["resolved"]["time"].values
    reference, other = amplitudes(member, "resolved", X), amplitudes(member, model, X)
    grown = reference > NOTICEABLE_GROWTH * reference[0]
    ratio = other[grown] / reference[grown]
    threshold = member.case.analysis.wrinkle_threshold
    onset = arrival_times(time, other, threshold) / arrival_times(time, reference, threshold)
    median, low, high = (float(value) for value in np.percentile(ratio, [50, 5, 95]))
    return Agreement(median, low, high, float(np.nanmedian(onset)))


def speeds_and_amplitudes(members: Sequence[Member]) -> list[dict[str, str | float]]:
    """One row per member and model: what the paper reports of its experiment, from the common analysis."""
    rows: list[dict[str, str | float]] = []
    for member in members:
        for model in MODELS:
            summary = analyse(member.surfaces[model], member.case.analysis).summary
            fit = agreement(member, model)
            rows.append(
                {
                    "member": member.name,
                    "model": model,
                    "wavefront_speed_m_per_s": _number(summary, "wavefront_speed_m_per_s"),
                    "wrinkle_speed_m_per_s": _number(summary, "wrinkle_speed_m_per_s"),
                    "speed_ratio": _number(summary, "wrinkle_to_wavefront_speed_ratio"),
                    "amplitude_max_m": _number(summary, "wrinkle_amplitude_max_m"),
                    "amplitude_over_eq_1": _number(summary, "wrinkle_amplitude_over_expected"),
                    "over_resolved_median": fit.median,
                    "over_resolved_5_percent": fit.low,
                    "over_resolved_95_percent": fit.high,
                    "onset_over_resolved": fit.onset_median,
                }
            )
    return rows


def _number(summary: Mapping[str, object], key: str) -> float:
    value = summary.get(key)
    return float(value) if isinstance(value, int | float) else float("nan")
