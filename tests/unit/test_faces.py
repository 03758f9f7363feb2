"""Two faces fitted together: no bias, honest uncertainties, and what a gap narrower than the blur still tells."""

from __future__ import annotations

import numpy as np
import pytest

from wrinklewave.imaging.contact import touching_frames
from wrinklewave.imaging.edges.profile import blurred_step
from wrinklewave.imaging.faces import END, GAP, SLOPE, SPREAD, Faces, fit_faces, gap_of_square

BLUR, NOISE, END_AT, LEAN = (
    1.2,
    1.0 / 80.0,
    30.37,
    0.012,
)  # noise of sixteen rows at a contrast over noise of 20
ROWS = np.array([-24.0, -8.0, 8.0, 24.0])
PLATE = 0.55
WITH_GAP, ALL = np.array([1.0, 1.0, 1.0, 0.0]), np.ones(4)
WITHOUT_GAP = np.array([1.0, 1.0, 0.0, 0.0])


def strips(
    gap: float, random: np.random.Generator, *, spread: float = 0.0, plate: float = PLATE
) -> np.ndarray:
    end = END_AT + LEAN * ROWS[:, None]
    columns = np.arange(64.0)
    at_face = blurred_step(columns - end + gap + spread * ROWS[:, None], BLUR)
    return plate * (1.0 - at_face) + blurred_step(columns - end, BLUR) + random.normal(0.0, NOISE, (4, 64))


def fitted(profiles: np.ndarray, gap: float, *, free: np.ndarray = WITH_GAP) -> Faces:
    start = np.array([END_AT + 0.6, 0.0, gap + 1.0, 0.0])
    return fit_faces(profiles, 0, ROWS, start, free, BLUR, NOISE)


def gap_squared(fit: Faces) -> tuple[float, float]:
    return fit.square, 2.0 * float(fit.at[GAP]) * float(np.sqrt(fit.covariance[GAP, GAP]))


@pytest.mark.parametrize("gap", [0.8, 1.5, 6.0])
def test_both_faces_come_back_with_their_uncertainties(gap: float) -> None:
    random = np.random.default_rng(3)
    fits = [fitted(strips(gap, random), gap) for _ in range(60)]
    error = np.array([fit.at for fit in fits]) - [END_AT, LEAN, gap, 0.0]
    sigma = np.sqrt([np.diag(fit.covariance) for fit in fits])
    for parameter in (END, SLOPE, GAP):
        off = error[:, parameter] / sigma[:, parameter]
        assert abs(off.mean()) < 4.0 / np.sqrt(60)
        assert 0.5 < off.std() < 1.3  # of the blur, exactly known here, the fit believes 4 %
    assert np.std(error[:, END]) < 0.05


def test_faces_need_not_be_parallel() -> None:
    fit = fitted(strips(8.0, np.random.default_rng(4), spread=0.02), 8.0, free=ALL)
    error = fit.at - np.array([END_AT, LEAN, 8.0, 0.02])
    assert (np.abs(error) < 4.0 * np.sqrt(np.diag(fit.covariance))).all()
    assert fit.covariance[SPREAD, SPREAD] < 0.003**2


def test_of_a_gap_narrower_than_the_blur_the_square_is_known_and_a_single_step_is_wrong() -> None:
    random = np.random.default_rng(5)
    profiles = [strips(0.4, random) for _ in range(60)]
    squares = np.array([gap_squared(fitted(each, 0.4)) for each in profiles])
    assert abs(squares[:, 0].mean() - 0.16) < 0.02
    assert np.std(squares[:, 0]) < np.median(squares[:, 1]) < 0.12
    single = np.mean([fitted(each, 0.4, free=WITHOUT_GAP).at[END] for each in profiles]) - END_AT
    assert single == pytest.approx(0.4 * PLATE / (1.0 - PLATE), abs=0.06)


def test_where_there_is_no_gap_one_step_explains_as_much_as_two() -> None:
    random = np.random.default_rng(6)
    closed = [strips(0.0, random) for _ in range(60)]
    single = [fitted(each, 0.0, free=WITHOUT_GAP) for each in closed]
    assert np.std([fit.at[END] for fit in single]) < 0.04
    assert abs(np.mean([fit.at[END] for fit in single]) - END_AT) < 4.0 * 0.03 / np.sqrt(60)
    gain = [one.misfit - fitted(each, 0.0).misfit for one, each in zip(single, closed, strict=True)]
    assert np.percentile(gain, 95) < 4.0


def test_the_gap_of_a_well_known_square_is_its_root_and_of_none_is_not_negative() -> None:
    assert gap_of_square(4.0, 0.04) == pytest.approx((2.0, 0.01), rel=1e-3)
    mean, sigma = gap_of_square(-0.02, 0.04)
    assert 0.0 < sigma < mean < 0.2


def test_a_narrow_gap_is_believed_beside_a_wide_one_only() -> None:
    gain = np.array([np.nan, np.inf, 900.0, 5.0, 1.0, -2.0, 10.0, 0.0, 1.0, -1.0, 5.0, 300.0, 2e4])
    expected = [np.nan, 0, 0, 0, 1, 1, 1, 1, 1, 1, 0, 0, 0]
    np.testing.assert_array_equal(touching_frames(gain), expected)
    assert touching_frames(np.zeros(0)).size == 0
