"""A quasi-static test from images to critical values: filmed compressions of which every number is known."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import wrinklewave as ww
from wrinklewave.cli import application
from wrinklewave.errors import InputError
from wrinklewave.experiments import measure_quasi_static
from wrinklewave.experiments.filming import film_run
from wrinklewave.experiments.interruption import Outcome
from wrinklewave.wrinkling.slow_compression import SlowCompression

STRAINS = tuple(np.linspace(0.0, 0.18, 31).tolist())
MARGINS = (5e-3, 2.5e-3)
CHANGES = '[analysis]\namplitude_window = ["12 mm", "45 mm"]\n[fit]\nstrains = [0.0, 0.18]\n'


@pytest.fixture(scope="module")
def experiment(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Two series on one sample at 20 px/mm and a contrast over noise of 20, and the experiment file of both."""
    folder = tmp_path_factory.mktemp("quasi-static")
    for name, critical_strain, seed in (("first", 0.043, 1), ("second", 0.047, 2)):
        made = SlowCompression(strains=STRAINS, margins=MARGINS, critical_strain=critical_strain)
        ww.write_surface(made.surface(), folder / f"{name}.nc")
        film_run(folder / f"{name}.nc", folder / f"{name}.tif", contrast_to_noise=20.0, seed=seed)
    text = (folder / "first.experiment.toml").read_text()
    file = folder / "both.toml"
    file.write_text(f'{text}\n[second_series]\nfile = "second.tif"\n{CHANGES}')
    return file


def test_measured_from_images(experiment: Path, tmp_path: Path) -> None:
    result = CliRunner().invoke(application(), ["measure", str(experiment), "--out", str(tmp_path / "m")])
    assert result.exit_code == 0, result.output
    summary = json.loads((tmp_path / "m" / "summary.json").read_text())
    # acceptance: within 2 % and 0.5 %, and within what is stated
    for prefix, critical_strain in (("", 0.043), ("second_", 0.047)):
        found = {name: summary[f"{prefix}{name}"] for name in ("critical_strain", "critical_strain_sigma")}
        assert found["critical_strain"] == pytest.approx(critical_strain, rel=0.02)
        assert abs(found["critical_strain"] - critical_strain) < 3 * found["critical_strain_sigma"]
        wavelength = summary[f"{prefix}critical_wavelength_m"]
        assert wavelength == pytest.approx(2e-3, rel=0.005)
        assert abs(wavelength - 2e-3) < 3 * summary[f"{prefix}critical_wavelength_sigma_m"] + 1e-7
    assert summary["critical_wavelength_compressed_m"] == pytest.approx(2e-3 * 0.957, rel=0.005)
    assert summary["initial_amplitude_m"] < 3 * summary["initial_amplitude_sigma_m"]
    assert summary["struck_margin_at_strain_max_m"] == pytest.approx(MARGINS[0], abs=1e-3)
    assert summary["held_margin_at_strain_max_m"] == pytest.approx(MARGINS[1], abs=1e-3)
    assert summary["critical_strain_change"] == pytest.approx(0.004, abs=4e-4)
    assert summary["undeformed_arc_m"] == pytest.approx(50.4e-3, rel=1e-4)
    files = {path.name for path in (tmp_path / "m").iterdir()}
    assert files == {
        *("surface.nc", "second_surface.nc", "series.csv", "second_series.csv", "summary.json"),
        *("experiment.toml", "report.html", "figures"),
    }
    figures = {path.stem for path in (tmp_path / "m" / "figures").iterdir()}
    assert {name[:7].rstrip("_") for name in figures} == {"fig_1ab", "fig_1d", "fig_1e", "fig_s3", "fig_s6"}
    page = (tmp_path / "m" / "report.html").read_text()
    assert "Fig. S6" in page
    assert "critical strain" in page
    table = np.genfromtxt(tmp_path / "m" / "series.csv", delimiter=",", names=True)
    np.testing.assert_allclose(table["strain"], STRAINS, atol=7e-4)


def test_a_series_by_itself_and_from_python(experiment: Path) -> None:
    found = ww.measure_quasi_static(experiment.with_name("first.experiment.toml"), threads=1)
    assert found.test is not None
    assert found.test.second is None
    assert "second_critical_strain" not in found.summary
    assert found.series[0].surface.attrs["procedure"] == "quasi-static"


def test_a_wrong_scale_is_noticed(experiment: Path) -> None:
    file, scale = experiment.with_name("first.experiment.toml"), "calibration.pixel_size=50.5 um"
    (warning,) = ww.measure_quasi_static(file, overrides=[scale]).warnings
    assert "50.9 mm long, not 50.4 mm (+1.0%)" in warning
    assert "sample-length" in warning


def test_a_plate_that_touches_is_not_the_sample(tmp_path: Path) -> None:
    """Real tests have a plate at the end that moves."""
    from wrinklewave.imaging.camera import Camera, Striker, film
    from wrinklewave.imaging.writing import write_recording

    surface = SlowCompression(strains=STRAINS[::3], margins=MARGINS).surface()
    camera = Camera.framing(surface, scale=20e3).at_contrast_to_noise(20.0)
    plate = Striker(velocity=1.0, stop_distance=1.0, height=2e-3)  # faster than the images: always in contact
    write_recording(
        film(surface, camera, striker=plate, times=surface["time"].values), tmp_path / "plate.tif"
    )
    (tmp_path / "plate.toml").write_text(
        '[experiment]\nkind = "quasi-static"\nname = "between plates"\n[video]\nfile = "plate.tif"\n'
        '[calibration]\nkind = "sample-length"\nx_axis = "right"\ny_axis = "up"\n[sample]\nlength = "50.4 mm"\n'
        + CHANGES
    )
    summary = ww.measure_quasi_static(tmp_path / "plate.toml").summary
    assert summary["critical_strain"] == pytest.approx(0.043, rel=0.02)
    assert summary["critical_wavelength_m"] == pytest.approx(2e-3, rel=0.005)


def test_mistakes(experiment: Path) -> None:
    with pytest.raises(InputError, match="images that can be read") as raised:
        ww.measure_quasi_static(
            experiment.with_name("first.experiment.toml"), overrides=["video.frames=[0, 3]"]
        )
    assert raised.value.exit_code == 2
    with pytest.raises(InputError, match="is empty"):
        ww.measure_quasi_static(experiment, overrides=["fit.strains=[0.2, 0.1]"])


def test_an_interrupted_test_goes_on_with_the_same_images_only(
    experiment: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = experiment.with_name("first.experiment.toml")
    with monkeypatch.context() as interrupted:
        interrupted.setattr(measure_quasi_static, "measure_frames", lambda *arguments: False)
        found = ww.measure_quasi_static(file, out=tmp_path / "m")
    assert found.outcome is Outcome.INTERRUPTED
    assert found.test is None
    with pytest.raises(InputError, match="another recording"):
        ww.measure_quasi_static(file, out=tmp_path / "m", overrides=["video.frames=[0, 20]"], resume=True)
    again = ww.measure_quasi_static(file, out=tmp_path / "m", resume=True)
    assert again.summary["critical_strain"] == ww.measure_quasi_static(file).summary["critical_strain"]
    assert not list((tmp_path / "m").glob(".*frames"))
