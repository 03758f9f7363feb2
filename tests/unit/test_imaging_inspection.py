"""What ``inspect`` finds out and suggests."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import tifffile
from typer.testing import CliRunner

from wrinklewave.cli import application
from wrinklewave.config.experiment import experiment_from_text, load_experiment
from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import ArraySource, open_recording
from wrinklewave.imaging.inspection import facts, grey_warnings, histogram, suggested_experiment


def _source(values: np.ndarray, **options: int) -> ArraySource:
    return ArraySource(values.reshape(1, -1, 10), **options)  # type: ignore[arg-type]


def _warnings(source: ArraySource) -> list[str]:
    return list(grey_warnings(source, histogram(source)))


def test_histogram_counts_every_pixel_of_the_sampled_frames() -> None:
    stack = np.random.default_rng(0).integers(0, 256, (100, 8, 10)).astype(np.uint8)
    grey = histogram(ArraySource(stack), sampled_frames=10)
    np.testing.assert_array_equal(grey.counts, np.bincount(stack[::10].ravel(), minlength=256))
    assert (grey.darkest, grey.brightest) == (stack[::10].min(), stack[::10].max())


@pytest.mark.parametrize(("dtype", "bits", "white"), [(np.uint8, 8, 255), (np.uint16, 12, 4000)])
def test_clipping_is_reported(dtype: type, bits: int, white: int) -> None:
    values = np.full(1000, 100, dtype)
    values[:20] = white
    values[20:25] = 0
    messages = _warnings(_source(values, bit_depth=bits, white_level=white))
    assert any(message.startswith("2.00%") and "white" in message for message in messages)
    assert any(message.startswith("0.50%") and "zero" in message for message in messages)


def test_no_warning_without_reason() -> None:
    values = np.random.default_rng(0).integers(100, 4000, 1000).astype(np.uint16)
    assert _warnings(_source(values, bit_depth=12)) == []


def test_a_depth_that_is_not_used() -> None:
    values = np.random.default_rng(0).integers(1, 1000, 1000).astype(np.uint16)
    (message,) = _warnings(_source(values))
    assert "video.bit_depth = 10" in message


def test_values_beyond_the_depth() -> None:
    values = np.random.default_rng(0).integers(1, 4000, 10_000).astype(np.uint16)
    values[3] = 1 << 15
    (message,) = _warnings(_source(values, bit_depth=12))
    assert "32768 does not fit in 12 bits" in message


def test_values_shifted_to_the_upper_bits() -> None:
    values = (np.random.default_rng(0).integers(1, 4000, 1000) << 4).astype(np.uint16)
    (message,) = _warnings(_source(values))
    assert "multiples of 16: 12 significant bits" in message


def test_facts_name_what_is_missing(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.tif", np.full((6, 8, 10), 7, np.uint8))
    file = tmp_path / "a.tif"
    file.write_bytes(file.read_bytes()[: 256 + 3 * 80])
    with open_recording(file) as source:
        found = facts(source, histogram(source))
    assert found["frames"] == "6"
    assert found["size"] == "10 x 8 pixels"
    assert found["unreadable"].startswith("3 (the file ends before it), 4")
    assert "give video.frame_rate" in found["frame rate"]


def test_suggestion_is_complete_once_the_marked_lines_are_given(tmp_path: Path) -> None:
    tifffile.imwrite(tmp_path / "a.tif", np.full((6, 8, 10), 7, np.uint8))
    with open_recording(tmp_path / "a.tif") as source:
        text = suggested_experiment(source, tmp_path)
    with pytest.raises(InputError, match="calibration"):
        experiment_from_text(text, folder=tmp_path)  # nothing is assumed
    given = (
        'frame_rate = "50 kHz"',
        "x_axis",
        "y_axis",
        'kind = "scale"',
        "pixel_size",
        'length = "50.4 mm"',
    )
    for line in given:
        assert f"# {line}" in text
        text = text.replace(f"# {line}", line)
    experiment = experiment_from_text(text, folder=tmp_path)
    assert experiment.video.file == tmp_path / "a.tif"
    assert experiment.video.frame_rate == 50e3
    assert experiment.sample.length == 0.0504


def test_command(tmp_path: Path) -> None:
    stack = np.random.default_rng(0).integers(50, 200, (6, 40, 60)).astype(np.uint8)
    tifffile.imwrite(tmp_path / "a.tif", stack, imagej=True, metadata={"finterval": 1e-4})
    result = CliRunner().invoke(
        application(), ["inspect", str(tmp_path / "a.tif"), "--out", str(tmp_path / "out")]
    )
    assert result.exit_code == 0, result.output
    assert "60 x 40 pixels" in result.output
    assert "10000 per second" in result.output
    assert (tmp_path / "out/a.contact-sheet.png").read_bytes()[:4] == b"\x89PNG"
    experiment = tmp_path / "out/a.experiment.toml"
    assert "../a.tif" in experiment.read_text()
    experiment.write_text("# mine\n")
    CliRunner().invoke(application(), ["inspect", str(tmp_path / "a.tif"), "--out", str(tmp_path / "out")])
    assert experiment.read_text() == "# mine\n"
    with pytest.raises(InputError):
        load_experiment(experiment)
