"""Intervals at which messages without an answer are repeated: ticks, dones, fetches."""

_MARGIN_US, _LONGEST_MARGIN_US = 100, 5_000
_AT_FIRST_US = 20_000


class Backoff:
    """The wall time at which a message is repeated next.

    The first repetition is due `first_us` after the message, the second `second_us` after the first, and every wait
    after that is twice as long as the one before, up to `longest_us`.
    """

    def __init__(self, now_us: int, first_us: int, longest_us: int, second_us: int = 0) -> None:
        self.due_us = now_us + first_us
        """Wall time at which the next repetition is due."""
        self._next_us = second_us or 2 * first_us
        self._longest_us = longest_us

    def repeated(self, now_us: int) -> None:
        """Notes a repetition, after which the next wait begins."""
        wait_us = min(self._next_us, self._longest_us)
        self.due_us = now_us + wait_us
        self._next_us = 2 * wait_us


class RetransmissionTimeout:
    """Learns the usual duration of a stage, as TCP learns round trips (RFC 6298): smoothed time and deviation.

    After a repetition a host that answers both copies of the tick shows that the first had not been lost: the margin
    doubles, as each copy wakes hosts. If no host does, the tick was lost, and the margin is small again, so that
    further losses are noticed soon.
    """

    def __init__(self) -> None:
        self._usual_us = _AT_FIRST_US
        self._deviation_us = _AT_FIRST_US // 4
        self._margin_us = _MARGIN_US
        self._seems_lost = False  # a tick was repeated, and no host has answered twice yet

    @property
    def wait_us(self) -> int:
        """Wall time after which an unanswered tick is probably lost, in microseconds."""
        return self._usual_us + 3 * self._deviation_us + self._margin_us

    def repeated(self) -> None:
        """Notes that a tick is repeated."""
        self._seems_lost = True

    def answered_twice(self) -> None:
        """Notes that a host answered both copies of the tick that was repeated."""
        if self._seems_lost:
            self._seems_lost, self._margin_us = False, min(2 * self._margin_us, _LONGEST_MARGIN_US)

    def took(self, duration_us: int, repeated: bool = False) -> None:
        """Learns from a stage that was answered this long after its tick was sent the last time.

        Args:
            duration_us: wall time.
            repeated: the tick was sent more than once; a second answer may still come.
        """
        if self._seems_lost and not repeated:
            self._seems_lost, self._margin_us = False, _MARGIN_US
        error_us = duration_us - self._usual_us
        self._usual_us += error_us // 8
        self._deviation_us += (abs(error_us) - self._deviation_us) // 4
