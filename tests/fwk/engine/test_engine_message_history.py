"""Messages that a writer keeps for readers that lost some."""

import pytest

from fwk.engine.message_history import BYTES_MAX, MESSAGES_MAX, TICKS, MessageHistory, gaps


def numbers(history: MessageHistory) -> list[int]:
    return [sequence for sequence, _ in history.between(0, 1_000_000)]


def test_old_messages_are_dropped_and_the_newest_kept() -> None:
    history = MessageHistory()
    for sequence in range(1, MESSAGES_MAX + 11):
        history.add(sequence, sequence, b"x")
    assert numbers(history) == list(range(11, MESSAGES_MAX + 11))


def test_history_keeps_messages_that_readers_may_still_lack() -> None:
    history = MessageHistory()
    for sequence in range(10_000):
        history.add(1 + sequence // 500, sequence, b"x")  # 20 ticks
    assert numbers(history) == list(range(9_500 - TICKS * 500, 10_000))


def test_large_messages_stay_until_the_tick_after_the_next() -> None:
    history = MessageHistory()
    for sequence in range(6):
        history.add(1 + sequence // 2, sequence, bytes(BYTES_MAX // 2 + 1))
    assert numbers(history) == [2, 3, 4, 5]


def test_only_the_requested_messages_are_given() -> None:
    history = MessageHistory()
    for sequence in range(1, 6):
        history.add(1, sequence, b"%d" % sequence)
    assert history.between(2, 3) == [(2, b"2"), (3, b"3")]
    assert history.between(7, 9) == []


@pytest.mark.parametrize(
    ("there", "missing"),
    [
        ([], [(3, 7)]),
        ([3, 4, 5, 6, 7], []),
        ([4, 6], [(3, 3), (5, 5), (7, 7)]),
        ([5], [(3, 4), (6, 7)]),
    ],
)
def test_gaps_are_the_ranges_between(there: list[int], missing: list[tuple[int, int]]) -> None:
    assert list(gaps(there, 3, 7)) == missing
