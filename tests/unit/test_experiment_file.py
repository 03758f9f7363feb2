"""Experiment files: what they mean, and one clear error for each mistake."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from wrinklewave.config.experiment import Experiment, experiment_from_text, load_experiment
from wrinklewave.config.problems import CombinedInputError
from wrinklewave.errors import InputError

GOOD = """
[experiment]
kind = "impact"
name = "paper impact"
[video]
file = "a.tif"
frame_rate = "50 kHz"
undeformed_frames = 10
[calibration]
kind = "scale"
pixel_size = "50 um"
x_axis = "right"
y_axis = "up"
[sample]
length = "50.4 mm"
critical_wavelength = "2 mm"
[wires]
positions = [[300, 71.5], [500, 70]]
"""
QUASI_STATIC = (
    GOOD.replace('"impact"', '"quasi-static"')
    .replace('frame_rate = "50 kHz"\n', "")
    .replace("[wires]\npositions = [[300, 71.5], [500, 70]]", '[second_series]\nfile = "a.tif"')
)


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    (tmp_path / "a.tif").write_bytes(b"a recording")
    return tmp_path


def _read(text: str, folder: Path) -> Experiment:
    return experiment_from_text(text, folder=folder, source="experiment.toml")


def test_si_values_and_defaults(folder: Path) -> None:
    experiment = _read(GOOD, folder)
    assert (experiment.kind, experiment.name) == ("impact", "paper impact")
    assert experiment.video.file == folder / "a.tif"
    assert experiment.video.frame_rate == 50e3
    assert experiment.calibration.pixel_size == 50e-6  # type: ignore[union-attr]
    assert experiment.contact.time is None
    assert experiment.wires is not None
    assert experiment.wires.positions == ((300.0, 71.5), (500.0, 70.0))
    # in proportion to the sample, as in a case file
    assert experiment.analysis.front_window == pytest.approx((0.25 * 0.0504, 0.8 * 0.0504))
    assert experiment.analysis.filter_wavelength == pytest.approx(5e-3)
    assert experiment.analysis.times == ()


@pytest.mark.parametrize("text", [GOOD, QUASI_STATIC, GOOD + '[contact]\ntime = "-0.3 ms"\n'])
def test_resolved_file_reads_back_equal(folder: Path, text: str) -> None:
    experiment = _read(text, folder)
    assert _read(experiment.to_toml(), folder) == experiment


def test_from_a_file_with_overrides(folder: Path) -> None:
    (folder / "e.toml").write_text(GOOD)
    experiment = load_experiment(folder / "e.toml", ["video.frame_rate=20 kHz", "contact.time=1 ms"])
    assert (experiment.video.frame_rate, experiment.contact.time) == (20e3, 1e-3)


def test_contact_time_on_the_camera_clock_may_be_negative(folder: Path) -> None:
    assert _read(GOOD + '[contact]\ntime = "-601.2 ms"\n', folder).contact.time == pytest.approx(-0.6012)
    assert _read(GOOD + '[contact]\ntime = "detect"\n', folder).contact.time is None


def test_scale_from_two_points(folder: Path) -> None:
    text = GOOD.replace(
        'kind = "scale"\npixel_size = "50 um"',
        'kind = "two-points"\npoints = [[100, 50], [400, 450]]\ndistance = "25 mm"',
    )
    assert np.isclose(_read(text, folder).calibration.pixel_size, 50e-6)  # type: ignore[union-attr]


def test_scale_from_the_sample(folder: Path) -> None:
    text = GOOD.replace('kind = "scale"\npixel_size = "50 um"', 'kind = "sample-length"\nends = [40, 1048]')
    calibration = _read(text, folder).calibration
    assert calibration.kind == "sample-length"
    assert calibration.ends == (40.0, 1048.0)


def test_second_series_shares_the_calibration(folder: Path) -> None:
    experiment = _read(QUASI_STATIC, folder)
    assert experiment.second_calibration == experiment.calibration


WIRES = "positions = [[300, 71.5], [500, 70]]"
MISTAKES = [
    # what is replaced, by what, the key that the error names, a word of its message
    ('kind = "scale"\npixel_size = "50 um"', "", "calibration.kind", "has no kind"),
    ('kind = "scale"', 'kind = "guess"', "calibration.kind", "not a choice"),
    ('pixel_size = "50 um"', "", "calibration.pixel_size", "missing"),
    ('x_axis = "right"', "", "calibration.x_axis", "missing"),
    ('y_axis = "up"', "", "calibration.y_axis", "missing"),
    ('"up"', '"left"', "calibration", "same line"),
    ('"up"', '"north"', "calibration.y_axis", "not a choice"),
    ('"50 um"', '"50 kHz"', "calibration.pixel_size", "not of length"),
    ('"50 um"', "50", "calibration.pixel_size", "has no unit"),
    ('"50 um"', '"-50 um"', "calibration.pixel_size", "out of range"),
    (
        'kind = "scale"\npixel_size = "50 um"',
        'kind = "two-points"\npoints = [[1, 2], [1, 2]]\ndistance = "3 mm"',
        "calibration",
        "0 px apart",
    ),
    ('kind = "scale"\npixel_size = "50 um"', 'kind = "sample-length"\nends = [9, 9]', "calibration", "apart"),
    ('length = "50.4 mm"', "", "sample.length", "missing"),
    ('"50.4 mm"', '"-3 mm"', "sample.length", "out of range"),
    ("a.tif", "missing.tif", "video.file", "there is no"),
    ('frame_rate = "50 kHz"', "frame_rate = 50000", "video.frame_rate", "has no unit"),
    ("undeformed_frames = 10", "undeformed_frames = 0", "video.undeformed_frames", "out of range"),
    ("undeformed_frames", "undeformedframes", "video.undeformedframes", "unknown key"),
    ("undeformed_frames = 10", "undeformed_frames = 10\nframes = [5, 2]", "video.frames", "empty"),
    (
        "undeformed_frames = 10",
        "undeformed_frames = 10\nframes = [2, 5]",
        "video.undeformed_frames",
        "10 of 3",
    ),
    ("undeformed_frames = 10", "bit_depth = 40", "video.bit_depth", "out of range"),
    (WIRES, "", "wires", "neither"),
    (WIRES, f"count = 2\n{WIRES}", "wires", "both"),
    (WIRES, "count = 0", "wires.count", "out of range"),
    (GOOD, QUASI_STATIC.replace('"quasi-static"', '"impact"'), "second_series", "no meaning"),
    (GOOD, GOOD.replace('"impact"', '"quasi-static"'), "wires", "no meaning"),
    ("[wires]", '[contact]\ntime = "soon"\n[wires]', "contact.time", "no quantity"),
    (
        "[wires]",
        '[analysis]\nfront_window = ["1 mm", "80 mm"]\n[wires]',
        "analysis.front_window",
        "on the sample",
    ),
    ("[wires]", "[region]\nrows = [5, 5]\n[wires]", "region.rows", "empty"),
    ("[calibration]", "[kalibration]", "kalibration", "unknown key"),
]


@pytest.mark.parametrize(("old", "new", "key", "words"), MISTAKES)
def test_one_clear_error_for_each_mistake(folder: Path, old: str, new: str, key: str, words: str) -> None:
    assert old in GOOD
    with pytest.raises(InputError) as caught:
        _read(GOOD.replace(old, new), folder)
    error = caught.value
    errors = error.errors if isinstance(error, CombinedInputError) else (error,)
    (named,) = [one for one in errors if one.key == key]
    assert words in str(named)
    assert named.expected
    assert named.cure
    assert str(named.file) == "experiment.toml"


def test_no_toml(folder: Path) -> None:
    with pytest.raises(InputError, match="no valid TOML"):
        _read(GOOD.replace('"50.4 mm"', '"50.4 mm'), folder)
