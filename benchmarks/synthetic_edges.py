"""Images of known edges for the accuracy benchmarks: rendered once, then under as much noise as wanted."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from wrinklewave.imaging.camera.optics import add_layer, sampling, sub_columns

Array = NDArray[np.float64]
Rows = Callable[[Array], Array]

LOW, HIGH = 400.0, 1600.0
"""Grey values of background and sample."""


def edge_image(rows: Rows, shape: tuple[int, int], blur: float) -> Array:
    """Grey values of a step along ``rows(columns)`` [px], HIGH below it, shape [n_rows, n_columns].

    Args:
        rows: row of the edge at columns.
        shape: (n_rows, n_columns).
        blur: standard deviation of the optics' blur [px].
    """
    columns = np.arange(-20.0, shape[1] + 20.0, 0.25)
    at = sampling(shape[1], blur, max(4, sub_columns(columns, rows(columns), blur)))
    light = np.zeros(shape[::-1], np.float32)
    add_layer(light, rows(at.columns), np.ones(at.columns.size), at)
    return LOW + (HIGH - LOW) * light.T.astype(np.float64)


def with_noise(image: Array, contrast_to_noise: float, seed: int) -> NDArray[np.float32]:
    """The image under Gaussian noise, rounded to whole grey values."""
    noise = np.random.default_rng(seed).normal(0.0, (HIGH - LOW) / contrast_to_noise, image.shape)
    return np.round(image + noise).astype(np.float32)


def tilted(columns: Array) -> Array:
    """A slow tilt, which passes through every place between two rows of pixels."""
    return 45.2 + 0.011 * columns


def wrinkled(amplitude: float, wavelength: float, *, middle: float = 47.8, phase: float = 0.0) -> Rows:
    """Wrinkles on a level surface [px]."""
    return lambda columns: middle + amplitude * np.cos(2 * np.pi * columns / wavelength + phase)


def band_limited(resolution: float, seed: int, *, rms: float = 0.5) -> Rows:
    """A random surface of equal power at all wave numbers up to that of ``resolution`` [px], none above."""
    generator = np.random.default_rng(seed)
    k = generator.uniform(2 * np.pi / 400, 2 * np.pi / resolution, 60)
    phase = generator.uniform(0, 2 * np.pi, 60)
    return lambda columns: 47.5 + rms * np.sqrt(2 / 60) * np.cos(k[:, None] * columns + phase[:, None]).sum(0)


def rms(values: Array) -> float:
    """Root mean square of the known values."""
    return float(np.sqrt(np.nanmean(np.square(values))))
