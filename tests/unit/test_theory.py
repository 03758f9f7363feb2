"""Closed forms: limits, identities, and which numbers a case has."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from wrinklewave.config import case_from_text, load_case
from wrinklewave.errors import InputError
from wrinklewave.materials.moduli import bulk_modulus, plane_strain_modulus, plane_wave_modulus
from wrinklewave.theory import viscoelasticity, waves, wrinkling
from wrinklewave.theory.constants import Constants
from wrinklewave.theory.film import critical_values, film_material, film_shear_modulus
from wrinklewave.theory.report import report

ROOT = Path(__file__).parents[2]
positive = st.floats(1e-3, 1e3)
terms = st.lists(st.tuples(positive, positive), min_size=1, max_size=4)


@given(positive, positive, positive, positive)
def test_one_term_is_the_standard_linear_solid(omega: float, E_0: float, E_1: float, tau: float) -> None:
    # E' = E_0 + E_1 w^2/(1 + w^2), E'' = E_1 w/(1 + w^2), w = omega tau; creep time tau (E_0 + E_1)/E_0
    w = omega * tau
    E = complex(viscoelasticity.complex_modulus(omega, E_0, [E_1], [tau]))
    assert E.real == pytest.approx(E_0 + E_1 * w**2 / (1 + w**2), rel=1e-12)
    assert E.imag == pytest.approx(E_1 * w / (1 + w**2), rel=1e-12)
    assert viscoelasticity.retardation_times(E_0, [E_1], [tau]) == pytest.approx(
        [tau * (E_0 + E_1) / E_0], rel=1e-9
    )


@given(positive, terms)
def test_retardation_and_relaxation_times_interlace(E_0: float, prony: list[tuple[float, float]]) -> None:
    # the zeros of E_0 + sum E_k s tau_k/(1 + s tau_k) lie between its poles, and the ratio of the products of
    # zeros and poles is that of the limits of the relaxance
    E_k, tau_k = np.array(prony).T
    creep, relaxation = viscoelasticity.retardation_times(E_0, E_k, tau_k), np.sort(tau_k)
    assert (creep >= relaxation * (1 - 1e-9)).all()
    assert (creep[:-1] <= relaxation[1:] * (1 + 1e-9)).all()
    assert creep.prod() / tau_k.prod() == pytest.approx((E_0 + E_k.sum()) / E_0, rel=1e-6)


@given(positive, terms)
def test_dynamic_modulus_between_its_limits(E_0: float, prony: list[tuple[float, float]]) -> None:
    E_k, tau_k = np.array(prony).T
    E = viscoelasticity.complex_modulus([1e-9, 1.0, 1e9], E_0, E_k, tau_k)
    assert E[0].real == pytest.approx(E_0, rel=1e-6)
    assert E[2].real == pytest.approx(E_0 + E_k.sum(), rel=1e-6)
    assert E_0 <= E[1].real <= E_0 + E_k.sum()
    assert (E.imag >= 0).all()


def test_rayleigh_speed_against_reference() -> None:
    lines = (ROOT / "tests" / "reference" / "rayleigh_speed.csv").read_text(encoding="utf-8").splitlines()
    for row in csv.DictReader(line for line in lines if not line.startswith("#")):
        K = bulk_modulus(1.0, float(row["nu"]))
        assert waves.rayleigh_speed(1.0, K, 1.0) == pytest.approx(float(row["cR_over_cT"]), rel=1e-12)


@given(st.floats(-0.95, 0.4999))
def test_rayleigh_speed_solves_rayleighs_equation(nu: float) -> None:
    # (2 - x)^2 = 4 sqrt(1 - x) sqrt(1 - r x), x = (c_R/c_T)^2, r = (c_T/c_L)^2
    K = bulk_modulus(1.0, nu)
    r = 1 / plane_wave_modulus(1.0, K)

    def rayleigh(x: float) -> float:
        return (2 - x) ** 2 - 4 * math.sqrt(1 - x) * math.sqrt(1 - r * x)

    x = brentq(rayleigh, 0.1, 1 - 1e-12, xtol=1e-14)
    assert waves.rayleigh_speed(1.0, K, 1.0) == pytest.approx(math.sqrt(x), rel=1e-9)


@given(positive, positive)
def test_rayleigh_speed_scales_with_the_shear_speed(mu: float, rho: float) -> None:
    unit = waves.rayleigh_speed(1.0, bulk_modulus(1.0, 0.3), 1.0)
    assert waves.rayleigh_speed(mu, bulk_modulus(mu, 0.3), rho) == pytest.approx(unit * math.sqrt(mu / rho))


@given(st.complex_numbers(min_magnitude=1, max_magnitude=1e9), positive, positive)
def test_viscoelastic_wave_has_the_wavenumber_of_the_complex_modulus(
    E: complex, rho: float, omega: float
) -> None:
    # k = omega sqrt(rho/E*): speed omega/Re k, attenuation length -1/Im k
    E = complex(abs(E.real) + 1, abs(E.imag))
    k = omega * np.sqrt(rho / E)
    assert waves.viscoelastic_bar_speed(E, rho) == pytest.approx(omega / k.real, rel=1e-9)
    if E.imag > 1e-6 * abs(E):
        assert waves.attenuation_length(E, rho, omega) == pytest.approx(-1 / k.imag, rel=1e-6)


def test_report_without_lateral_motion() -> None:
    names = {number.name for number in report(case_from_text(FILM.format(film="").replace("0.45", "0.0")))}
    assert "Love's limit, long-term" not in names
    assert "bar speed, long-term" in names


def test_elastic_wave_does_not_decay() -> None:
    assert waves.attenuation_length(1 + 0j, 1.0, 1.0) == math.inf
    assert waves.viscoelastic_bar_speed(4 + 0j, 1.0) == waves.bar_speed(4.0, 1.0) == 2.0


@given(st.floats(5, 1e4))
def test_modulus_from_wrinkles_and_back(ratio: float) -> None:
    strain = wrinkling.critical_strain(ratio, 1.0)
    wavelength = wrinkling.critical_wavelength(ratio, 1.0, 1e-4)
    assert wrinkling.modulus_ratio_of_strain(strain) == pytest.approx(ratio, rel=1e-12)
    assert wrinkling.modulus_ratio_of_wavelength(wavelength, 1e-4) == pytest.approx(ratio, rel=1e-12)
    # eps_c = (pi h/lambda_c)^2 whatever the moduli
    assert strain == pytest.approx((math.pi * 1e-4 / wavelength) ** 2, rel=1e-12)


@pytest.mark.parametrize("base", ["roller", "bonded"])
def test_depth_factor_limits(base: wrinkling.Base) -> None:
    nu = 0.3
    assert wrinkling.depth_factor(50.0, nu, base) == pytest.approx(1.0, rel=1e-12)
    assert wrinkling.depth_factor(300.1, nu, base) == wrinkling.depth_factor(299.9, nu, base)
    # a thin layer is a row of springs M/d: M = E/(1 - nu^2) where it may slide, K + 4 mu/3 where bonded
    E = 2 * (1 + nu)
    plane = plane_strain_modulus(E, nu)
    springs = {"roller": plane, "bonded": plane_wave_modulus(1.0, bulk_modulus(1.0, nu))}[base]
    w = 1e-3
    assert plane / 2 * w * wrinkling.depth_factor(w, nu, base) == pytest.approx(springs, rel=1e-5)


@pytest.mark.parametrize("base", ["roller", "bonded"])
def test_film_on_a_layer(base: wrinkling.Base) -> None:
    deep = wrinkling.critical_state_on_layer(42.0, 1.0, 1e-4, depth=0.1, nu=0.45, base=base)
    assert deep[0] == pytest.approx(wrinkling.critical_strain(42.0, 1.0), rel=1e-12)
    assert deep[1] == pytest.approx(wrinkling.critical_wavelength(42.0, 1.0, 1e-4), rel=1e-6)
    strains, wavelengths = zip(
        *(
            wrinkling.critical_state_on_layer(42.0, 1.0, 1e-4, depth=depth, nu=0.45, base=base)
            for depth in (1e-4, 2e-4, 4e-4, 8e-4)
        ),
        strict=True,
    )
    assert list(strains) == sorted(strains, reverse=True)  # a shallower layer is stiffer
    assert list(wavelengths) == sorted(wavelengths)


def test_thin_layer_is_a_winkler_foundation() -> None:
    # springs s: eps = (kh)^2/12 + s/(E_f h k^2), smallest at (kh)^4 = 12 s h/E_f with eps = sqrt(s h/(3 E_f))
    nu, h, depth = 0.3, 1e-4, 1e-7
    springs = 1.0 / depth
    strain, wavelength = wrinkling.critical_state_on_layer(1e9, 1.0, h, depth=depth, nu=nu, base="roller")
    assert strain == pytest.approx(math.sqrt(springs * h / (3 * 1e9)), rel=1e-4)
    assert wavelength == pytest.approx(2 * math.pi * h / (12 * springs * h / 1e9) ** 0.25, rel=1e-4)


@given(st.floats(1e-6, 0.3))
def test_inextensible_amplitude_keeps_the_arc_length(excess: float) -> None:
    # a curve y = A cos(k S) of arc length S shortens by the mean of sqrt(1 - (A k sin(k S))^2)
    amplitude = wrinkling.inextensible_amplitude(0.05 + excess, 0.05, 2 * math.pi)
    phase = np.linspace(0, 2 * math.pi, 4000, endpoint=False)
    assert np.sqrt(1 - (amplitude * np.sin(phase)) ** 2).mean() == pytest.approx(1 - excess, abs=1e-9)


def test_inextensible_amplitude_outside_its_range() -> None:
    assert wrinkling.inextensible_amplitude(0.04, 0.05, 1.0) == 0.0
    assert math.isnan(wrinkling.inextensible_amplitude(0.05 + 0.3635, 0.05, 1.0))


@given(st.floats(0.2, 3.0), st.floats(10, 1000))
def test_winkler_film_is_stable_below_the_critical_strain(kh_ratio: float, ratio: float) -> None:
    h = 1e-4
    k = kh_ratio * 2 * math.pi / wrinkling.critical_wavelength(ratio, 1.0, h)
    strain = wrinkling.critical_strain(ratio, 1.0)
    below = wrinkling.winkler_squared_frequency(
        k, 0.999 * strain, film_modulus=ratio, thickness=h, density=1.0, foundation=k / 2
    )
    assert below > 0


FILM = """
[block]
length = "50 mm"
height = "20 mm"
[substrate]
density = "965 kg/m^3"
shear_modulus = "44 kPa"
poisson_ratio = 0.45
[film]
thickness = "0.1 mm"
poisson_ratio = 0.3
{film}
[wrinkles]
model = "none"
[mesh]
elements = [50, 10]
[drive]
kind = "compression"
strain = 0.1
duration = "1 s"
[solver]
end_time = "1 s"
"""


def test_film_modulus_from_either_measurement() -> None:
    # the film that is derived wrinkles as measured, with its own Poisson's ratio
    for given_value, key, index in (("0.05", "critical_strain", 0), ('"2 mm"', "critical_wavelength", 1)):
        case = case_from_text(FILM.format(film=f'{key} = {given_value}\nmodulus_from = "{key}"'))
        assert case.film is not None
        mu = film_shear_modulus(case.film, case.substrate)
        given_directly = case_from_text(FILM.format(film=f'shear_modulus = "{mu!r} Pa"'))
        assert given_directly.film is not None
        values = critical_values(given_directly.film, case.substrate)
        assert values[index] == pytest.approx((0.05, 2e-3)[index], rel=1e-12)
        solid = film_material(case.film, case.substrate)
        assert (solid.mu_inf, solid.nu_inf) == pytest.approx((mu, 0.3), rel=1e-12)


def test_measured_values_go_before_derived_ones() -> None:
    film = 'critical_strain = 0.05\ncritical_wavelength = "2 mm"\nshear_modulus = "1 MPa"'
    case = case_from_text(FILM.format(film=film))
    assert case.film is not None
    assert critical_values(case.film, case.substrate) == (0.05, 2e-3)


def test_what_was_not_measured_is_derived() -> None:
    moduli = 'shear_modulus = "1 MPa"'
    derived, strain, wavelength = (
        case_from_text(FILM.format(film=f"{moduli}\n{measured}"))
        for measured in ("", "critical_strain = 0.05", 'critical_wavelength = "2 mm"')
    )
    both = critical_values(derived.film, derived.substrate)
    assert critical_values(strain.film, strain.substrate) == (0.05, both[1])
    assert critical_values(wavelength.film, wavelength.substrate) == (both[0], 2e-3)


def test_numbers_of_the_film_in_the_report() -> None:
    """By hand: E_f = 2.6 MPa / 0.91, E_s = 127.6 kPa / 0.7975, h = 0.1 mm, H = 20 mm, strain 0.1."""
    film = 'shear_modulus = "1 MPa"\ncritical_strain = 0.05\ncritical_wavelength = "2 mm"'
    numbers = {number.name: number.value for number in report(case_from_text(FILM.format(film=film)))}
    E_f, E_s = 2.6e6 / 0.91, 127.6e3 / 0.7975
    kh = np.linspace(0.1, 1.5, 100_001)
    w = kh / 0.1e-3 * 10e-3  # a substrate of half the height, on a plane of symmetry
    springs = E_s / 2 * (np.sinh(2 * w) + 2 * w) / (np.cosh(2 * w) - 1)
    for name, value in (
        ("critical strain from the moduli", (3 * E_s / E_f) ** (2 / 3) / 4),
        ("critical strain from the moduli, finite depth", (kh**2 / 12 + springs / (E_f * kh)).min()),
        ("critical strain from the moduli, no plane strain", (3 * 127.6e3 / 2.6e6) ** (2 / 3) / 4),
        ("critical strain from the measured wavelength", (math.pi * 0.1 / 2) ** 2),
    ):
        assert numbers[name] == pytest.approx(value, rel=1e-8), name


def test_times_of_a_solid_with_several_terms() -> None:
    """The relaxation time that counts is the shortest, the creep time the longest."""
    case = load_case(ROOT / "examples" / "paper_impact.toml")
    terms = [{"shear_modulus": "1 MPa", "relaxation_time": time} for time in ("2 ms", "50 us", "1 ms")]
    prony = ", ".join(
        "{" + ", ".join(f"{key} = '{text}'" for key, text in term.items()) + "}" for term in terms
    )
    constants = Constants(case.overridden(f"substrate.prony=[{prony}]"))
    assert constants.tau == 50e-6
    creep = viscoelasticity.retardation_times(44e3, [1e6] * 3, [2e-3, 50e-6, 1e-3])
    assert constants.retardation_time == pytest.approx(creep[-1])
    assert creep[-1] > 2e-3 > creep[0]


def test_film_without_modulus() -> None:
    case = case_from_text(FILM.format(film=""))
    assert case.film is not None
    with pytest.raises(InputError, match="no modulus"):
        film_shear_modulus(case.film, case.substrate)


def test_report_leaves_out_what_a_case_has_no_inputs_for() -> None:
    case = case_from_text(FILM.format(film=""))
    names = {number.name for number in report(case)}
    assert {"bar speed, long-term", "block height over film thickness"} <= names
    missing = {
        "retardation time",
        "loss modulus",
        "nominal strain rate",
        "delay of buckling",
        "film shear modulus",
    }
    assert not missing & names


@pytest.mark.parametrize("file", sorted((ROOT / "examples").glob("*.toml")), ids=lambda file: file.stem)
def test_report_of_every_example(file: Path) -> None:
    numbers = report(load_case(file))
    assert len({number.name for number in numbers}) == len(numbers)
    assert all(math.isfinite(number.value) for number in numbers)
