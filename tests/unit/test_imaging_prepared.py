"""Recordings turned and cropped as an experiment file says."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from wrinklewave.errors import InputError
from wrinklewave.imaging.frames import ArraySource
from wrinklewave.imaging.prepared import PreparedSource

DIRECTIONS = {"right": (0, 1), "left": (0, -1), "up": (-1, 0), "down": (1, 0)}  # (rows, columns) of a step
AXES = [(x, y) for x in DIRECTIONS for y in DIRECTIONS if np.dot(DIRECTIONS[x], DIRECTIONS[y]) == 0]


def _as_recorded(upright: np.ndarray, x_axis: str, y_axis: str) -> tuple[np.ndarray, np.ndarray]:
    """The picture that a camera held another way takes, and where each upright pixel is (row, column)."""
    along, out = np.array(DIRECTIONS[x_axis]), np.array(DIRECTIONS[y_axis])
    height, width = upright.shape
    place = np.array([[-row * out + column * along for column in range(width)] for row in range(height)])
    place -= place.reshape(-1, 2).min(axis=0)
    recorded = np.zeros(place.reshape(-1, 2).max(axis=0) + 1, upright.dtype)
    recorded[place[..., 0], place[..., 1]] = upright
    return recorded, place


@given(axes=st.sampled_from(AXES), height=st.integers(1, 6), width=st.integers(1, 6))
def test_every_way_to_hold_the_camera(axes: tuple[str, str], height: int, width: int) -> None:
    upright = np.arange(height * width, dtype=np.uint16).reshape(height, width)
    recorded, place = _as_recorded(upright, *axes)
    prepared = PreparedSource(ArraySource(recorded[None]), x_axis=axes[0], y_axis=axes[1])
    assert prepared.shape == upright.shape
    np.testing.assert_array_equal(prepared.frame(0), upright)
    rows, columns = np.mgrid[:height, :width]
    np.testing.assert_array_equal(prepared.position(place[..., ::-1]), np.stack([columns, rows], axis=-1))


@given(axes=st.sampled_from(AXES), data=st.data())
def test_region_and_position_agree(axes: tuple[str, str], data: st.DataObject) -> None:
    """A pixel of the recording shows up where ``position`` says."""
    recorded = np.arange(7 * 9, dtype=np.uint16).reshape(7, 9)
    top = data.draw(st.integers(0, 5))
    left = data.draw(st.integers(0, 7))
    rows, columns = (top, data.draw(st.integers(top + 1, 7))), (left, data.draw(st.integers(left + 1, 9)))
    prepared = PreparedSource(
        ArraySource(recorded[None]), x_axis=axes[0], y_axis=axes[1], rows=rows, columns=columns
    )
    column, row = (
        data.draw(st.integers(columns[0], columns[1] - 1)),
        data.draw(st.integers(rows[0], rows[1] - 1)),
    )
    found = prepared.position((column, row)).astype(int)
    assert prepared.frame(0)[found[1], found[0]] == recorded[row, column]


def test_frames_times_and_depth() -> None:
    stack = np.arange(6 * 4, dtype=np.uint16).reshape(6, 2, 2)
    prepared = PreparedSource(ArraySource(stack, frame_rate=10.0), frames=(2, 5), bit_depth=10)
    assert (prepared.n_frames, prepared.bit_depth, prepared.white_level) == (3, 10, 1023)
    assert prepared.times is not None
    np.testing.assert_allclose(prepared.times, [0.2, 0.3, 0.4])
    np.testing.assert_array_equal(prepared.frame(0), stack[2])
    assert prepared.frame_rate == 10.0


@pytest.mark.parametrize(
    ("key", "options"),
    [
        ("region.columns", {"columns": (0, 3)}),
        ("region.rows", {"rows": (1, 9)}),
        ("video.frames", {"frames": (3, 9)}),
    ],
)
def test_what_leaves_the_recording(key: str, options: dict[str, tuple[int, int]]) -> None:
    with pytest.raises(InputError, match="leaves the recording") as caught:
        PreparedSource(ArraySource(np.zeros((6, 2, 2), np.uint8)), **options)  # type: ignore[arg-type]
    assert caught.value.key == key
