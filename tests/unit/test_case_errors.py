"""Bad case files: each gives a clear error that names file, key, value, what is expected and the cure."""

from __future__ import annotations

import tomllib
from collections.abc import Iterator
from pathlib import Path

import pytest

from wrinklewave.config import load_case, read_history, read_profile
from wrinklewave.config.experiment import load_experiment
from wrinklewave.config.problems import CombinedInputError
from wrinklewave.errors import InputError

GOOD = """
[case]
name = "good"

[block]
length = "50 mm"
height = "20 mm"

[substrate]
density = "965 kg/m^3"
shear_modulus = "44 kPa"
poisson_ratio = 0.49
bulk_response = "relaxing"

[[substrate.prony]]
shear_modulus = "3.35 MPa"
relaxation_time = "90 us"

[film]
thickness = "140 um"
critical_strain = 0.043
critical_wavelength = "2.0 mm"

[mesh]
elements = [50, 10]

[drive]
kind = "striker"
velocity = "10 m/s"
rise_time = "0.1 ms"
stop_distance = "6.3 mm"

[solver]
end_time = "1 ms"

[output]
surface_interval = "10 us"
probes = ["15 mm"]

[analysis]
front_window = ["10 mm", "40 mm"]
"""
BAD = tomllib.loads((Path(__file__).parent / "bad_cases.toml").read_text(encoding="utf-8"))
STRIKER = GOOD[GOOD.index("[drive]") : GOOD.index("[solver]")]


def error_of(folder: Path, text: str, *overrides: str) -> InputError:
    file = folder / "case.toml"
    file.write_text(text)
    with pytest.raises(InputError) as caught:
        load_case(file, overrides)
    return caught.value


def test_the_good_case_is_good(tmp_path: Path) -> None:
    (tmp_path / "case.toml").write_text(GOOD)
    assert load_case(tmp_path / "case.toml").name == "good"


@pytest.mark.parametrize("mistake", BAD)
def test_bad_case(tmp_path: Path, mistake: str) -> None:
    change = BAD[mistake]
    assert change["replace"] in GOOD
    error = error_of(tmp_path, GOOD.replace(change["replace"], change["by"], 1))
    assert error.key == change.get("key")
    assert str(error).startswith(f"{tmp_path / 'case.toml'}: ")
    for words in change["says"]:
        assert words in str(error)
    assert error.expected
    assert error.cure
    assert error.exit_code == 2


@pytest.mark.parametrize(
    "limit",
    [
        "output.surface_interval=333.3333 us",
        "output.pixel_size=16.66 mm",
        "output.probes=['0 mm', '50 mm']",
        "analysis.front_window=['0 mm', '50 mm']",
        "analysis.times=['1 ms']",
        "wrinkles.averaging_depth=10 mm",
        "boundaries.slip=9.999 mm",
        "film.thickness=19.99 mm",
        "film.end_gap=49.99 mm",
        "drive.stop_distance=49.99 mm",
        "drive.rise_time=0.63 ms",  # speed is gained all the way to the stoppers
        "solver.mass_scaling=1",
    ],
)
def test_limits_themselves_are_allowed(tmp_path: Path, limit: str) -> None:
    (tmp_path / "case.toml").write_text(GOOD)
    assert load_case(tmp_path / "case.toml", [limit]).name == "good"


def test_missing_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"nothing\.toml: no such file") as caught:
        load_case(tmp_path / "nothing.toml")
    assert caught.value.cure == "check the path"


def test_folder_and_binary_file(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="cannot be read"):
        load_case(tmp_path)
    (tmp_path / "picture.toml").write_bytes(b"\x89PNG\xff\xfe")
    with pytest.raises(InputError, match="is no text"):
        load_case(tmp_path / "picture.toml")


def test_a_case_is_no_experiment_and_the_reverse(tmp_path: Path) -> None:
    file = tmp_path / "some.toml"
    for section, read, verb in (("video", load_case, "measure"), ("block", load_experiment, "simulate")):
        file.write_text(f"[{section}]\n[analysis]\n", "utf-8")
        with pytest.raises(InputError, match=f"wrinklewave {verb} takes it"):
            read(file)


def test_all_mistakes_come_at_once(tmp_path: Path) -> None:
    text = GOOD.replace("0.49", "0.6").replace('"50 mm"', "50").replace("elements", "elemets")
    error = error_of(tmp_path, text)
    assert isinstance(error, CombinedInputError)
    assert {one.key for one in error.errors} == {
        "block.length",
        "substrate.poisson_ratio",
        "mesh.elements",
        "mesh.elemets",
    }
    assert str(error).startswith("4 mistakes")
    assert all(str(one) in str(error) for one in error.errors)


def test_mistakes_of_the_whole_come_at_once(tmp_path: Path) -> None:
    text = GOOD.replace('"40 mm"]', '"60 mm"]').replace('["15 mm"]', '["70 mm"]')
    error = error_of(tmp_path, text)
    assert isinstance(error, CombinedInputError)
    assert {one.key for one in error.errors} == {"output.probes.0", "analysis.front_window"}


def test_derived_values_are_not_blamed(tmp_path: Path) -> None:
    """A height that is wrong makes the averaging depth wrong; only the height is the user's."""
    error = error_of(tmp_path, GOOD.replace('"20 mm"', '"-20 mm"'))
    assert error.key == "block.height"


@pytest.mark.parametrize(
    ("override", "key", "words"),
    [
        ("drive.velocity=-5 m/s", "drive.velocity", ['"-5 m/s" is out of range']),
        ("drive.velocity=5", "drive.velocity", ["5 has no unit"]),
        ("drive.velocty=5 m/s", "drive.velocty", ['did you mean "velocity"?']),
        ("drives.velocity=5 m/s", "drives", ['did you mean "drive"?']),
        ("velocity", None, ['"velocity" is no override', "section.key=value"]),
        ("=5", None, ["is no override"]),
        (
            "substrate.prony.3.relaxation_time=1 us",
            "substrate.prony.3.relaxation_time",
            ["no entry", "0 to 0"],
        ),
        ("block.length.unit=mm", "block.length.unit", ["inside a single value"]),
        ("drive.friction=high", "drive.friction", ['"high" does not fit', "a number, >= 0"]),
        ("mesh.elements=[1", "mesh.elements", ["does not fit"]),
        ("output.probes.0=99 mm", "output.probes.0", ["99 mm is outside the block"]),
    ],
)
def test_bad_override(tmp_path: Path, override: str, key: str | None, words: list[str]) -> None:
    error = error_of(tmp_path, GOOD, override)
    assert str(error).startswith("--set: ")
    assert error.key == key
    for word in words:
        assert word in str(error)


def test_mistake_between_file_and_override_names_both(tmp_path: Path) -> None:
    error = error_of(
        tmp_path, GOOD.replace("[analysis]", '[analysis]\ntimes = ["0.9 ms"]'), "solver.end_time=0.5 ms"
    )
    assert error.key == "analysis.times.0"
    assert "case.toml (with --set solver.end_time)" in str(error)


@pytest.mark.parametrize(
    ("rows", "words"),
    [
        ("", ["has no column time_s", "u_y_m"]),
        ("time_s,u_y_m\n0,0\n1,1\n", ["has no column u_x_m"]),
        ("t,u_x_m\n0,0\n1,1\n", ["has no column time_s"]),
        ("time_s,u_x_m,force\n0,0,0\n1,1,1\n", ['"force"', "remove or rename"]),
        ("time_s,u_x_m,u_x_m\n0,0,0\n1,1,1\n", ['"u_x_m"', "twice"]),
        ("time_s,u_x_m\n0,0\n", ["has 1 rows", "at least two"]),
        ("time_s,u_x_m\n0,0\n\n0.001\n", ["line 4 has 1 values", "2"]),
        ("time_s,u_x_m\n0,0\n0.001,fast\n", ["u_x_m", '"fast" in line 3']),
        ("time_s,u_x_m\n0,0\n0.001,nan\n", ['"nan" in line 3', "finite"]),
        ("time_s,u_x_m\n0,0\n0.002,1\n\n0.001,2\n", ["goes from 0.002 to 0.001 in line 5", "increase"]),
        ("time_s,u_x_m\n0,0\n0,1\n", ["goes from 0 to 0 in line 3"]),
    ],
)  # fmt: skip
def test_bad_history(tmp_path: Path, rows: str, words: list[str]) -> None:
    file = tmp_path / "end.csv"
    file.write_text(rows)
    with pytest.raises(InputError) as caught:
        read_history(file)
    for word in words:
        assert word in str(caught.value)
    # the same mistake, met by way of a case: the key of the case and the file with the mistake are both named
    error = error_of(tmp_path, GOOD.replace(STRIKER, '[drive]\nkind = "history"\nfile = "end.csv"\n'))
    assert error.key == "drive.file"
    assert all(word in str(error) for word in ("case.toml", "end.csv", *words))


def test_history_shorter_than_the_run(tmp_path: Path) -> None:
    (tmp_path / "end.csv").write_text("time_s,u_x_m\n0,0\n0.0005,0.005\n")
    error = error_of(tmp_path, GOOD.replace(STRIKER, '[drive]\nkind = "history"\nfile = "end.csv"\n'))
    assert "covers 0 ms to 0.5 ms" in str(error)
    assert "solver.end_time = 1 ms" in str(error)


def test_history_columns(tmp_path: Path) -> None:
    (tmp_path / "end.csv").write_text("\ufeffu_x_m, time_s,u_y_m\n0,0,0\n0.005,0.001,0.01\n")
    history = read_history(tmp_path / "end.csv")
    assert history.time.tolist() == [0, 0.001]
    assert history.u_x.tolist() == [0, 0.005]
    assert history.u_y is not None
    assert history.u_y.tolist() == [0, 0.01]


def test_resolved_model_needs_a_seed(tmp_path: Path) -> None:
    text = GOOD.replace("[mesh]", '[wrinkles]\nmodel = "resolved"\n[mesh]')
    error = error_of(tmp_path, text, "film.modulus_from=critical_strain")
    assert error.key == "film.imperfection"
    assert "needs a seed" in str(error)


def test_profile_columns(tmp_path: Path) -> None:
    (tmp_path / "rough.csv").write_text("x_m,height_m\n0,1e-6\n0.05,2e-6\n")
    profile = read_profile(tmp_path / "rough.csv")
    assert profile.height.tolist() == [1e-6, 2e-6]


ODD = (
    "-1",
    "0",
    "1e308",
    "1e400",
    "true",
    "nothing",
    '""',
    "[]",
    "[1, [2, {a = 1}]]",
    "{}",
    "2024-01-01",
    "",
)
ODD_QUANTITIES = ("1e400 m", "1e-400 s", "1e308 Pa", "1 m/s", "1 Pa", "1e9 Hz", "1e-9 kg/m^3", "0 s", "0 m")


def keys_of(table: dict[str, object], path: str = "") -> Iterator[str]:
    """Dotted keys of every value, section and list entry."""
    for name, value in table.items():
        key = f"{path}{name}"
        yield key
        if isinstance(value, dict):
            yield from keys_of(value, f"{key}.")
        if isinstance(value, list):
            yield from keys_of({str(number): entry for number, entry in enumerate(value)}, f"{key}.")


def test_whatever_is_written_is_read_or_explained(tmp_path: Path) -> None:
    """Each key of the resolved case, entries and sections too, set to each odd value: a case or an error."""
    file = tmp_path / "case.toml"
    file.write_text(GOOD)
    file.write_text(load_case(file).to_toml())
    keys = list(keys_of(tomllib.loads(file.read_text())))
    refusals = [refusal(file, f"{key}={odd}") for key in keys for odd in (*ODD, *ODD_QUANTITIES)]
    assert len([text for text in refusals if text]) > 1000


def refusal(file: Path, override: str) -> str:
    """The message of the error; nothing if the case is right."""
    try:
        load_case(file, [override])
    except InputError as error:
        return str(error)
    return ""
