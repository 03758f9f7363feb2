"""From a recording to a surface motion: truth comes back, whatever way and however often it is measured."""

from __future__ import annotations

import os
import shutil
import signal
import tracemalloc
from concurrent.futures import ThreadPoolExecutor
from dataclasses import fields
from pathlib import Path

import numba
import numpy as np
import pytest
import xarray as xr
from typer.testing import CliRunner

import wrinklewave as ww
from wrinklewave.cli import application
from wrinklewave.config.experiment import Experiment, load_experiment
from wrinklewave.errors import InputError
from wrinklewave.experiments import frame_blocks, learning
from wrinklewave.experiments import measure as measuring
from wrinklewave.experiments.frame_blocks import FrameBlock, MeasuringProgress, measure_block
from wrinklewave.experiments.interruption import Outcome
from wrinklewave.experiments.learning import learn
from wrinklewave.experiments.measure import measure
from wrinklewave.imaging.camera import Camera, Levels, Striker, Wires, film
from wrinklewave.imaging.compiling import kernel_calls
from wrinklewave.imaging.edges.detect import _fine, _rough
from wrinklewave.imaging.frame_measuring import FrameMeasurer
from wrinklewave.imaging.frames import ArraySource, FrameSource, Image
from wrinklewave.imaging.prepared import open_experiment
from wrinklewave.imaging.writing import write_recording
from wrinklewave.wrinkling.travelling_pulse import TravellingPulse

PIXEL = 50e-6
PULSE = TravellingPulse(
    length=16e-3,
    half_height=8e-3,
    n_points=81,
    end_time=0.5e-3,
    travel=2e-3,
    front_speed=60.0,
    rise_time=0.3e-3,
    height=1.2e-3,
)
EXPERIMENT = """
experiment = {{ kind = "impact", name = "small pulse" }}
video = {{ file = "{file}", undeformed_frames = 12, frame_rate = "50 kHz" }}
calibration = {{ kind = "scale", pixel_size = "50 um", x_axis = "{x_axis}", y_axis = "{y_axis}" }}
sample = {{ length = "16 mm", height = "16 mm", critical_strain = 0.043, critical_wavelength = "2 mm" }}
wires = {{ count = 2 }}
analysis = {{ front_window = ["4 mm", "14 mm"], amplitude_window = ["4 mm", "14 mm"], filter_wavelength = "4 mm" }}
"""


@pytest.fixture(scope="module")
def filmed(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Folder with a small recording of an analytic impact, its experiment file and its truth."""
    folder = tmp_path_factory.mktemp("filmed")
    camera = Camera.framing(PULSE.surface(), scale=1 / PIXEL).at_contrast_to_noise(20.0)
    recording = film(
        PULSE.surface(),
        camera,
        striker=Striker(velocity=10.0, stop_distance=1.5e-3),
        wires=Wires(X=(5e-3, 10e-3)),
        frames_before=12,
    )
    write_recording(recording, folder / "impact.tif")
    recording.truth().to_netcdf(folder / "truth.nc", engine="h5netcdf")
    (folder / "impact.toml").write_text(
        EXPERIMENT.format(file="impact.tif", x_axis="right", y_axis="up"), "utf-8"
    )
    return folder


@pytest.fixture(scope="module")
def measured(filmed: Path, tmp_path_factory: pytest.TempPathFactory) -> ww.Measurement:
    return measure(filmed / "impact.toml", out=tmp_path_factory.mktemp("out") / "measured")


def truth_of(filmed: Path) -> xr.Dataset:
    return xr.load_dataset(filmed / "truth.nc", engine="h5netcdf")


def rms(values: np.ndarray) -> float:
    return float(np.sqrt(np.nanmean(values**2)))


def test_the_surface_comes_back(filmed: Path, measured: ww.Measurement) -> None:
    truth, surface = truth_of(filmed), measured.surface
    assert surface is not None
    origin, row = truth["boundary_column"].values[0], truth["boundary_row"].values[0]
    columns = np.rint(surface["x"].values / PIXEL + origin).astype(int)
    rise = row - truth["edge_row"].values[:, columns]
    error = surface["u_y"].values / PIXEL - rise
    sigma = surface["u_y_sigma"].values / PIXEL
    known = np.isfinite(error)
    certain = known & (sigma < 0.12)
    assert certain.mean() > 0.8
    assert rms(error[certain]) < 0.07
    assert 0.8 < rms(error[certain] / sigma[certain]) < 1.2
    assert rms(error[known] / sigma[known]) < 1.3, "bridged gaps tell how uncertain they are"
    on_the_sample = surface["x"].values >= surface["x_boundary"].values[:, None]
    assert not (known & ~on_the_sample).any()


def test_the_struck_end_the_wires_and_the_moments_come_back(filmed: Path, measured: ww.Measurement) -> None:
    truth, surface = truth_of(filmed), measured.surface
    assert surface is not None
    origin = truth["boundary_column"].values[0]
    end = surface["x_boundary"].values / PIXEL - (truth["boundary_column"].values - origin)
    assert np.isfinite(end).all()
    mixed = np.arange(end.size) == 12  # the plate arrives in the middle of this exposure
    assert rms(end[~mixed]) < 0.05
    wires = surface["x_p"].values / PIXEL - (truth["wire_column"].values - origin)
    assert np.isfinite(wires).all()
    assert rms(wires) < 0.05
    np.testing.assert_allclose(surface["X"].values, [5e-3, 10e-3], atol=0.05 * PIXEL)
    assert measured.folder is not None
    tracks = np.genfromtxt(measured.folder / "tracks.csv", delimiter=",", names=True)
    striker = tracks["x_striker_m"] / PIXEL - (truth["striker_column"].values - origin)
    assert rms(striker[~mixed]) < 0.06
    for error, sigma in ((end, "x_boundary_sigma_m"), (striker, "x_striker_sigma_m")):
        assert 0.7 < rms((error * PIXEL / tracks[sigma])[~mixed]) < 1.5
        assert abs(error[mixed].item()) * PIXEL < tracks[sigma][mixed].item() < 0.6 * PIXEL
    np.testing.assert_allclose(tracks["x_wire_2_m"], surface["x_p"].values[:, 1], atol=1e-3 * PIXEL)
    summary = measured.summary
    assert summary["contact_on_recording_clock_s"] == pytest.approx(12 / 50e3, abs=1e-6)
    assert summary["striker_velocity_m_per_s"] == pytest.approx(10.0, rel=2e-3)
    assert summary["striker_stop_distance_m"] == pytest.approx(1.5e-3, abs=0.05 * PIXEL)
    assert summary["striker_separation_time_s"] == pytest.approx(1.5e-3 / 10.0, abs=5e-6)
    assert summary["pixel_locking_px"] < 0.005


def test_kernels_compiled_beforehand_are_those_that_measure(
    filmed: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(learning, "compile_kernels", lambda: None)
    experiment = load_experiment(filmed / "impact.toml")
    with open_experiment(experiment) as source:
        appearance, wires = learn(experiment, source)
        FrameMeasurer(appearance, wires=wires).measure(source.frame(20))
    here, beside = kernel_calls()
    # where a kernel comes from the cache, those that it calls are not looked up
    used = [(kernel, arguments) for kernel, arguments in here + beside if kernel.signatures]
    assert {_rough, _fine} <= {kernel for kernel, _ in used}
    for kernel, arguments in used:
        assert tuple(map(numba.typeof, arguments)) in kernel.signatures, kernel


def test_a_single_frame_gives_what_the_batch_gives_bit_for_bit(filmed: Path) -> None:
    experiment = load_experiment(filmed / "impact.toml")
    with open_experiment(experiment) as source, ThreadPoolExecutor(2) as pool:
        appearance, wires = learn(experiment, source)
        measurer = FrameMeasurer(appearance, wires=wires)
        batch = measure_block(source, 0, 24, measurer, pool)
        for index in (23, 5, 14):
            alone = FrameBlock.of([index], [measurer.measure(source.frame(index))], source.shape[1])
            for name in ("rows", "sigma", "valid", "end", "wires", "contrast", "noise"):
                np.testing.assert_array_equal(getattr(alone, name)[0], getattr(batch, name)[index])


def test_whichever_way_the_camera_was_held(filmed: Path, measured: ww.Measurement, tmp_path: Path) -> None:
    """Turned upside down and mirrored: struck from the right, sample above."""
    with open_experiment(load_experiment(filmed / "impact.toml")) as source:
        turned = np.stack([source.frame(i)[::-1, ::-1] for i in range(source.n_frames)])
        write_recording(ArraySource(turned, bit_depth=12, frame_rate=50e3), tmp_path / "turned.tif")
    text = EXPERIMENT.format(file="turned.tif", x_axis="left", y_axis="down")
    (tmp_path / "turned.toml").write_text(text, "utf-8")
    again = measure(tmp_path / "turned.toml")
    assert again.surface is not None
    assert measured.surface is not None
    np.testing.assert_array_equal(again.surface["y"].values, measured.surface["y"].values)


def test_a_tilted_sample_is_measured_along_its_own_axes(tmp_path: Path) -> None:
    camera = Camera.framing(PULSE.surface(), scale=1 / PIXEL, tilt=np.radians(-2.0)).at_contrast_to_noise(
        20.0
    )
    recording = film(
        PULSE.surface(), camera, striker=Striker(velocity=10.0, stop_distance=1.5e-3), frames_before=12
    )
    write_recording(recording, tmp_path / "impact.tif")
    text = EXPERIMENT.format(file="impact.tif", x_axis="right", y_axis="up")
    (tmp_path / "impact.toml").write_text(text.replace("wires = { count = 2 }", ""), "utf-8")
    found = measure(tmp_path / "impact.toml")
    assert found.surface is not None
    assert found.summary["tilt_rad"] == pytest.approx(np.radians(-2.0), abs=1e-4)
    assert found.surface.sizes["point"] == 0
    surface = found.surface.where(found.surface["time"] >= 0.0, drop=True)
    true = PULSE.surface()
    x_boundary = np.interp(surface["time"], true["time"], true["x_boundary"])
    assert rms((surface["x_boundary"].values - x_boundary)[1:]) < 0.05 * PIXEL
    for row in range(2, surface.sizes["time"], 5):
        here, now = surface.isel(time=row), true.interp(time=surface["time"][row])
        error = here["u_y"].values - np.interp(here["x"], now["x"], now["u_y"])
        assert rms(error) < 0.1 * PIXEL


def test_a_striker_and_a_support_as_bright_as_the_sample(tmp_path: Path) -> None:
    camera = Camera.framing(PULSE.surface(), scale=1 / PIXEL, levels=Levels(striker=Levels.sample))
    recording = film(
        PULSE.surface(),
        camera.at_contrast_to_noise(20.0),
        striker=Striker(velocity=10.0, stop_distance=1.5e-3),
        frames_before=12,
    )
    write_recording(recording, tmp_path / "impact.tif")
    text = EXPERIMENT.format(file="impact.tif", x_axis="right", y_axis="up")
    (tmp_path / "impact.toml").write_text(text.replace("wires = { count = 2 }", ""), "utf-8")
    found = measure(tmp_path / "impact.toml")
    assert found.surface is not None
    column = recording.truth()["boundary_column"].values
    end = found.surface["x_boundary"].values / PIXEL - (column - column[0])
    assert np.isfinite(end).all()
    assert rms(end) < 0.06
    assert found.summary["contact_on_recording_clock_s"] == pytest.approx(12 / 50e3, abs=2e-6)
    assert found.summary["striker_separation_time_s"] == pytest.approx(1.5e-3 / 10.0, abs=2e-6)
    assert any("as bright as the sample" in warning for warning in found.warnings)


def test_an_interrupted_measurement_goes_on_and_ends_the_same(
    filmed: Path, measured: ww.Measurement, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(frame_blocks, "MOST_FRAMES", 10)
    steps: list[MeasuringProgress] = []

    def interrupt(state: MeasuringProgress) -> None:
        steps.append(state)
        os.kill(os.getpid(), signal.SIGINT)

    stopped = measure(filmed / "impact.toml", out=tmp_path / "m", progress=interrupt)
    assert stopped.outcome is Outcome.INTERRUPTED
    assert (stopped.surface, len(steps), steps[0].frames) == (None, 1, 10)
    with pytest.raises(InputError, match="holds a measurement already"):
        measure(filmed / "impact.toml", out=tmp_path / "m")
    other = load_experiment(filmed / "impact.toml", ["edge.resolution=12"])
    with pytest.raises(InputError, match="begun with another experiment"):
        measure(other, out=tmp_path / "m", resume=True)
    resumed = measure(filmed / "impact.toml", out=tmp_path / "m", resume=True, progress=steps.append)
    assert [state.frames for state in steps[1:]] == [20, 30, 38]
    assert resumed.surface is not None
    assert measured.surface is not None
    assert resumed.surface.drop_attrs().equals(measured.surface.drop_attrs())
    assert sorted(path.name for path in (tmp_path / "m").iterdir()) == [
        "boundary.csv",
        "experiment.toml",
        "summary.json",
        "surface.nc",
        "tracks.csv",
    ]


def test_damaged_frames_are_left_out_and_named(filmed: Path, tmp_path: Path) -> None:
    whole = (filmed / "impact.tif").read_bytes()
    (tmp_path / "impact.tif").write_bytes(whole[: int(0.9 * len(whole))])
    shutil.copy(filmed / "impact.toml", tmp_path)
    found = measure(tmp_path / "impact.toml")
    assert found.surface is not None
    assert 30 <= found.summary["frames_measured"] < 38
    assert any("cannot be read" in warning or "truncated" in warning for warning in found.warnings)


def test_the_command_writes_a_report_with_the_edge_on_frames(filmed: Path, tmp_path: Path) -> None:
    out = tmp_path / "measured"
    result = CliRunner().invoke(application(), ["measure", str(filmed / "impact.toml"), "--out", str(out)])
    assert result.exit_code == 0, result.output
    assert "wavefront speed" in result.output
    report = (out / "report.html").read_text(encoding="utf-8")
    assert 'id="detections"' in report
    assert "Fig. 2B" in report
    assert {"detections.png", "fig_2b_displacement.png", "fig_4a_wrinkles.png"} <= {
        path.name for path in (out / "figures").iterdir()
    }
    again = load_experiment(out / "experiment.toml")
    assert isinstance(again, Experiment)
    assert again.sample.length == pytest.approx(16e-3)


def not_so_far(state: MeasuringProgress) -> None:
    raise AssertionError("frames were measured first")


def test_what_cannot_be_measured_is_refused(filmed: Path, tmp_path: Path) -> None:
    at_rest = load_experiment(filmed / "impact.toml", ["video.frames=[0, 11]", "video.undeformed_frames=4"])
    with pytest.raises(InputError, match="no contact is seen"):
        measure(at_rest)
    with pytest.raises(
        InputError, match=r"calibration\.x_axis: in \d+% of the frames the struck end is seen at"
    ):
        measure(filmed / "impact.toml", overrides=["calibration.x_axis=left"])
    few = ["video.frames=[10, 13]", "video.undeformed_frames=1"]
    with pytest.raises(InputError, match=r"video\.frames: too few frames that can be used: 3"):
        measure(filmed / "impact.toml", overrides=few, progress=not_so_far)
    for mistake, message in (
        ("contact.time=90 ms", "90 ms is not within"),
        ("calibration.pixel_size=5 mm", "cut-off"),
        (
            "calibration.pixel_size=80 um",
            r"calibration: in the undeformed images the sample is 25\.59 mm long",
        ),
        ("video.undeformed_frames=20", r"in frame 13 the struck end has moved by \+4\.0 px"),
        ("wires={positions=[[200, 30]]}", r"no wire is seen within 10 px of \[200, 30\]"),
        ("wires={positions=[[140, 30], [142, 30]]}", r"\[140, 30\] and \[142, 30\] are the same wire"),
    ):
        with pytest.raises(InputError, match=message):
            measure(filmed / "impact.toml", overrides=[mistake], progress=not_so_far)
    slow = at_rest.experiment.model_copy(update={"kind": "quasi-static"})
    with pytest.raises(InputError, match=r"experiment\.kind"):
        measure(at_rest.model_copy(update={"experiment": slow}))
    wireless = load_experiment(filmed / "impact.toml", ["wires.count=9"])
    with pytest.raises(InputError, match="2 wires are seen"):
        measure(wireless)
    (tmp_path / "case.toml").write_text("")
    with pytest.raises(InputError, match="holds a run"):
        measure(at_rest, out=tmp_path)


def test_errors_about_turned_frames_name_rows_and_columns_of_the_recording(
    filmed: Path, tmp_path: Path
) -> None:
    with open_experiment(load_experiment(filmed / "impact.toml")) as source:
        turned = np.stack([source.frame(i).T for i in range(14)])
        write_recording(ArraySource(turned, bit_depth=12, frame_rate=50e3), tmp_path / "turned.tif")
    text = EXPERIMENT.format(file="turned.tif", x_axis="down", y_axis="left")
    (tmp_path / "turned.toml").write_text(text, "utf-8")
    with pytest.raises(InputError, match=r"region\.columns: .*\n.*\n.*give more columns on the side"):
        measure(tmp_path / "turned.toml", overrides=["region.columns=[0, 78]"])


def test_a_striker_that_touches_from_the_first_frame_on_is_told_of(filmed: Path, tmp_path: Path) -> None:
    found = measure(filmed / "impact.toml", overrides=["video.frames=[14, 38]", "video.undeformed_frames=1"])
    assert any("touches in the first frame" in warning for warning in found.warnings)
    assert found.summary["contact_on_recording_clock_s"] == pytest.approx(14.5 / 50e3)


class Prolonged(FrameSource):
    """A recording that goes on with its last frame."""

    def __init__(self, source: FrameSource, n_frames: int) -> None:
        super().__init__()
        self._source, self.n_frames, self.shape = source, n_frames, source.shape
        self.bit_depth, self.white_level, self.frame_rate = source.bit_depth, source.white_level, 50e3
        self.description = "prolonged"

    def _read(self, index: int) -> Image:
        return self._source.frame(min(index, self._source.n_frames - 1))


def test_memory_does_not_grow_with_the_recording(
    filmed: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(frame_blocks, "MOST_FRAMES", 16)
    monkeypatch.setattr(measuring, "ANALYSED_VALUES", 20_000)
    shutil.copy(filmed / "impact.toml", tmp_path)
    peaks, lengths = [], (100, 300)
    for n_frames in lengths:
        with open_experiment(load_experiment(filmed / "impact.toml")) as source:
            write_recording(Prolonged(source, n_frames), tmp_path / "impact.tif")
            added = (lengths[1] - lengths[0]) * source.shape[0] * source.shape[1] * source.dtype.itemsize
        tracemalloc.start()
        found = measure(tmp_path / "impact.toml", out=tmp_path / f"{n_frames}", threads=1)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        assert found.summary["frames_measured"] == n_frames
        assert any("are analysed" in warning for warning in found.warnings)
        assert ww.read_surface(tmp_path / f"{n_frames}").sizes["time"] == n_frames
    assert peaks[1] - peaks[0] < 0.1 * added


def test_blocks_are_stored_as_they_are(filmed: Path, tmp_path: Path) -> None:
    experiment = load_experiment(filmed / "impact.toml")
    with open_experiment(experiment) as source, ThreadPoolExecutor(1) as pool:
        appearance, wires = learn(experiment, source)
        block = measure_block(source, 3, 6, FrameMeasurer(appearance, wires=wires), pool)
    store = frame_blocks.BlockStore(tmp_path / "blocks", "this recording")
    assert 7 not in store
    store.put(7, block)
    assert 7 in store
    for field in fields(FrameBlock):
        np.testing.assert_array_equal(getattr(store.get(7), field.name), getattr(block, field.name))


def test_a_blurred_end_is_no_striker(tmp_path: Path) -> None:
    """At 3 px of blur the end itself passes through the striker's grey over a few columns."""
    camera = Camera.framing(PULSE.surface(), scale=1 / PIXEL, blur=3.0).at_contrast_to_noise(20.0)
    striker = Striker(velocity=10.0, stop_distance=1.5e-3)
    recording = film(PULSE.surface(), camera, striker=striker, frames_before=18)
    write_recording(recording, tmp_path / "blurred.tif")
    text = EXPERIMENT.format(file="blurred.tif", x_axis="right", y_axis="up").replace(
        "wires = { count = 2 }\n", ""
    )
    (tmp_path / "blurred.toml").write_text(text, "utf-8")
    summary = measure(tmp_path / "blurred.toml", threads=1).summary
    assert summary["contact_on_recording_clock_s"] == pytest.approx(18 / 50e3, abs=10e-6)  # half a frame
