"""Contact, stop and separation from tracks of the struck end and the striker."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from wrinklewave.experiments.impact_moments import EndTrack, find_moments, with_exposure_uncertainty

RATE = 50e3
CONTACT, STOP, REST, SPEED = 0.404e-3, 1.034e-3, 40.0, 2e5  # s, s, px, px/s
WAY = SPEED * (STOP - CONTACT)


def impact(noise: float = 0.03, *, recoil: float = 60e3) -> EndTrack:
    """A plate that pushes at constant speed from contact to stop; then the end runs on and comes back."""
    random = np.random.default_rng(1)
    time = np.arange(100) / RATE
    plate = REST + SPEED * np.clip(time - CONTACT, -np.inf, STOP - CONTACT)
    end = np.where(time < CONTACT, REST, plate) + recoil * np.maximum(time - STOP, 0.0)
    touching = np.where((time >= CONTACT) & (time <= STOP), 1.0, 0.0)
    seen = plate > 4.0
    gap = end - plate + np.where(touching == 1.0, 0.0, random.normal(0.0, noise, time.size))
    return EndTrack(
        time=time,
        column=end + random.normal(0.0, noise, time.size),
        sigma=np.full(time.size, noise),
        row=np.zeros(time.size),
        row_sigma=np.zeros(time.size),
        striker=np.where(seen, plate + random.normal(0.0, noise, time.size), np.nan),
        striker_sigma=np.where(seen, noise, np.nan),
        gap=np.where(seen, gap, np.nan),
        gap_sigma=np.where(seen, np.where(touching == 1.0, 0.0, noise), np.nan),
        touching=np.where(seen, touching, np.nan),
        rest=REST,
    )


def test_moments_between_frames_are_found_to_a_small_part_of_the_frame_interval() -> None:
    found = find_moments(impact())
    assert found.contact.time == pytest.approx(CONTACT, abs=0.02 / RATE)
    assert abs(found.contact.time - CONTACT) < 4 * found.contact.sigma
    assert found.stop_distance == pytest.approx(WAY, abs=0.05)
    # between frames the plate is taken to move evenly, which a sudden stop does not
    assert abs(found.stop.time - (CONTACT + 0.99 * WAY / SPEED)) < found.stop.sigma < 0.3 / RATE
    assert found.separation.time == pytest.approx(STOP, abs=0.1 / RATE)


def test_a_gap_that_opens_slowly_and_closes_again_is_followed_along_its_curve() -> None:
    """A parabola over 30 frames, up to 9 px wide."""
    track, width = impact(), 30 / RATE
    away = np.clip((track.time - STOP) / width, 0.0, 1.0)
    gap = 36.0 * away * (1.0 - away)
    touching = np.where(track.touching == 0.0, (track.time >= CONTACT) & (gap == 0.0), track.touching)
    touching = np.where(np.isfinite(track.touching) & (track.time < CONTACT), 0.0, touching)
    noise = np.random.default_rng(2).normal(0.0, 0.05, gap.size)
    apart = (touching == 0.0) & (track.time > CONTACT)
    seen = np.where(apart, gap + noise, np.where(track.time < CONTACT, track.gap, 0.0))
    found = find_moments(
        replace(track, touching=touching, gap=seen, gap_sigma=np.where(touching == 1.0, 0.0, 0.05))
    )
    for moment, true in ((found.separation, STOP), (found.recontact, STOP + width)):
        assert abs(moment.time - true) < 0.15 / RATE
        assert abs(moment.time - true) < 4.0 * moment.sigma < 0.5 / RATE


def test_frames_that_may_have_been_exposed_while_the_faces_met_say_that_they_are_uncertain() -> None:
    track = impact()
    sigma = with_exposure_uncertainty(track, find_moments(track)).sigma
    changed = np.flatnonzero(sigma > track.sigma).tolist()
    assert changed == [round(CONTACT * RATE), round(STOP * RATE)]
    assert sigma[changed[0]] == pytest.approx(0.125 * SPEED / RATE, rel=0.01)


def test_a_given_contact_is_kept() -> None:
    found = find_moments(impact(), contact=0.41e-3)
    assert (found.contact.time, found.contact.sigma) == (0.41e-3, 0.0)


def test_a_gap_that_flickers_during_contact_is_no_separation() -> None:
    track = impact()
    touching = track.touching.copy()
    touching[30] = touching[35] = 0.0
    found = find_moments(replace(track, touching=touching))
    assert found.separation.time == pytest.approx(STOP, abs=0.1 / RATE)


def test_without_a_striker_in_sight_contact_is_when_the_end_begins_to_move() -> None:
    track = impact()
    nowhere = np.full(track.time.size, np.nan)
    found = find_moments(replace(track, striker=nowhere, striker_sigma=nowhere, touching=nowhere))
    assert found.contact.time == pytest.approx(CONTACT, abs=1.0 / RATE)
    assert found.contact.sigma == pytest.approx(1.0 / RATE / np.sqrt(12.0))
    assert np.isnan([found.stop.time, found.separation.time, found.stop_distance]).all()


def test_a_striker_that_never_rests_has_no_stop() -> None:
    track = impact()
    moving = replace(track, striker=track.striker + 1e4 * np.maximum(track.time - STOP, 0.0))
    found = find_moments(moving)
    assert np.isnan(found.stop.time)
    assert np.isnan(found.stop_distance)


def test_nothing_happens_at_rest() -> None:
    track = impact()
    at_rest = replace(
        track, column=np.full(100, REST), striker=np.full(100, np.nan), touching=np.full(100, np.nan)
    )
    assert np.isnan(find_moments(at_rest).contact.time)


def test_stated_uncertainty_of_a_contact_is_its_scatter() -> None:
    track, found = impact(), []
    apart = np.isfinite(track.gap) & (track.time < CONTACT)
    exact = np.where(apart, SPEED * (CONTACT - track.time), track.gap)
    for seed in range(200):
        noise = np.where(apart, np.random.default_rng(seed).normal(0.0, 0.03, exact.size), 0.0)
        found.append(find_moments(replace(track, gap=exact + noise)).contact)
    times = np.array([moment.time for moment in found])
    assert times.mean() == pytest.approx(CONTACT, abs=0.01 / RATE)
    assert np.mean([moment.sigma for moment in found]) == pytest.approx(times.std(), rel=0.2)
    assert np.median([moment.rate for moment in found]) == pytest.approx(-SPEED, rel=0.02)


def test_a_gap_that_was_never_seen_closes_between_two_frames() -> None:
    """Anywhere between them, as likely here as there: the middle, and the interval over the root of 12."""
    track = impact()
    contact = find_moments(replace(track, gap=np.full(track.time.size, np.nan))).contact
    after = track.time[track.time >= CONTACT][0]
    assert contact.time == pytest.approx(after - 0.5 / RATE)
    assert contact.sigma == pytest.approx(1 / RATE / np.sqrt(12))
