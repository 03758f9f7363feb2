"""Filming a surface motion: frames rendered one by one, and the truth that goes with them."""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike, NDArray

from wrinklewave.imaging.camera.camera import Camera
from wrinklewave.imaging.camera.curves import interpolate
from wrinklewave.imaging.camera.optics import Array, Sampling, add_layer, digitise, sampling, sub_columns
from wrinklewave.imaging.camera.scene import Moment, Scene, Striker, Wires
from wrinklewave.imaging.frames import FrameSource, Image

if TYPE_CHECKING:
    import xarray as xr

LARGEST_STEP = (
    0.7  # motion between sub-exposures, in blurs: they widen the blur by 2 % less than a smooth one
)


def film(
    surface: xr.Dataset,
    camera: Camera,
    *,
    striker: Striker | None = None,
    wires: Wires | None = None,
    times: ArrayLike | None = None,
    frames_before: int = 20,
) -> Film:
    """Film a surface motion; nothing is rendered before a frame is asked for.

    Args:
        surface: the surface motion, simulated, analytic or measured; contact at time 0.
        camera: see ``Camera``.
        striker: the plate, or None.
        wires: probe wires, or None.
        times: middle of each exposure [s]; by default at the camera's rate until the motion ends.
        frames_before: frames before the contact, where ``times`` is not given.

    Raises:
        InputError: if the surface cannot be seen or a wire lies outside it.
    """
    if times is None:
        last = math.floor(float(surface["time"].values[-1]) * camera.frame_rate * (1 + 1e-12))
        times = np.arange(-frames_before, last + 1) / camera.frame_rate
    return Film(Scene(surface, striker, wires), camera, np.asarray(times, dtype=float))


class Film(FrameSource):
    """A synthetic recording: a frame source like any other, whose frames are rendered when they are read."""

    def __init__(self, scene: Scene, camera: Camera, times: NDArray[np.float64]) -> None:
        super().__init__()
        self.scene, self.camera = scene, camera
        self.n_frames, self.shape = times.size, camera.shape
        self.bit_depth, self.black_level, self.white_level = (
            camera.bit_depth,
            camera.black_level,
            camera.white_level,
        )
        self.times, self.frame_rate, self.clock = times, camera.frame_rate, "camera"
        self.description = "synthetic camera"

    def brightness(self, index: int) -> NDArray[np.float32]:
        """Frame ``index`` as light, without noise, from 0 (black) to 1 (white); shape [height, width]."""
        assert self.times is not None
        camera, middle = self.camera, float(self.times[index])
        motion = self.scene.speed(middle, camera.exposure) * camera.scale
        n_parts = max(1, math.ceil(motion / (LARGEST_STEP * camera.blur)))
        light = np.zeros(camera.shape[::-1], dtype=np.float32)
        for part in range(n_parts):
            moment = self.scene.at(middle + camera.exposure * ((part + 0.5) / n_parts - 0.5))
            _expose(light, self.scene, moment, camera, 1.0 / n_parts)
        light += camera.levels.background
        return np.ascontiguousarray(light.T) * _lighting(camera)

    def truth(self) -> xr.Dataset:
        """What a perfect measurement of every frame would find, in pixels, at the middle of the exposure.

        Variables: ``edge_row(frame, column)``, the surface at each column's centre, NaN beside the sample;
        ``boundary_column``, ``boundary_row``, ``striker_column`` (frame); ``wire_column``, ``wire_row``
        (frame, wire), the place where each wire leaves the surface. Coordinate ``time`` (frame) [s].
        """
        import xarray as xr

        assert self.times is not None
        records = [_frame_truth(self.scene.at(float(time)), self.camera) for time in self.times]
        second = {"edge_row": ("column",), "wire_column": ("wire",), "wire_row": ("wire",)}
        return xr.Dataset(
            {
                name: (
                    ("frame", *second.get(name, ())),
                    np.stack([r[name] for r in records]),
                    {"units": "px"},
                )
                for name in records[0]
            },
            coords={"time": ("frame", self.times, {"units": "s"})},
            attrs={
                "camera": json.dumps(asdict(self.camera)),
                "pixel_size": 1.0 / self.camera.scale,
                "length": self.scene.length,
            },
        )

    def _read(self, index: int) -> Image:
        camera = self.camera
        generator = np.random.Generator(np.random.SFC64((camera.seed, index)))
        noise = generator.standard_normal(camera.shape, dtype=np.float32)
        levels = (camera.black_level, camera.white_level)
        grey = np.empty(camera.shape, dtype=self.dtype)
        digitise(self.brightness(index), noise, camera.read_noise**2, 1.0 / camera.full_well, levels, grey)
        return grey


def _expose(light: NDArray[np.float32], scene: Scene, moment: Moment, camera: Camera, share: float) -> None:
    """Add ``share`` of the light of one moment, less the background's; ``light`` is [width, height]."""
    columns, rows = camera.to_pixels(moment.x, moment.y)
    at = sampling(camera.shape[1], camera.blur, sub_columns(columns, rows, camera.blur))
    levels = camera.levels
    edge = interpolate(at.columns, columns, rows)
    body = share * (levels.sample - levels.background) * at.coverage(columns[0], columns[-1])
    if scene.wires is not None:
        wire = share * (levels.wire - levels.background) * _wire_coverage(scene.wires, moment, camera, at)
        add_layer(light, edge - scene.wires.length * camera.scale, wire, at)
        body -= wire
    add_layer(light, edge, body, at)
    if scene.striker is not None:
        face, top = _plate(moment.striker, scene.striker.height, columns[0], moment, camera)
        plates = 1.0 - at.coverage(face, columns[-1])
        tops = np.full(at.columns.size, top)
        add_layer(light, tops, share * (levels.striker - levels.background) * plates, at)


def _plate(
    striker: float, height: float, end_column: float, moment: Moment, camera: Camera
) -> tuple[float, float]:
    """Column of the striker's face and row of its top; in contact the face is where the struck end is."""
    gap = (moment.x[0] - striker) * camera.scale * math.cos(camera.tilt)
    _, top = camera.to_pixels(0.0, height)
    return end_column - gap, float(top)


def _wire_coverage(wires: Wires, moment: Moment, camera: Camera, at: Sampling) -> Array:
    half = 0.5 * wires.width * camera.scale
    covered = np.zeros(at.columns.size)
    for column in _wire_places(moment, camera)[0]:
        covered = np.maximum(covered, at.coverage(column - half, column + half))
    return covered


def _wire_places(moment: Moment, camera: Camera) -> tuple[Array, Array]:
    """Columns and rows where the wires leave the surface."""
    return camera.to_pixels(moment.wire_x, interpolate(moment.wire_x, moment.x, moment.y))


def _frame_truth(moment: Moment, camera: Camera) -> dict[str, NDArray[np.float64]]:
    columns, rows = camera.to_pixels(moment.x, moment.y)
    centres = np.arange(camera.shape[1], dtype=float)
    edge = interpolate(centres, columns, rows)
    edge[(centres < columns[0]) | (centres > columns[-1])] = np.nan
    face, _ = _plate(moment.striker, 0.0, columns[0], moment, camera)
    wire_columns, wire_rows = _wire_places(moment, camera)
    return {
        "edge_row": edge,
        "boundary_column": columns[0],
        "boundary_row": rows[0],
        "striker_column": np.asarray(face),
        "wire_column": wire_columns,
        "wire_row": wire_rows,
    }


@lru_cache(maxsize=4)
def _lighting(camera: Camera) -> NDArray[np.float32]:
    """Relative illumination of each pixel, 1 in the middle of the image."""
    height, width = camera.shape
    across = camera.gradient[0] * (np.arange(width) / (width - 1) - 0.5)
    down = camera.gradient[1] * (np.arange(height) / (height - 1) - 0.5)
    return (1.0 + across[None, :] + down[:, None]).astype(np.float32)
