"""The scalar results of a run: beside its analysis' own, energies, compressibility, steps, versions."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from wrinklewave.environment import versions
from wrinklewave.materials.moduli import substrate_moduli
from wrinklewave.theory.film import film_plane_strain_modulus, substrate_plane_strain_modulus
from wrinklewave.theory.wrinkling import modulus_ratio_of_strain, modulus_ratio_of_wavelength

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from wrinklewave.config import Case
    from wrinklewave.dynamics.simulation import Simulation
    from wrinklewave.experiments.simulate import Run

NOTICEABLE = 1e-3
"""Shares of the internal energy are taken once it is this fraction of its largest value."""


def run_summary(run: Run, simulation: Simulation, threads: int, seconds: float) -> dict[str, Any]:
    """Scalar results of a run, with units in their names; the analysis' own among them."""
    summary: dict[str, Any] = {
        "name": run.case.name,
        "outcome": run.outcome.name.lower(),
        "message": run.outcome.value,
        "wrinkle_model": run.case.wrinkles.model,
        "bulk_response": run.case.substrate.bulk_response,
    }
    if run.analysis is not None:
        summary |= run.analysis.summary
    rows, columns = simulation.model.mesh.shape
    return (
        summary
        | energy_scalars(run.history)
        | material_scalars(run.case)
        | {
            "elements": rows * columns,
            "steps": simulation.step,
            "steps_of_fastest_row": simulation.ratio,
            "simulated_time_s": simulation.time,
            "device": simulation.device,
            "threads": threads,
            "element_updates_per_s": simulation.updates_per_second,
            "stepping_time_s": simulation.stepping_seconds,
            "wall_time_s": seconds,
            "versions": versions(),
        }
    )


def energy_scalars(history: dict[str, NDArray[np.float64]]) -> dict[str, float]:
    """Energy balance and hourglass control over the whole run."""
    if not history["time_s"].size:
        return {}
    work = float(np.abs(history["external_work_J_per_m"]).max())
    internal = history["elastic_J_per_m"] + history["viscous_work_J_per_m"]
    noticeable = internal > NOTICEABLE * internal.max()
    share = np.abs(history["hourglass_J_per_m"][noticeable]) / internal[noticeable]
    kinetic = history["kinetic_J_per_m"][noticeable] / internal[noticeable]
    return {
        "external_work_J_per_m": float(history["external_work_J_per_m"][-1]),
        "energy_imbalance_max": float(np.abs(history["imbalance_J_per_m"]).max()) / work if work else 0.0,
        "hourglass_energy_share_max": float(share.max()) if share.size else 0.0,
        "hourglass_amplitude_max": float(history["hourglass_amplitude"].max()),
        "kinetic_energy_share_end": float(kinetic[-1]) if kinetic.size else 0.0,
        "volume_ratio_min": float(history["volume_ratio_min"].min()),
        "volume_ratio_max": float(history["volume_ratio_max"].max()),
        "contact_force_max_N_per_m": float(history["contact_force_N_per_m"].max()),
        "time_step_min_s": float(history["dt_s"].min()),
    }


def film_scalars(case: Case) -> dict[str, float]:
    """Film modulus over substrate modulus, as used and as each measured value implies: they may disagree."""
    film, scalars = case.film, {}
    if film is None:
        return {}
    if film.shear_modulus is not None or film.modulus_from is not None:
        E_f = film_plane_strain_modulus(film, case.substrate)
        scalars["film_modulus_ratio"] = E_f / substrate_plane_strain_modulus(case.substrate)
    if film.critical_strain is not None:
        scalars["film_modulus_ratio_of_critical_strain"] = modulus_ratio_of_strain(film.critical_strain)
    if film.critical_wavelength is not None:
        ratio = modulus_ratio_of_wavelength(film.critical_wavelength, film.thickness)
        scalars["film_modulus_ratio_of_critical_wavelength"] = ratio
    return scalars


def material_scalars(case: Case) -> dict[str, float]:
    """How compressible the substrate is, and how stiff the film: numbers that nobody should have to guess."""
    substrate = substrate_moduli(case.substrate)
    return {
        "bulk_over_shear_long_term": substrate.K_inf / substrate.mu_inf,
        "bulk_over_shear_instantaneous": substrate.K_instantaneous / substrate.mu_instantaneous,
        "poisson_ratio_instantaneous": substrate.nu_instantaneous,
        **film_scalars(case),
    }
