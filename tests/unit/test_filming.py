"""Filming a run: recording, truth and experiment file that fit together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

from wrinklewave import surface
from wrinklewave.cli import application
from wrinklewave.config.experiment import load_experiment
from wrinklewave.config.reading import load_case
from wrinklewave.errors import InputError
from wrinklewave.experiments.filming import film_run
from wrinklewave.imaging.prepared import open_experiment
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

EXAMPLES = Path(__file__).parents[2] / "examples"
pytest.importorskip("av")


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder as a simulation leaves it, with an analytic surface motion of 0.4 ms."""
    folder = tmp_path_factory.mktemp("run")
    surface.write(TravellingPulse(end_time=0.4e-3).surface(), folder / "surface.nc")
    (folder / "case.toml").write_text(
        load_case(EXAMPLES / "paper_impact.toml", ["solver.end_time=5 ms"]).to_toml()
    )
    return folder


@pytest.mark.parametrize("ending", ["tif", "avi"])
def test_the_files_fit_together(run: Path, tmp_path: Path, ending: str) -> None:
    filmed = film_run(run, tmp_path / f"v.{ending}", scale=5e3, contrast_to_noise=40.0, threads=2)
    experiment = load_experiment(filmed.experiment)
    assert (experiment.kind, experiment.contact.time) == ("impact", None)
    assert experiment.calibration.pixel_size == pytest.approx(0.2e-3)  # type: ignore[union-attr]
    assert experiment.sample.critical_wavelength == pytest.approx(2e-3)
    with open_experiment(experiment) as source, xr.open_dataset(filmed.truth, engine="h5netcdf") as truth:
        assert source.n_frames == truth.sizes["frame"] == 41
        assert source.times is not None
        np.testing.assert_allclose(source.times - 20 / 50e3, truth["time"].values, atol=1e-12)
        for index, image in source.frames(step=13):
            np.testing.assert_array_equal(image, filmed.film.frame(index))
        assert experiment.wires is not None
        assert experiment.wires.positions is not None
        places = np.array(experiment.wires.positions)
        assert np.abs(places[:, 0] - truth["wire_column"].values[0]).max() <= 0.5
        # the edge lies between sample and background in every frame
        for index, image in source.frames(step=10):
            edge, inside = (
                truth["edge_row"].values[index],
                np.flatnonzero(np.isfinite(truth["edge_row"].values[index])),
            )
            clear = inside[12:-12:7]
            below = image[np.round(edge[clear] + 5).astype(int), clear]
            assert below.mean() < 0.5 * image[:3, clear].mean()


def test_a_frame_rate_against_the_camera_is_noted(run: Path, tmp_path: Path) -> None:
    """A rate that is mistyped makes all speeds wrong by its factor."""
    filmed = film_run(run, tmp_path / "v.tif", scale=2e3)
    for rate, noted in (("50 kHz", False), ("50.001 kHz", False), ("5 kHz", True)):
        with open_experiment(load_experiment(filmed.experiment, [f"video.frame_rate={rate}"])) as source:
            assert any("the camera's own clock" in note for note in source.notes) is noted


def test_a_compression_is_a_quasi_static_series(tmp_path: Path) -> None:
    surface.write(TravellingPulse(end_time=0.4e-3).surface(), tmp_path / "surface.nc")
    (tmp_path / "case.toml").write_text(load_case(EXAMPLES / "quasi_static_compression.toml").to_toml())
    filmed = film_run(tmp_path, tmp_path / "series.tif", scale=2e3, frames=7)
    experiment = load_experiment(filmed.experiment)
    assert (experiment.kind, experiment.wires) == ("quasi-static", None)
    with open_experiment(experiment) as source:
        assert source.n_frames == 7


def test_a_surface_motion_alone_is_enough(run: Path, tmp_path: Path) -> None:
    surface.write(surface.read(run), tmp_path / "any.nc")
    filmed = film_run(tmp_path / "any.nc", tmp_path / "v.tif", scale=2e3)
    experiment = load_experiment(filmed.experiment)
    assert experiment.contact.time == pytest.approx(20 / 50e3)  # without a striker there is none to detect


def test_command(run: Path, tmp_path: Path) -> None:
    out = tmp_path / "v.mp4"
    options = ["--scale", "2", "--wire", "12 mm", "--contrast-to-noise", "20", "--exposure", "1 us"]
    result = CliRunner().invoke(application(), ["film", str(run), "--out", str(out), *options])
    assert result.exit_code == 0, result.output
    assert "contrast to noise at the surface 20" in result.output
    experiment = load_experiment(tmp_path / "v.experiment.toml")
    assert experiment.wires is not None
    assert len(experiment.wires.positions or ()) == 1
    with open_experiment(experiment) as source:
        assert source.bit_depth == 10


@pytest.mark.parametrize(
    ("options", "key"),
    [(["--exposure", "5"], "--exposure"), (["--wire", "12 kg"], "--wire"), (["--blur", "0.1"], "blur"),
     (["--wire", "90 mm"], "wires"), (["--exposure", "1 ms"], "exposure"), (["--scale", "9000"], "shape"),
     (["--frames", "7"], "--frames"), (["--contrast-to-noise", "0"], "contrast_to_noise"),
     (["--frame-rate", "10 Hz"], "--frame-rate"), (["--frame-rate", "0 Hz"], "frame_rate"),
     (["--bit-depth", "0"], "bit_depth"), (["--bit-depth", "-1"], "bit_depth"), (["--seed", "-4"], "seed"),
     (["--scale", "nan"], "scale"), (["--blur", "nan"], "blur"), (["--tilt", "95"], "tilt")],
)  # fmt: skip
def test_mistakes(run: Path, tmp_path: Path, options: list[str], key: str) -> None:
    result = CliRunner().invoke(application(), ["film", str(run), "--out", str(tmp_path / "v.tif"), *options])
    assert isinstance(result.exception, InputError)
    assert result.exception.key == key
    assert list(tmp_path.iterdir()) == []


def test_mistakes_are_told_in_the_units_that_they_were_made_in(run: Path, tmp_path: Path) -> None:
    for camera, words in (
        ({"tilt": 1.0}, "57.2958 degrees"),
        ({"exposure": 1e-3}, "1.000 ms\n  expected: from 0 to the time between frames, 20.00 us"),
        ({"scale": -3e3}, "-3 pixels per mm"),
    ):
        with pytest.raises(InputError, match=words):
            film_run(run, tmp_path / "v.tif", **camera)


def test_no_recording_is_lost(run: Path, tmp_path: Path) -> None:
    (tmp_path / "v.experiment.toml").write_text("completed by hand")
    with pytest.raises(InputError, match=r"v\.experiment\.toml: is there already"):
        film_run(run, tmp_path / "v.tif", scale=2e3)
    assert [file.name for file in tmp_path.iterdir()] == ["v.experiment.toml"]
    assert film_run(run, tmp_path / "v.tif", scale=2e3, overwrite=True).video.exists()
    with pytest.raises(InputError, match=r"v\.tif: is there already"):
        film_run(run, tmp_path / "v.tif", scale=2e3)
