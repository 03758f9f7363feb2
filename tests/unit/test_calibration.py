"""From pixels to metres and back, and where the scale comes from."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.errors import InputError
from wrinklewave.imaging.calibration import PixelMap, calibrate

places = st.floats(-2000.0, 2000.0)


@given(places, places, st.floats(1e-6, 1e-3), places, places, st.floats(-0.3, 0.3), st.floats(0.0, 0.1))
def test_pixels_read_back(
    column: float,
    row: float,
    size: float,
    origin_column: float,
    origin_row: float,
    tilt: float,
    height: float,
) -> None:
    pixels = PixelMap(size, (origin_column, origin_row), tilt, height)
    back = pixels.to_pixels(*pixels.to_metres(column, row))
    assert [float(place) for place in back] == pytest.approx([column, row], abs=1e-8)


@given(st.floats(-0.3, 0.3), st.floats(0.0, 500.0))
def test_the_undeformed_surface_is_the_x_axis_wherever_it_points(tilt: float, along: float) -> None:
    """Turned counter-clockwise: it rises in the image, where rows count downwards; y stands upright on it."""
    pixels = PixelMap(50e-6, (100.0, 300.0), tilt, 18e-3)
    cos, sin = np.cos(tilt), np.sin(tilt)
    x, y = pixels.to_metres(100.0 + along * cos, 300.0 - along * sin)
    assert (float(x), float(y)) == pytest.approx((50e-6 * along, 18e-3), abs=1e-12)
    x, y = pixels.to_metres(100.0 - 10.0 * sin, 300.0 - 10.0 * cos)
    assert (float(x), float(y)) == pytest.approx((0.0, 18e-3 + 0.5e-3), abs=1e-12)


def experiment(**calibration: Any) -> Any:
    return SimpleNamespace(
        calibration=SimpleNamespace(**calibration), sample=SimpleNamespace(length=50e-3, height=20e-3)
    )


def at_rest(slope: float, held_end: float = 1100.0) -> Any:
    return SimpleNamespace(line=(300.0, slope), held_end=held_end)


def test_scale_of_the_sample_is_taken_along_its_surface() -> None:
    """1000 columns of a surface that falls 1 in 10 are 1005 px of it, 50 mm long."""
    pixels = calibrate(experiment(kind="sample-length", ends=None), at_rest(0.1), 100.0)
    assert pixels.pixel_size == pytest.approx(50e-3 / np.hypot(1000.0, 100.0))
    assert pixels.origin == pytest.approx((100.0, 310.0))
    assert pixels.tilt == pytest.approx(-np.arctan(0.1))
    assert pixels.height == 10e-3
    x, y = pixels.to_metres(1100.0, 410.0)
    assert (float(x), float(y)) == pytest.approx((50e-3, 10e-3))


def test_scale_may_be_given_or_the_ends() -> None:
    assert calibrate(experiment(kind="scale", pixel_size=4e-5), at_rest(0.1), 100.0).pixel_size == 4e-5
    ends = experiment(kind="sample-length", ends=(900.0, 100.0))
    assert calibrate(ends, at_rest(0.0, np.nan), 100.0).pixel_size == pytest.approx(50e-3 / 800)


def test_ends_out_of_sight_give_no_scale() -> None:
    with pytest.raises(InputError, match="not both seen"):
        calibrate(experiment(kind="sample-length", ends=None), at_rest(0.0, np.nan), 100.0)
    with pytest.raises(InputError, match="struck end"):
        calibrate(experiment(kind="scale", pixel_size=4e-5), at_rest(0.0), np.nan)
