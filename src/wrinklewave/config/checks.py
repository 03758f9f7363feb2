"""What a case must fulfil as a whole, once every value by itself is right."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from wrinklewave.config.drives import (
    CompressionDrive,
    EndMotionDrive,
    HistoryDrive,
    StrikerDrive,
    VelocityStepDrive,
)
from wrinklewave.config.history import read_history
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from wrinklewave.config.case import Case


def case_errors(case: Case) -> Iterator[InputError]:
    """Yield an error for everything in ``case`` that does not fit together."""
    yield from _film(case)
    yield from _wrinkles(case)
    yield from _drive(case)
    yield from _times(case)
    yield from _places(case)
    yield from _solver(case)


def _film(case: Case) -> Iterator[InputError]:
    if case.film is None:
        return
    if case.film.thickness >= case.block.height:
        yield _error(
            "film.thickness",
            f"{_mm(case.film.thickness)}, but the block is {_mm(case.block.height)} high",
            "a film thinner than the block",
            "check the units: films are given in um",
        )
    if case.film.end_gap >= case.block.length:
        yield _error(
            "film.end_gap", f"{_mm(case.film.end_gap)} leaves no film", _inside(case), "make it smaller"
        )


def _wrinkles(case: Case) -> Iterator[InputError]:
    if case.wrinkles.averaging_depth > case.block.height:
        yield _error(
            "wrinkles.averaging_depth",
            f"{_mm(case.wrinkles.averaging_depth)}, but the block is {_mm(case.block.height)} high",
            "at most the block's height, H/2 in the paper",
            "make it smaller, or leave it out for H/2",
        )
    if case.block.symmetry and case.block.height / 2 < case.wrinkles.averaging_depth <= case.block.height:
        yield _error(
            "wrinkles.averaging_depth",
            f"{_mm(case.wrinkles.averaging_depth)} reaches below mid-height, where nothing is meshed",
            f"at most H/2 = {_mm(case.block.height / 2)} with symmetry",
            "make it smaller, or set block.symmetry = false",
        )
    model, film = case.wrinkles.model, case.film
    if model == "none":
        return
    if film is None:
        yield _error(
            "wrinkles.model",
            f'"{model}" without a film',
            "a [film] section",
            'add one, or set wrinkles.model = "none"',
        )
        return
    moduli = film.shear_modulus is not None or film.modulus_from is not None
    measured = film.critical_strain is not None and film.critical_wavelength is not None
    if model == "quasi-static" and not measured and not moduli:
        yield _error(
            "film",
            "neither critical_strain and critical_wavelength nor a modulus are given",
            "both measured values, or shear_modulus, or modulus_from",
            "add critical_strain and critical_wavelength as measured in a quasi-static test",
        )
    if model in ("rate-dependent", "resolved") and not moduli:
        yield _error(
            "film",
            f'the "{model}" model needs the film\'s modulus',
            "shear_modulus or modulus_from",
            'add modulus_from = "critical_strain" or "critical_wavelength", or the modulus itself',
        )
    if model in ("rate-dependent", "resolved") and film.imperfection is None:
        yield _error(
            "film.imperfection",
            f'the "{model}" model needs a seed for its wrinkles',
            "a [film.imperfection] section",
            'add, for instance, kind = "sinusoidal", amplitude = "10 um", wavelength = "2.0 mm"',
        )


def _drive(case: Case) -> Iterator[InputError]:
    drive, length = case.drive, case.block.length
    if isinstance(drive, StrikerDrive | EndMotionDrive) and drive.stop_distance >= length:
        yield _error(
            "drive.stop_distance",
            f"{_mm(drive.stop_distance)} is the whole block",
            _inside(case),
            "make it smaller",
        )
    if isinstance(drive, EndMotionDrive) and not drive.stop_distance <= drive.overshoot < length:
        yield _error(
            "drive.overshoot",
            f"{_mm(drive.overshoot)}",
            f"from stop_distance = {_mm(drive.stop_distance)} to less than the length {_mm(length)}",
            "it is the final travel of the end, not the part beyond stop_distance",
        )
    if isinstance(drive, VelocityStepDrive) and drive.velocity * case.solver.end_time >= length:
        yield _error(
            "drive.velocity",
            f"{drive.velocity:g} m/s crosses the whole block in {case.solver.end_time:g} s",
            f"velocity * end_time below the length {_mm(length)}",
            "lower drive.velocity or solver.end_time",
        )
    if isinstance(drive, CompressionDrive):
        needed = drive.duration * (2 if drive.unload else 1)
        if needed > case.solver.end_time * (1 + 1e-9):
            yield _error(
                "drive.duration",
                f"the ramp takes {needed:g} s, but the run ends at {case.solver.end_time:g} s",
                "a ramp that ends before solver.end_time",
                "raise solver.end_time, or lower drive.duration",
            )
    if isinstance(drive, HistoryDrive):
        yield from _history(case, drive)


def _history(case: Case, drive: HistoryDrive) -> Iterator[InputError]:
    try:
        history = read_history(drive.file)
    except InputError as error:
        yield _error("drive.file", str(error), None, None)
        return
    if history.time[0] > 0 or history.time[-1] < case.solver.end_time * (1 - 1e-9):
        yield _error(
            "drive.file",
            f"{drive.file} covers {history.time[0]:g} to {history.time[-1]:g} s",
            f"times from 0 to solver.end_time = {case.solver.end_time:g} s",
            "shorten solver.end_time, or extend the history",
        )


def _times(case: Case) -> Iterator[InputError]:
    end = case.solver.end_time
    for name in ("surface_interval", "field_interval", "history_interval"):
        interval = getattr(case.output, name)
        if interval > end:
            yield _error(
                f"output.{name}",
                f"{interval:g} s is beyond the end of the run at {end:g} s",
                "at most solver.end_time",
                "shorten it, or raise solver.end_time",
            )
    for number, time in enumerate(case.analysis.times):
        if time > end:
            yield _error(
                f"analysis.times.{number}",
                f"{time:g} s is beyond the end of the run at {end:g} s",
                "times up to solver.end_time",
                "remove it, or raise solver.end_time",
            )


def _places(case: Case) -> Iterator[InputError]:
    length = case.block.length
    lists = {"output.probes": case.output.probes, "analysis.positions": case.analysis.positions}
    for key, values in lists.items():
        for number, x in enumerate(values):
            if x > length:
                yield _error(
                    f"{key}.{number}", f"{_mm(x)} is outside the block", _inside(case), "move or remove it"
                )
    for name in ("front_window", "amplitude_window"):
        low, high = getattr(case.analysis, name)
        if not low < high:
            yield _error(
                f"analysis.{name}",
                f"{_mm(low)} to {_mm(high)} is empty",
                "first the smaller, then the larger x",
                "swap them",
            )
        elif high > length:
            yield _error(
                f"analysis.{name}",
                f"{_mm(low)} to {_mm(high)} leaves the block",
                _inside(case),
                "shorten the window",
            )
    if case.output.pixel_size >= length:
        yield _error("output.pixel_size", f"{_mm(case.output.pixel_size)}", _inside(case), "make it smaller")


def _solver(case: Case) -> Iterator[InputError]:
    if case.solver.mass_scaling > 1 and not isinstance(case.drive, CompressionDrive):
        yield _error(
            "solver.mass_scaling",
            f"{case.solver.mass_scaling:g} in a dynamic run would change the wave speeds",
            'mass_scaling only with drive.kind = "compression"',
            "remove it",
        )


def _error(key: str, problem: str, expected: str | None, cure: str | None) -> InputError:
    return InputError(problem, key=key, expected=expected, cure=cure)


def _mm(value: float) -> str:
    return f"{value * 1e3:.6g} mm"


def _inside(case: Case) -> str:
    return f"less than the block's length {_mm(case.block.length)}"
