"""What a case must fulfil as a whole, once every value by itself is right."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from wrinklewave.config.drives import (
    CompressionDrive,
    EndMotionDrive,
    HistoryDrive,
    StrikerDrive,
    VelocityStepDrive,
)
from wrinklewave.config.history import read_history, read_profile
from wrinklewave.config.imperfections import (
    BumpImperfection,
    ProfileImperfection,
    RandomImperfection,
)
from wrinklewave.errors import InputError

if TYPE_CHECKING:
    from wrinklewave.config.case import Case
    from wrinklewave.config.solids import Film

MOST_FRAMES = 100_000
ROUNDING = 1e-9  # relative; times and places that are computed may miss their limit by rounding


def case_errors(case: Case) -> Iterator[InputError]:
    """Yield an error for everything in ``case`` that does not fit together."""
    if case.film is not None:
        yield from _film(case, case.film)
    yield from _wrinkles(case)
    yield from _averaging_depth(case)
    yield from _drive(case)
    yield from _times(case)
    yield from _places(case)
    if case.boundaries.slip >= case.block.height / 2:
        problem = f"{_mm(case.boundaries.slip)} lets the whole end slip"
        cure = 'make it smaller, or set boundaries.right = "roller"'
        yield _error(
            "boundaries.slip", problem, f"less than half the height, {_mm(case.block.height / 2)}", cure
        )
    if case.solver.mass_scaling > 1 and not isinstance(case.drive, CompressionDrive):
        problem = f"{case.solver.mass_scaling:g} in a dynamic run would change the wave speeds"
        yield _error("solver.mass_scaling", problem, '1, unless drive.kind = "compression"', "remove it")


def _film(case: Case, film: Film) -> Iterator[InputError]:
    length, height = case.block.length, case.block.height
    if film.thickness >= height:
        problem = f"{_mm(film.thickness)}, but the block is {_mm(height)} high"
        yield _error("film.thickness", problem, "a film thinner than the block", "check its unit, such as um")
    if film.end_gap >= length:
        yield _error("film.end_gap", f"{_mm(film.end_gap)} leaves no film", _inside(case), "make it smaller")
    imperfection = film.imperfection
    if isinstance(imperfection, BumpImperfection) and imperfection.position > length:
        problem = f"{_mm(imperfection.position)} is outside the block"
        yield _error("film.imperfection.position", problem, _inside(case), "move it")
    if (
        isinstance(imperfection, RandomImperfection)
        and not 0 < imperfection.wavelengths[0] < imperfection.wavelengths[1]
    ):
        yield _empty("film.imperfection.wavelengths", imperfection.wavelengths)
    if isinstance(imperfection, ProfileImperfection):
        yield from _readable("film.imperfection.file", imperfection.file, read_profile)


def _wrinkles(case: Case) -> Iterator[InputError]:
    model, film = case.wrinkles.model, case.film
    if model == "none":
        return
    if film is None:
        cure = 'add one, or set wrinkles.model = "none"'
        yield _error("wrinkles.model", f'"{model}" without a film', "a [film] section", cure)
        return
    measured = film.critical_strain is not None and film.critical_wavelength is not None
    modulus = film.shear_modulus is not None or film.modulus_from is not None
    if model == "quasi-static" and not (measured or modulus):
        problem = "neither critical_strain and critical_wavelength nor a modulus are given"
        cure = "add critical_strain and critical_wavelength as a quasi-static test gives them"
        yield _error("film", problem, "both, or else shear_modulus or modulus_from", cure)
    if model in ("rate-dependent", "resolved") and not modulus:
        cure = 'add modulus_from = "critical_strain" or "critical_wavelength", or the modulus itself'
        problem = f'the "{model}" model needs the modulus of the film'
        yield _error("film", problem, "shear_modulus or modulus_from", cure)
    if model in ("rate-dependent", "resolved") and film.imperfection is None:
        cure = 'add, for instance, kind = "sinusoidal", amplitude = "10 um", wavelength = "2.0 mm"'
        problem = f'missing, but the "{model}" model needs a seed for its wrinkles'
        yield _error("film.imperfection", problem, "a table with kind and amplitude", cure)


def _averaging_depth(case: Case) -> Iterator[InputError]:
    depth, meshed = case.wrinkles.averaging_depth, case.block.meshed_height
    if depth > meshed * (1 + ROUNDING):
        where = "upper half of the block" if case.block.symmetry else "block"
        problem = f"{_mm(depth)}, but the {where} is {_mm(meshed)} high"
        cure = "make it smaller, or leave it out for H/2"
        yield _error("wrinkles.averaging_depth", problem, f"at most {_mm(meshed)}", cure)


def _drive(case: Case) -> Iterator[InputError]:
    drive, length, end = case.drive, case.block.length, case.solver.end_time
    if isinstance(drive, StrikerDrive | EndMotionDrive) and drive.stop_distance >= length:
        problem = f"{_mm(drive.stop_distance)} crushes the whole block"
        yield _error("drive.stop_distance", problem, _inside(case), "make it smaller")
    if isinstance(drive, StrikerDrive) and drive.rise_time * drive.velocity > drive.stop_distance:
        problem = f"{_ms(drive.rise_time)} to gain speed and as long to lose it need a longer travel"
        expected = f"at most stop_distance / velocity = {_ms(drive.stop_distance / drive.velocity)}"
        yield _error("drive.rise_time", problem, expected, "lower it, or raise drive.stop_distance")
    if isinstance(drive, EndMotionDrive) and not drive.stop_distance <= drive.overshoot < length:
        expected = f"stop_distance = {_mm(drive.stop_distance)} at least, and {_inside(case)}"
        cure = "give the final travel of the end, not the part beyond stop_distance"
        yield _error("drive.overshoot", f"{_mm(drive.overshoot)} is no final travel", expected, cure)
    if isinstance(drive, VelocityStepDrive) and drive.velocity * end >= length:
        problem = f"{drive.velocity:g} m/s crushes the whole block in {_ms(end)}"
        expected = f"velocity * end_time {_inside(case)}"
        yield _error("drive.velocity", problem, expected, "lower drive.velocity or solver.end_time")
    if isinstance(drive, CompressionDrive):
        needed = drive.duration * (2 if drive.unload else 1)
        if needed > end * (1 + ROUNDING):
            problem = f"the ramp takes {_ms(needed)}, but the run ends at {_ms(end)}"
            cure = "raise solver.end_time, or lower drive.duration"
            yield _error("drive.duration", problem, "a ramp that ends before solver.end_time", cure)
    if isinstance(drive, HistoryDrive):
        yield from _readable("drive.file", drive.file, read_history) or _covered(drive.file, end)


def _covered(file: Path, end: float) -> Iterator[InputError]:
    time = read_history(file).time
    if time[0] > 0 or time[-1] < end * (1 - ROUNDING):
        problem = f"{file} covers {_ms(time[0])} to {_ms(time[-1])}"
        expected = f"times from 0 to solver.end_time = {_ms(end)}"
        yield _error("drive.file", problem, expected, "lower solver.end_time, or extend the history")


def _times(case: Case) -> Iterator[InputError]:
    end = case.solver.end_time
    times = {f"analysis.times.{number}": time for number, time in enumerate(case.analysis.times)}
    for name in ("surface_interval", "field_interval", "history_interval"):
        times[f"output.{name}"] = getattr(case.output, name)
    for key, time in times.items():
        if time > end * (1 + ROUNDING):
            problem = f"{_ms(time)} is beyond the end of the run at {_ms(end)}"
            yield _error(key, problem, "at most solver.end_time", "lower it, or raise solver.end_time")
    for name in ("surface_interval", "field_interval"):
        every = getattr(case.output, name)
        if end / every > MOST_FRAMES:
            problem = f"{_ms(every)} gives {end / every:.2g} frames until the end of the run at {_ms(end)}"
            yield _error(f"output.{name}", problem, f"at most {MOST_FRAMES} frames", "raise it")
    interval = case.output.surface_interval
    if end / 3 * (1 + ROUNDING) < interval <= end * (1 + ROUNDING):
        problem = f"{_ms(interval)} gives fewer than four frames until the end of the run at {_ms(end)}"
        yield _error("output.surface_interval", problem, "at most a third of solver.end_time", "lower it")


def _places(case: Case) -> Iterator[InputError]:
    if case.output.pixel_size > case.block.length / 3:
        problem = f"{_mm(case.output.pixel_size)} gives fewer than four places on {_mm(case.block.length)}"
        yield _error("output.pixel_size", problem, "at most a third of block.length", "lower it")
    limit = case.block.length * (1 + ROUNDING)
    lists = {"output.probes": case.output.probes, "analysis.positions": case.analysis.positions}
    for name, values in lists.items():
        for number, x in enumerate(values):
            if x > limit:
                problem = f"{_mm(x)} is outside the block"
                yield _error(f"{name}.{number}", problem, _inside(case), "move or remove it")
    for name in ("front_window", "amplitude_window"):
        low, high = window = getattr(case.analysis, name)
        if low >= high:
            yield _empty(f"analysis.{name}", window)
        elif high > limit:
            problem = f"{_mm(low)} to {_mm(high)} leaves the block"
            yield _error(f"analysis.{name}", problem, _inside(case), "move its end")
    for name, size in (
        ("output.pixel_size", case.output.pixel_size),
        ("analysis.filter_wavelength", case.analysis.filter_wavelength),
    ):
        if size > limit:
            yield _error(name, f"{_mm(size)} is longer than the block", _inside(case), "make it smaller")


def _readable(key: str, file: Path, read: Callable[[Path], object]) -> list[InputError]:
    """The mistake that makes a file which the case names unreadable, if there is one."""
    try:
        read(file)
    except InputError as error:
        place = f"{error.file}: {error.key}" if error.key else f"{error.file}"
        return [_error(key, f"{place}: {error.problem}", error.expected, error.cure)]
    return []


def _empty(key: str, window: tuple[float, float]) -> InputError:
    problem = f"{_mm(window[0])} to {_mm(window[1])} is empty"
    return _error(key, problem, "the smaller value, then the larger", "swap or change them")


def _error(key: str, problem: str, expected: str | None, cure: str | None) -> InputError:
    return InputError(problem, key=key, expected=expected, cure=cure)


def _inside(case: Case) -> str:
    return f"within the length of the block, {_mm(case.block.length)}"


def _mm(value: float) -> str:
    return f"{value * 1e3:.6g} mm"


def _ms(value: float) -> str:
    return f"{value * 1e3:.6g} ms"
