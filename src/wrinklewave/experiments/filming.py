"""Filming a simulated run with the synthetic camera, ready to be measured like an experiment."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from wrinklewave import surface as surfaces
from wrinklewave.config.drives import CompressionDrive, EndMotionDrive, StrikerDrive
from wrinklewave.config.reading import load_case
from wrinklewave.config.writing import toml_text
from wrinklewave.errors import InputError
from wrinklewave.imaging.camera import Camera, Film, Striker, Wires, film
from wrinklewave.imaging.writing import write_recording

if TYPE_CHECKING:
    import xarray as xr

    from wrinklewave.config.case import Case

FRAMES_BEFORE = 20
FEWEST_FRAMES = 5
IMAGES = 60
PIXELS_PER_METRE = 20e3
WIRE_PLACES = (0.25, 0.5, 0.75)


@dataclass(frozen=True)
class FilmedRun:
    """Files that a filmed run leaves.

    Attributes:
        video: the recording.
        truth: NetCDF of what a perfect measurement would find.
        experiment: experiment file, ready for ``measure``.
        film: the recording as it was rendered.
    """

    video: Path
    truth: Path
    experiment: Path
    film: Film


def film_run(
    run: str | Path,
    video: str | Path,
    *,
    scale: float = PIXELS_PER_METRE,
    wires: Sequence[float] | None = None,
    contrast_to_noise: float | None = None,
    frames: int | None = None,
    threads: int = 1,
    overwrite: bool = False,
    progress: Callable[[int], None] | None = None,
    **camera: Any,
) -> FilmedRun:
    """Film a run: a recording, its truth, and an experiment file.

    An impact is filmed from 20 frames before contact until the run ends. A quasi-static compression is filmed
    in ``frames`` (60 by default) pictures of equal spacing in time; a surface motion whose ``procedure`` is
    "quasi-static" is a series of images already, and filmed image by image.

    Args:
        run: folder of a run, or a surface motion (NetCDF).
        video: the recording to write, .tif, .avi, .mp4 or .mov; truth and experiment file go beside it.
        scale: pixels per metre.
        wires: undeformed positions of probe wires [m]; at a quarter, half and three quarters if None.
        contrast_to_noise: even noise of this ratio instead of shot and read noise.
        frames: number of frames, for a compression.
        threads: that render.
        overwrite: replace an earlier recording and what lies beside it.
        progress: called with the number of frames written.
        camera: further attributes of ``Camera``.

    Raises:
        InputError: if the run cannot be read, the camera cannot do what is asked, or there is a recording already.
    """
    if not overwrite:
        _demand_free(Path(video))
    surface, case = surfaces.read(run), _case_of(Path(run))
    viewer = Camera.framing(surface, scale=scale, **camera)
    if contrast_to_noise is not None:
        viewer = viewer.at_contrast_to_noise(contrast_to_noise)
    places = _wire_places(surface) if wires is None else tuple(wires)
    slow = _is_slow(surface, case)
    if frames is not None and not slow:
        raise InputError(
            f"{frames} frames of an impact",
            key="--frames",
            expected="a quasi-static run: an impact is filmed until it ends",
            cure="leave it out, or choose --frame-rate",
        )
    recording = film(
        surface,
        viewer,
        striker=None if case is None or slow else _striker(case),
        wires=Wires(X=places) if places and not slow else None,
        times=_image_times(surface, frames) if slow else None,
        frames_before=FRAMES_BEFORE,
    )
    if not slow:
        _demand_frames(recording, surface)
    return _write(recording, Path(video), surface, case, threads, progress)


def _beside(video: Path) -> tuple[Path, Path]:
    """Truth and experiment file of a recording."""
    return video.with_suffix(".truth.nc"), video.with_suffix(".experiment.toml")


def _demand_free(video: Path) -> None:
    """See that no recording is lost, nor an experiment file that somebody has completed."""
    for file in (video, *_beside(video)):
        if file.exists():
            cure = "take another name with --out, or replace what was filmed before with --overwrite"
            raise InputError("is there already", file=file, cure=cure)


def _demand_frames(recording: Film, surface: xr.Dataset) -> None:
    """See that the camera is fast enough for an impact."""
    seen = recording.n_frames - FRAMES_BEFORE
    if seen < FEWEST_FRAMES:
        duration = float(surface["time"].values[-1]) * 1e3
        raise InputError(
            f"at {recording.camera.frame_rate:g} frames/s {seen} of them fall into the {duration:.3g} ms of the impact",
            key="--frame-rate",
            expected=f"at least {FEWEST_FRAMES}",
            cure="raise it, as to 50 kHz",
        )


def _wire_places(surface: xr.Dataset) -> tuple[float, ...]:
    """A quarter, half and three quarters of the length, where material points are known there."""
    X = surface["X"].values
    near = 1e-3 * float(surface.attrs["length"])  # the outermost wires of a measurement are its ends
    wanted = (share * float(surface.attrs["length"]) for share in WIRE_PLACES)
    return tuple(
        min(max(place, float(X[0])), float(X[-1]))
        for place in wanted
        if X.size and X[0] - near <= place <= X[-1] + near
    )


def _is_slow(surface: xr.Dataset, case: Case | None) -> bool:
    """Whether it is a quasi-static test."""
    slowly_driven = case is not None and isinstance(case.drive, CompressionDrive)
    return slowly_driven or surface.attrs.get("procedure") == "quasi-static"


def _image_times(surface: xr.Dataset, frames: int | None) -> NDArray[np.float64]:
    """When the images of a quasi-static test are taken [s]."""
    times = surface["time"].values
    if frames is None and surface.attrs.get("procedure") == "quasi-static":
        return np.asarray(times, dtype=float)
    return np.linspace(times[0], times[-1], frames or IMAGES)


def _write(
    recording: Film,
    video: Path,
    surface: xr.Dataset,
    case: Case | None,
    threads: int,
    progress: Callable[[int], None] | None,
) -> FilmedRun:
    video = write_recording(recording, video, threads=threads, progress=progress)
    truth, experiment = _beside(video)
    known = recording.truth()
    known.to_netcdf(truth, engine="h5netcdf")
    tables = _experiment(recording, video, known, surface, case)
    experiment.write_text(
        f"# Written with {video.name}, for `wrinklewave measure`.\n\n{toml_text(tables)}", "utf-8"
    )
    return FilmedRun(video, truth, experiment, recording)


def _case_of(run: Path) -> Case | None:
    file = run / "case.toml" if run.is_dir() else run.with_name("case.toml")
    return load_case(file) if file.exists() else None


def _striker(case: Case) -> Striker | None:
    """The plate of the run; behind a prescribed end motion it goes as far as the stoppers let it."""
    drive = case.drive
    if isinstance(drive, StrikerDrive):
        return Striker(velocity=drive.velocity, stop_distance=drive.stop_distance, rise_time=drive.rise_time)
    if isinstance(drive, EndMotionDrive):
        return Striker(velocity=drive.velocity, stop_distance=drive.stop_distance)
    return None


def _experiment(
    recording: Film, video: Path, truth: xr.Dataset, surface: xr.Dataset, case: Case | None
) -> dict[str, Any]:
    """Tables of the experiment file: what an experimenter would know, no more."""
    slow = _is_slow(surface, case)
    tables: dict[str, Any] = {
        "experiment": {
            "kind": "quasi-static" if slow else "impact",
            "name": f"{surface.attrs.get('name', 'run')} (filmed)",
        },
        "video": {"file": video.name, "undeformed_frames": 1 if slow else FRAMES_BEFORE},
        "calibration": {
            "kind": "scale",
            "pixel_size": f"{1e6 / recording.camera.scale:.12g} um",
            "x_axis": "right",
            "y_axis": "up",
        },
        "sample": _sample(surface, case),
    }
    if not slow:
        tables["video"]["frame_rate"] = f"{recording.camera.frame_rate:.12g} Hz"
        contact = f"{FRAMES_BEFORE / recording.camera.frame_rate * 1e6:.12g} us"
        tables["contact"] = {"time": "detect" if recording.scene.striker else contact}
        if recording.scene.wires:
            places = zip(truth["wire_column"].values[0], truth["wire_row"].values[0], strict=True)
            tables["wires"] = {"positions": [[round(float(c)), round(float(r))] for c, r in places]}
    if case is not None:
        analysis = case.analysis.model_dump(mode="json", exclude_none=True)
        tables["analysis"] = {key: value for key, value in analysis.items() if key != "loss_frequency"}
    return tables


def _sample(surface: xr.Dataset, case: Case | None) -> dict[str, Any]:
    sample: dict[str, Any] = {"length": f"{float(surface.attrs['length']) * 1e3:.12g} mm"}
    if case is not None:
        sample["height"] = f"{case.block.height * 1e3:.12g} mm"
        if case.film is not None and case.film.critical_strain is not None:
            sample["critical_strain"] = case.film.critical_strain
        if case.film is not None and case.film.critical_wavelength is not None:
            sample["critical_wavelength"] = f"{case.film.critical_wavelength * 1e3:.12g} mm"
    return sample
