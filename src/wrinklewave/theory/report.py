"""Every closed-form number of a case, beside what "Wrinkles Riding Waves" prints for it.

One row per number: add a row, and every case, table and test has it.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from wrinklewave.config.drives import EndMotionDrive, StrikerDrive
from wrinklewave.theory import waves, wrinkling
from wrinklewave.theory.constants import Constants, NotGivenError

if TYPE_CHECKING:
    from wrinklewave.config.case import Case


@dataclass(frozen=True)
class Quantity:
    """One closed-form number.

    Args:
        group: heading under which it stands.
        name: what it is, in words; unique in a report.
        symbol: as in the literature.
        value: in ``unit``.
        unit: SI; "1" for pure numbers.
        formula: how it follows from the case.
        paper: what the paper prints for it, as text with its digits, in the same unit; None where it prints
            nothing, or for another case than the paper's.
        remark: where paper and formula differ, or what to mind.
    """

    group: str
    name: str
    symbol: str
    value: float
    unit: str
    formula: str
    paper: str | None
    remark: str


@dataclass(frozen=True)
class Row:
    """A number of the report: how it is computed from the constants of a case, and what the paper prints."""

    name: str
    symbol: str
    unit: str
    formula: str
    compute: Callable[[Constants], float]
    paper: str | None = None
    remark: str = ""  # holds for every case
    paper_remark: str = ""  # about what the paper prints


def report(case: Case) -> list[Quantity]:
    """Return every closed-form number of a case; those without inputs or a finite value are left out."""
    constants, papers = Constants(case), is_papers(case)
    numbers = (_quantity(group, row, constants, papers) for group, rows in ROWS.items() for row in rows)
    return [number for number in numbers if number is not None]


def _quantity(group: str, row: Row, constants: Constants, papers: bool) -> Quantity | None:
    """The number of a row; None where the case lacks an input for it, or where there is no finite answer."""
    try:
        value = float(row.compute(constants))
    except (NotGivenError, ArithmeticError):  # no Love limit for nu = 0, no amplitude beyond self-contact
        return None
    if not math.isfinite(value):
        return None
    remark = "; ".join(text for text in (row.remark, row.paper_remark if papers else "") if text)
    printed = row.paper if papers else None
    return Quantity(group, row.name, row.symbol, value, row.unit, row.formula, printed, remark)


def is_papers(case: Case) -> bool:
    """Does this case have the inputs that the paper's numbers follow from?"""
    substrate, film, drive = case.substrate, case.film, case.drive
    if film is None or not isinstance(drive, StrikerDrive | EndMotionDrive):
        return False
    given = (
        *(case.block.length, case.block.height, drive.velocity, drive.stop_distance),
        *(substrate.density, substrate.shear_modulus, substrate.poisson_ratio),
        *((term.shear_modulus, term.relaxation_time) for term in substrate.prony),
        *(film.thickness, film.critical_strain, film.critical_wavelength),
        *(case.analysis.loss_frequency, case.analysis.measured_front_speed),
    )
    papers = (
        50.4e-3,
        37e-3,
        10.0,
        6.3e-3,
        965.0,
        44e3,
        0.49,
        (3.35e6, 90e-6),
        140e-6,
        0.043,
        2e-3,
        400.0,
        44.0,
    )
    return given == papers


PLANE_STRAIN = "the simulated block is in plane strain, where waves are faster"
THIS_CASE = "with the case's bulk_response"

MODULI = (
    Row("Young's modulus, long-term", "E_0", "Pa", "2 mu_0 (1 + nu)", lambda s: s.E_0),
    Row("Young's modulus, relaxing share", "E_1", "Pa", "2 mu_1 (1 + nu)", lambda s: s.E_i - s.E_0),
    Row("bulk modulus, long-term", "K_0", "Pa", "E_0/(3 (1 - 2 nu))", lambda s: s.K_0),
    Row("bulk modulus, instantaneous", "K_i", "Pa", "(E_0 + E_1)/(3 (1 - 2 nu))", lambda s: s.K_i),
    Row("bulk over shear modulus", "K_0/mu_0", "1", "2 (1 + nu)/(3 (1 - 2 nu))", lambda s: s.K_0 / s.mu_0),
    Row("instantaneous stiffening", "mu_i/mu_0", "1", "(mu_0 + mu_1)/mu_0", lambda s: s.stiffening),
    Row("Prony ratio", "g_1", "1", "mu_1/(mu_0 + mu_1)", lambda s: 1 - 1 / s.stiffening),
    Row(
        "Poisson's ratio, instantaneous",
        "nu_i",
        "1",
        "(3 K - 2 mu)/(2 (3 K + mu)) at t = 0",
        lambda s: s.solid.nu_instantaneous,
        remark=THIS_CASE,
    ),
    Row(
        "stress at rest of the printed energy",
        "dW/dLambda",
        "Pa",
        "mu_0 + K_0/2 at F = I",
        lambda s: s.mu_0 + s.K_0 / 2,
        remark="must vanish: W = mu/2 (J^(-2/3) I1 - 3) + K/2 (J - 1)^2 is used",
    ),
)

SPEEDS = (
    Row("bar speed, long-term", "c_0", "m/s", "sqrt(E_0/rho)", lambda s: s.c_0, "11.7", PLANE_STRAIN),
    Row(
        "bar speed, instantaneous",
        "c_1",
        "m/s",
        "sqrt((E_0 + E_1)/rho)",
        lambda s: s.c_1,
        "102",
        PLANE_STRAIN,
    ),
    Row("plane-strain speed, long-term", "c_0'", "m/s", "c_0/sqrt(1 - nu^2)", lambda s: s.plate_0),
    Row("plane-strain speed, instantaneous", "c_1'", "m/s", "c_1/sqrt(1 - nu^2)", lambda s: s.plate_1),
    Row(
        "shear-wave speed, long-term",
        "c_T0",
        "m/s",
        "sqrt(mu_0/rho)",
        lambda s: waves.shear_speed(s.mu_0, s.rho),
    ),
    Row(
        "shear-wave speed, instantaneous",
        "c_Ti",
        "m/s",
        "sqrt(mu_i/rho)",
        lambda s: waves.shear_speed(s.mu_i, s.rho),
    ),
    Row(
        "plane-wave speed, instantaneous",
        "c_L",
        "m/s",
        "sqrt((K_i + 4 mu_i/3)/rho)",
        lambda s: waves.longitudinal_speed(s.mu_i, s.K_i, s.rho),
        "424",
        "needs a bulk modulus that is K_i at short times",
    ),
    Row(
        "plane-wave speed, long-term",
        "c_L0",
        "m/s",
        "sqrt((K_0 + 4 mu_0/3)/rho)",
        lambda s: waves.longitudinal_speed(s.mu_0, s.K_0, s.rho),
    ),
    Row(
        "plane-wave speed, instantaneous, K = K_0 always",
        "c_L",
        "m/s",
        "sqrt((K_0 + 4 mu_i/3)/rho)",
        lambda s: waves.longitudinal_speed(s.mu_i, s.K_0, s.rho),
    ),
    Row(
        "plane-wave speed, long-term, K = K_i always",
        "c_L0",
        "m/s",
        "sqrt((K_i + 4 mu_0/3)/rho)",
        lambda s: waves.longitudinal_speed(s.mu_0, s.K_i, s.rho),
    ),
    Row(
        "fastest wave of this case",
        "c_L",
        "m/s",
        "sqrt((K + 4 mu_i/3)/rho) at t = 0",
        lambda s: waves.longitudinal_speed(s.mu_i, s.solid.K_instantaneous, s.rho),
        remark=THIS_CASE,
    ),
    Row(
        "Rayleigh speed, instantaneous",
        "c_Ri",
        "m/s",
        "root of Rayleigh's equation at t = 0",
        lambda s: waves.rayleigh_speed(s.mu_i, s.solid.K_instantaneous, s.rho),
        remark=THIS_CASE,
    ),
    Row(
        "Rayleigh speed, long-term",
        "c_R0",
        "m/s",
        "root of Rayleigh's equation",
        lambda s: waves.rayleigh_speed(s.mu_0, s.solid.K_inf, s.rho),
        remark=THIS_CASE,
    ),
    Row(
        "Love's limit, long-term",
        "f_0",
        "Hz",
        "c_0 sqrt(6)/(2 pi nu H)",
        lambda s: waves.love_frequency(s.c_0, s.nu, s.H),
        "2.5e2",
        "of a bar with a square section",
    ),
    Row(
        "Love's limit, instantaneous",
        "f_1",
        "Hz",
        "c_1 sqrt(6)/(2 pi nu H)",
        lambda s: waves.love_frequency(s.c_1, s.nu, s.H),
        "2.20e3",
        "of a bar with a square section",
    ),
    Row(
        "Love's limit in plane strain, long-term",
        "f_0'",
        "Hz",
        "c_0' sqrt(12) (1 - nu)/(2 pi nu H)",
        lambda s: waves.love_frequency_plane_strain(s.plate_0, s.nu, s.H),
    ),
    Row(
        "Love's limit in plane strain, instantaneous",
        "f_1'",
        "Hz",
        "c_1' sqrt(12) (1 - nu)/(2 pi nu H)",
        lambda s: waves.love_frequency_plane_strain(s.plate_1, s.nu, s.H),
    ),
)

SINE_WAVE = (
    Row("frequency times relaxation time", "omega tau", "1", "2 pi f tau", lambda s: s.omega * s.tau),
    Row("storage modulus", "E'", "Pa", "E_0 + E_1 w^2/(1 + w^2), w = omega tau", lambda s: s.E_star.real),
    Row("loss modulus", "E''", "Pa", "E_1 w/(1 + w^2), w = omega tau", lambda s: s.E_star.imag),
    Row("dynamic modulus", "|E*|", "Pa", "sqrt(E'^2 + E''^2)", lambda s: abs(s.E_star)),
    Row("loss tangent", "tan delta", "1", "E''/E'", lambda s: s.E_star.imag / s.E_star.real),
    Row("viscoelastic bar speed", "c*", "m/s", "sqrt(|E*|/rho) sec(delta/2)", lambda s: s.c_star, "60"),
    Row(
        "viscoelastic bar speed without the secant",
        "",
        "m/s",
        "sqrt(|E*|/rho)",
        lambda s: waves.bar_speed(abs(s.E_star), s.rho),
    ),
    Row(
        "viscoelastic plane-strain speed",
        "c*'",
        "m/s",
        "c*/sqrt(1 - nu^2)",
        lambda s: s.c_star / math.sqrt(1 - s.nu**2),
    ),
    Row(
        "attenuation length",
        "",
        "m",
        "1/(omega sqrt(rho/|E*|) sin(delta/2))",
        lambda s: waves.attenuation_length(s.E_star, s.rho, s.omega),
    ),
)

TIMES = (
    Row("relaxation rate", "1/tau", "1/s", "1/tau", lambda s: 1 / s.tau, None, "of the fastest Prony term"),
    Row("retardation time", "", "s", "tau (E_0 + E_1)/E_0 for one term", lambda s: s.retardation_time),
    Row("transit time, long-term", "L_0/c_0", "s", "L_0/c_0", lambda s: s.L / s.c_0),
    Row("transit time, instantaneous", "L_0/c_1", "s", "L_0/c_1", lambda s: s.L / s.c_1),
    Row("transit time, measured", "L_0/c", "s", "L_0/c", lambda s: s.L / s.c),
)

IMPACT = (
    Row(
        "static strain at the stoppers",
        "eps_S",
        "1",
        "l/L_0",
        lambda s: s.travel / s.L,
        "0.12",
        paper_remark="6.3/50.4 = 0.125, of which the paper prints two digits",
    ),
    Row(
        "nominal strain rate",
        "",
        "1/s",
        "eps_S V_S/l",
        lambda s: s.V_S / s.L,
        "2.0e2",
        paper_remark="with the printed eps_S it would be 190",
    ),
    Row("time from contact to the stoppers", "", "s", "l/V_S", lambda s: s.travel / s.V_S),
    Row(
        "striker speed over wave speed",
        "V_S/c",
        "1",
        "V_S/c",
        lambda s: s.V_S / s.c,
        paper_remark='the paper: "approaching 25 %"',
    ),
)

FILM = (
    Row(
        "film modulus ratio from the critical strain",
        "E_f/E_s",
        "1",
        "3/(4 eps_c)^(3/2)",
        lambda s: wrinkling.modulus_ratio_of_strain(s.eps_c),
        remark="plane-strain moduli; of any moduli if film and substrate have the same nu",
    ),
    Row(
        "film modulus ratio from the critical wavelength",
        "E_f/E_s",
        "1",
        "3 (lambda_c/(2 pi h))^3",
        lambda s: wrinkling.modulus_ratio_of_wavelength(s.lambda_c, s.h),
        paper_remark="the two measured values disagree by a fifth",
    ),
    Row("film modulus in plane strain", "E_f'", "Pa", "E_s' (E_f/E_s)", lambda s: s.E_f),
    Row(
        "film shear modulus",
        "mu_f",
        "Pa",
        "E_f' (1 - nu_f)/2",
        lambda s: s.E_f * (1 - s.film.poisson_ratio) / 2,
    ),
    Row(
        "critical strain from the moduli",
        "eps_c",
        "1",
        "(3 E_s/E_f)^(2/3)/4",
        lambda s: wrinkling.critical_strain(s.E_f, s.E_s),
        "0.043",
    ),
    Row(
        "critical strain from the moduli, finite depth",
        "eps_c",
        "1",
        "smallest (kh)^2/12 + E_s g(k H/2)/(2 E_f kh)",
        lambda s: _on_layer(s)[0],
        remark="a substrate of half the height on a plane of symmetry",
    ),
    Row(
        "critical strain from the measured wavelength",
        "eps_c",
        "1",
        "(pi h/lambda_c)^2",
        lambda s: (math.pi * s.h / s.lambda_c) ** 2,
    ),
    Row(
        "critical wavelength from the moduli",
        "lambda_c",
        "m",
        "2 pi h (E_f/(3 E_s))^(1/3)",
        lambda s: wrinkling.critical_wavelength(s.E_f, s.E_s, s.h),
        paper_remark="6 % above the measured 2.0 mm",
    ),
    Row(
        "critical wavelength from the moduli, finite depth",
        "lambda_c",
        "m",
        "2 pi/k at the smallest strain",
        lambda s: _on_layer(s)[1],
        remark="a substrate of half the height on a plane of symmetry",
    ),
    Row(
        "critical wavelength as the paper prints it",
        "lambda_c",
        "m",
        "2 pi h (E_f/E_s)^(1/3)",
        lambda s: 3 ** (1 / 3) * wrinkling.critical_wavelength(s.E_f, s.E_s, s.h),
        remark="lacks a factor 3, which makes it 44 % too long",
    ),
    Row(
        "critical strain from the moduli, no plane strain",
        "eps_c",
        "1",
        "(3 E_s/E_f)^(2/3)/4 with Young's moduli",
        lambda s: wrinkling.critical_strain(s.E_f * (1 - s.film.poisson_ratio**2), s.E_0),
    ),
    Row(
        "critical strain on the instantaneous substrate",
        "eps_ci/eps_c",
        "1",
        "((E_0 + E_1)/E_0)^(2/3)",
        lambda s: wrinkling.critical_strain_ratio(s.stiffening),
        "18",
        paper_remark="0.78, far beyond the formula's range: the substrate is then stiffer than the film",
    ),
    Row(
        "wavelength if it was measured on the compressed sample",
        "",
        "m",
        "lambda_c/(1 - eps_c)",
        lambda s: s.lambda_c / (1 - s.eps_c),
        remark="in undeformed material length",
    ),
    Row(
        "wavenumber times thickness",
        "k_c h",
        "1",
        "2 pi h/lambda_c",
        lambda s: 2 * math.pi * s.h / s.lambda_c,
    ),
    Row("wrinkles along the block", "L_0/lambda_c", "1", "L_0/lambda_c", lambda s: s.L / s.lambda_c),
    Row("block height over film thickness", "H/h", "1", "H/h", lambda s: s.H / s.h),
    Row(
        "wrinkle amplitude at the static strain",
        "A_0",
        "m",
        "2/pi E(q^2) = 1 - (eps_S - eps_c), A = lambda_c q/(2 pi)",
        lambda s: wrinkling.inextensible_amplitude(s.travel / s.L, s.eps_c, s.lambda_c),
        remark="exact for an inextensible film, Eq. 1 is its series",
    ),
    Row(
        "wrinkle wavelength at the static strain",
        "lambda",
        "m",
        "lambda_c (1 - (eps_S - eps_c))",
        lambda s: s.lambda_c * (1 - (s.travel / s.L - s.eps_c)),
    ),
    Row("delay of buckling", "t_c", "s", "lambda_c/c", lambda s: s.lambda_c / s.c, "4.5e-5"),
    Row(
        "squared frequency of the critical mode",
        "",
        "1",
        "omega^2 over that of the springs, rho h omega^2 = B k^4 - P k^2 + K_w",
        lambda s: _critical_mode(s),
        "0",
        remark="Winkler beam at eps_c and lambda_c of the moduli",
    ),
)

ROWS = {
    "moduli": MODULI,
    "wave speeds": SPEEDS,
    "a sine wave of the loss frequency": SINE_WAVE,
    "times": TIMES,
    "impact": IMPACT,
    "film": FILM,
}


def _on_layer(s: Constants) -> tuple[float, float]:
    """Critical strain and wavelength on a substrate of half the block's height."""
    return wrinkling.critical_state_on_layer(s.E_f, s.E_s, s.h, depth=s.H / 2, nu=s.nu, base="roller")


def _critical_mode(s: Constants) -> float:
    """Squared frequency of the critical mode, over that of the film's mass on the springs alone."""
    k = 2 * math.pi / wrinkling.critical_wavelength(s.E_f, s.E_s, s.h)
    springs, mass = s.E_s * k / 2, s.film.density * s.h
    squared = wrinkling.winkler_squared_frequency(
        k,
        wrinkling.critical_strain(s.E_f, s.E_s),
        film_modulus=s.E_f,
        thickness=s.h,
        density=s.film.density,
        foundation=springs,
    )
    return round(squared / (springs / mass), 12) + 0.0  # rounding leaves 1e-16 of a difference, and -0
