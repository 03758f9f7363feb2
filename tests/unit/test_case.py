"""Case files that are right: values, defaults, overrides, and the way back to TOML."""

from __future__ import annotations

import math
import tomllib
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.config import Case, case_from_text, load_case
from wrinklewave.config.drives import HistoryDrive, StrikerDrive
from wrinklewave.config.writing import toml_text

EXAMPLES = Path(__file__).parents[2] / "examples"
SMALLEST = """
[block]
length = "50 mm"
height = "20 mm"
[substrate]
density = "965 kg/m^3"
shear_modulus = "44 kPa"
poisson_ratio = 0.49
[mesh]
elements = [50, 10]
[drive]
kind = "striker"
velocity = "10 m/s"
rise_time = "0.1 ms"
stop_distance = "6.3 mm"
[solver]
end_time = "1 ms"
"""


@pytest.fixture
def paper() -> Case:
    return load_case(EXAMPLES / "paper_impact.toml")


def test_paper_case_in_si_units(paper: Case) -> None:
    assert (paper.block.length, paper.block.height, paper.block.meshed_height) == (0.0504, 0.037, 0.0185)
    assert (paper.substrate.density, paper.substrate.shear_modulus) == (965.0, 44e3)
    assert [(term.shear_modulus, term.relaxation_time) for term in paper.substrate.prony] == [(3.35e6, 9e-5)]
    assert paper.film is not None
    assert (paper.film.thickness, paper.film.critical_wavelength) == (1.4e-4, 2e-3)
    assert isinstance(paper.drive, StrikerDrive)
    assert (paper.drive.velocity, paper.drive.rise_time, paper.drive.stop_distance) == (10.0, 5e-4, 6.3e-3)
    assert paper.mesh.elements == (202, 74)
    assert paper.analysis.times == (3.8e-4, 1.2e-3, 3.4e-3)


@pytest.mark.parametrize("file", sorted(EXAMPLES.glob("*.toml")), ids=lambda file: file.stem)
def test_examples_survive_the_way_to_toml_and_back(file: Path) -> None:
    case = load_case(file)
    assert case_from_text(case.to_toml()) == case


def test_what_is_left_out_follows_from_the_block_and_the_end_time() -> None:
    case = case_from_text(SMALLEST)
    assert case.film is None
    assert case.wrinkles.model == "none"
    length, height, end, wavelength = 50e-3, 20e-3, 1e-3, 50e-3 / 25
    assert case.wrinkles.averaging_depth == pytest.approx(height / 2)
    assert case.output.pixel_size == pytest.approx(length / 1000)
    assert case.output.surface_interval == pytest.approx(end / 500)
    assert case.output.field_interval == pytest.approx(end / 50)
    assert case.output.history_interval == pytest.approx(end / 500)
    assert case.analysis.front_window == pytest.approx((0.25 * length, 0.8 * length))
    assert case.analysis.wrinkle_threshold == pytest.approx(wavelength / 40)
    assert case.analysis.filter_wavelength == pytest.approx(2.5 * wavelength)
    assert case.analysis.amplitude_window == pytest.approx((length / 3, 0.95 * length))
    assert case.analysis.positions == pytest.approx((0.3 * length, 0.5 * length, 0.9 * length))
    assert case.analysis.times == pytest.approx((0.1 * end, 0.25 * end, 0.7 * end))


def test_film_takes_after_the_substrate() -> None:
    film = '[film]\nthickness = "0.1 mm"\ncritical_strain = 0.05\ncritical_wavelength = "3 mm"\n'
    case = case_from_text(SMALLEST + film)
    assert case.film is not None
    assert (case.film.poisson_ratio, case.film.density) == (0.49, 965.0)
    assert case.wrinkles.model == "quasi-static"
    assert case.analysis.filter_wavelength == pytest.approx(7.5e-3)


def test_film_takes_poisson_ratio_from_a_bulk_modulus() -> None:
    bulk = 2 * 44e3 * 1.3 / (3 * (1 - 0.6))  # of nu = 0.3
    text = SMALLEST.replace("poisson_ratio = 0.49", f'bulk_modulus = "{bulk} Pa"')
    case = case_from_text(text + '[film]\nthickness = "0.1 mm"\nshear_modulus = "2 MPa"\n')
    assert case.film is not None
    assert case.film.poisson_ratio == pytest.approx(0.3, rel=1e-12)


def test_overrides_replace_values() -> None:
    case = load_case(
        EXAMPLES / "paper_impact.toml",
        [
            "drive.velocity=5 m/s",
            "mesh.elements=[10, 20]",
            'case.name="slow"',
            "substrate.prony.0.relaxation_time=60 us",
        ],
    )
    assert isinstance(case.drive, StrikerDrive)
    assert case.drive.velocity == 5.0
    assert case.mesh.elements == (10, 20)
    assert case.name == "slow"
    assert case.substrate.prony[0].relaxation_time == 6e-5


def test_overridden_copy_leaves_the_case_alone(paper: Case) -> None:
    copy = paper.overridden("substrate.bulk_response=relaxing")
    assert (copy.substrate.bulk_response, paper.substrate.bulk_response) == ("relaxing", "elastic-long-term")
    assert copy.overridden("substrate.bulk_response=elastic-long-term") == paper


def test_files_are_relative_to_the_case(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "end.csv").write_text("time_s,u_x_m\n0,0\n0.001,0.005\n")
    text = SMALLEST.split("[drive]")[0] + '[drive]\nkind = "history"\nfile = "end.csv"\n'
    (tmp_path / "case.toml").write_text(text + '[solver]\nend_time = "1 ms"\n')
    case = load_case(tmp_path / "case.toml")
    assert isinstance(case.drive, HistoryDrive)
    assert case.drive.file == tmp_path / "end.csv"
    monkeypatch.chdir("/")
    assert case_from_text(case.to_toml()) == case


scalars = st.text() | st.booleans() | st.integers() | st.floats(allow_nan=False, allow_infinity=False)
keys = st.sampled_from(["length", "times", "prony", "a-b", "x1"])
tables = st.dictionaries(keys, scalars | st.lists(scalars, max_size=3), max_size=3)


@given(st.dictionaries(keys, tables | st.lists(tables, min_size=1, max_size=2) | scalars))
def test_toml_text_reads_back(data: dict[str, object]) -> None:
    assert tomllib.loads(toml_text(data)) == data


@given(st.floats(1e-6, 1e3), st.floats(-0.99, 0.499))
def test_any_valid_number_survives(length: float, nu: float) -> None:
    overrides = [f"drive.velocity={length!r} m/s", "drive.rise_time=0 s"]  # any speed is gained at once
    case = case_from_text(SMALLEST.replace("0.49", repr(nu)), overrides=overrides)
    assert isinstance(case.drive, StrikerDrive)
    assert math.isclose(case.drive.velocity, length, rel_tol=0)
    assert case_from_text(case.to_toml()) == case


DRIVES = {
    "end-motion": 'velocity = "10 m/s"\nstop_distance = "6.3 mm"\novershoot = "9 mm"\n'
    'overshoot_time = "2 ms"\nsmoothing = "0.1 ms"\ntransverse = "linear"',
    "compression": 'strain = 0.1\nduration = "0.4 ms"\nunload = true',
    "velocity-step": 'velocity = "1 mm/s"',
}
IMPERFECTIONS = {
    "sinusoidal": 'amplitude = "10 um"\nwavelength = "2 mm"',
    "random": 'amplitude = "10 um"\nwavelengths = ["1 mm", "4 mm"]\nseed = 7',
    "bump": 'amplitude = "10 um"\nposition = "20 mm"\nwidth = "1 mm"',
}


@pytest.mark.parametrize("kind", DRIVES)
def test_every_kind_of_drive(kind: str) -> None:
    before, rest = SMALLEST.split("[drive]")
    solver = rest[rest.index("[solver]") :]
    case = case_from_text(f'{before}[drive]\nkind = "{kind}"\n{DRIVES[kind]}\n{solver}')
    assert case.drive.kind == kind
    assert case_from_text(case.to_toml()) == case


@pytest.mark.parametrize("kind", IMPERFECTIONS)
def test_every_kind_of_imperfection(kind: str) -> None:
    film = '[film]\nthickness = "0.1 mm"\nshear_modulus = "2 MPa"\n[[film.prony]]\nshear_modulus = "1 MPa"\n'
    film += f'relaxation_time = "90 us"\n[film.imperfection]\nkind = "{kind}"\n{IMPERFECTIONS[kind]}\n'
    case = case_from_text(SMALLEST + film)
    assert case.film is not None
    assert case.film.imperfection is not None
    assert case.film.imperfection.kind == kind
    assert case_from_text(case.to_toml()) == case
