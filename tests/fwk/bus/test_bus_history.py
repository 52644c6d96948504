"""What a writer keeps for those who lost something."""

from fwk.bus.history import BYTES_MAX, MESSAGES_MAX, History


def test_old_messages_go_the_newest_stays() -> None:
    history = History()
    for sequence in range(1, MESSAGES_MAX + 11):
        history.add(sequence, b"x")
    kept = [sequence for sequence, _ in history.between(0, 10_000)]
    assert kept == list(range(11, MESSAGES_MAX + 11))


def test_memory_is_bounded_but_one_message_is_always_kept() -> None:
    history = History()
    history.add(1, bytes(100))
    history.add(2, bytes(BYTES_MAX + 1))
    assert [sequence for sequence, _ in history.between(0, 10)] == [2]
