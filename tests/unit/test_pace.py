"""How many threads step: whichever number is faster at the time."""

from __future__ import annotations

from collections.abc import Iterable

from wrinklewave.dynamics.cpu import Pace

ALL, ONE = "all threads", "one thread"


def chosen(seconds: dict[str, Iterable[float]], groups: int) -> list[str]:
    """Choices of so many groups of steps, which take these ``seconds`` per step one after the other."""
    pace, choices = Pace([ALL, ONE]), []  # type: ignore[list-item]  # it hands out what it was given
    turns = {name: iter(of_choice) for name, of_choice in seconds.items()}
    for _ in range(groups):
        choices.append(str(pace.choose()))
        pace.note(next(turns[choices[-1]]))
    return choices


def always(seconds: float, *, after: Iterable[float] = ()) -> Iterable[float]:
    yield from after
    while True:
        yield seconds


def test_the_faster_choice_is_taken_and_the_other_tried_now_and_then() -> None:
    choices = chosen({ALL: always(40.0), ONE: always(70.0)}, 400)
    assert choices.count(ONE) == Pace.TRIES + 400 // Pace.RETRY
    assert chosen({ALL: always(90.0), ONE: always(70.0)}, 400).count(ALL) == Pace.TRIES + 400 // Pace.RETRY


def test_a_group_that_was_held_up_says_nothing() -> None:
    held_up = {ALL: always(40.0, after=[600.0, 40.0, 40.0, 40.0, 40.0, 600.0]), ONE: always(70.0)}
    choices = chosen(held_up, 400)
    assert choices.count(ONE) == Pace.TRIES + 400 // Pace.RETRY


def test_threads_that_lose_their_cores_are_left_and_found_again() -> None:
    lost = {ALL: always(40.0, after=[40.0] * 50 + [200.0] * 30), ONE: always(70.0)}
    choices = chosen(lost, 2000)
    first_slow = [n for n, choice in enumerate(choices) if choice == ALL][50]
    assert ALL not in choices[first_slow + 3 : first_slow + Pace.RETRY // 2]
    assert choices[-Pace.RETRY + 1 :].count(ALL) >= Pace.RETRY - 2
