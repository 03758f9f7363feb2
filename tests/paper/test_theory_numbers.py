"""The theory report against the paper: the digits that it prints, and the numbers recomputed for it."""

from __future__ import annotations

import csv
import json
from decimal import Decimal
from pathlib import Path

import pytest

from wrinklewave.config import Case, load_case
from wrinklewave.theory import report as theory
from wrinklewave.theory.report import Quantity, Row, report

ROOT = Path(__file__).parents[2]
ROWS = [row for rows in theory.ROWS.values() for row in rows]

# quantity of the reference file -> names in the report, in the order of the file's values
RECOMPUTED = {
    "E0": ["Young's modulus, long-term"],
    "E1": ["Young's modulus, relaxing share"],
    "K0 (long-term)": ["bulk modulus, long-term"],
    "K_i (instantaneous)": ["bulk modulus, instantaneous"],
    "K0/mu0": ["bulk over shear modulus"],
    "mu_i/mu0 = E_i/E0": ["instantaneous stiffening"],
    "Prony g1": ["Prony ratio"],
    "retardation time": ["retardation time"],
    "c_0": ["bar speed, long-term"],
    "c_1": ["bar speed, instantaneous"],
    "c_0 plane strain plate": ["plane-strain speed, long-term"],
    "c_1 plane strain plate": ["plane-strain speed, instantaneous"],
    "c_T long / inst": ["shear-wave speed, long-term", "shear-wave speed, instantaneous"],
    "c_L": ["plane-wave speed, instantaneous"],
    "c_L long-term": ["plane-wave speed, long-term"],
    "c_L if K did NOT relax and K=K0": ["plane-wave speed, instantaneous, K = K_0 always"],
    "c_L if K did not relax and K=K_i": ["plane-wave speed, long-term, K = K_i always"],
    "f_0 Love": ["Love's limit, long-term"],
    "f_1 Love": ["Love's limit, instantaneous"],
    "Love analogue in plane strain f_0,f_1": [
        "Love's limit in plane strain, long-term",
        "Love's limit in plane strain, instantaneous",
    ],
    "omega tau at 400 Hz": ["frequency times relaxation time"],
    "E', E'', |E*| at 400 Hz": ["storage modulus", "loss modulus", "dynamic modulus"],
    "tan delta at 400 Hz": ["loss tangent"],
    "c* at 400 Hz": ["viscoelastic bar speed"],
    "c* without the sec factor": ["viscoelastic bar speed without the secant"],
    "c* plane-strain plate": ["viscoelastic plane-strain speed"],
    "attenuation length at 400 Hz": ["attenuation length"],
    "eps_S": ["static strain at the stoppers"],
    "striker contact to stop": ["time from contact to the stoppers"],
    "1/tau": ["relaxation rate"],
    "t_c": ["delay of buckling"],
    "E_f/E_s from eps_c=0.043": ["film modulus ratio from the critical strain"],
    "film shear modulus from eps_c": ["film shear modulus"],
    "lambda_c as printed": ["critical wavelength as the paper prints it"],
    "lambda_c corrected": ["critical wavelength from the moduli"],
    "E_f/E_s from lambda_c=2.0 mm": ["film modulus ratio from the critical wavelength"],
    "eps_ci/eps_c": ["critical strain on the instantaneous substrate"],
    "number of wrinkles in L0 (material)": ["wrinkles along the block"],
    "material wavelength if 2.0 mm was measured on the compressed sample at eps_c": [
        "wavelength if it was measured on the compressed sample"
    ],
    "H/h": ["block height over film thickness"],
    "k_c h": ["wavenumber times thickness"],
    "W as printed: stress at F=I": ["stress at rest of the printed energy"],
}


@pytest.fixture(scope="module")
def paper_case() -> Case:
    return load_case(ROOT / "examples" / "paper_impact.toml")


@pytest.fixture(scope="module")
def numbers(paper_case: Case) -> dict[str, Quantity]:
    return {number.name: number for number in report(paper_case)}


def recomputed() -> dict[str, list[float]]:
    lines = (ROOT / "tests" / "reference" / "paper_numbers.csv").read_text(encoding="utf-8").splitlines()
    rows = csv.DictReader(line for line in lines if not line.startswith("#"))
    values = {row["quantity"]: json.loads(row["computed"]) for row in rows}
    return {name: value if isinstance(value, list) else [value] for name, value in values.items()}


@pytest.mark.parametrize("row", [row for row in ROWS if row.paper], ids=lambda row: row.name)
def test_digits_that_the_paper_prints(row: Row, numbers: dict[str, Quantity]) -> None:
    number = numbers[row.name]
    assert number.paper is not None
    printed = Decimal(number.paper)
    assert Decimal(repr(number.value)).quantize(printed) == printed


@pytest.mark.parametrize("quantity", RECOMPUTED)
def test_recomputed_numbers(quantity: str, numbers: dict[str, Quantity]) -> None:
    values = [numbers[name].value for name in RECOMPUTED[quantity]]
    assert values == pytest.approx(recomputed()[quantity], rel=1e-12)


def test_exact_wrinkle_amplitudes() -> None:
    from wrinklewave.theory.wrinkling import inextensible_amplitude

    rows = {name: value for name, value in recomputed().items() if name.startswith("A exact inextensible")}
    assert len(rows) == 6
    for name, (amplitude,) in rows.items():
        strain = float(name.rpartition("=")[2])
        assert inextensible_amplitude(strain, 0.043, 2e-3) == pytest.approx(amplitude, rel=1e-12)


def test_every_number_of_the_paper_case_is_there(numbers: dict[str, Quantity]) -> None:
    assert list(numbers) == [row.name for row in ROWS]


def test_paper_values_stand_beside_the_papers_case_only(paper_case: Case) -> None:
    other = report(paper_case.overridden("drive.velocity=9 m/s"))
    assert [number.name for number in other if number.paper is not None] == []
