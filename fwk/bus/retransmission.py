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

    After a repetition either copy of the tick may be the one that was answered. If a host answers both, the first had
    arrived and only took long: it teaches its whole duration, up to twice the timeout, and the margin doubles. If none
    does, it was lost: it teaches nothing (Karn and Partridge, 1987), and the margin is small again, so that further
    losses are noticed soon.
    """

    def __init__(self) -> None:
        self._usual_us = _AT_FIRST_US
        self._deviation_us = _AT_FIRST_US // 4
        self._margin_us = _MARGIN_US
        self._repeated = self._in_vain = False  # since the last stage whose tick was sent once
        self._repeated_took_us = 0

    @property
    def wait_us(self) -> int:
        """Wall time after which an unanswered tick is probably lost, in microseconds."""
        return self._usual_us + 3 * self._deviation_us + self._margin_us

    def repeated(self) -> None:
        """Notes that a tick is repeated."""
        self._repeated, self._in_vain, self._repeated_took_us = True, False, 0

    def answered_twice(self) -> None:
        """Notes that a host answered both copies of the tick that was repeated."""
        if self._repeated and not self._in_vain:
            self._in_vain, self._margin_us = True, min(2 * self._margin_us, _LONGEST_MARGIN_US)
            self._learn_in_vain()

    def took(self, duration_us: int, repeated: bool = False) -> None:
        """Takes note that a stage was answered this long after its tick was sent for the first time.

        Args:
            duration_us: wall time.
            repeated: the tick was repeated meanwhile.
        """
        if repeated:
            self._repeated_took_us = duration_us
            self._learn_in_vain()
            return
        if self._repeated and not self._in_vain:
            self._margin_us = _MARGIN_US
        self._repeated = False
        self._learn(duration_us)

    def _learn_in_vain(self) -> None:
        """Learns from a stage that was repeated in vain, once it has been answered: a debugger may have held it up."""
        if self._in_vain and self._repeated_took_us:
            self._learn(min(self._repeated_took_us, 2 * self.wait_us))

    def _learn(self, duration_us: int) -> None:
        error_us = duration_us - self._usual_us
        self._usual_us += error_us // 8
        self._deviation_us += (abs(error_us) - self._deviation_us) // 4
