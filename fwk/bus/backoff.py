"""The waits between repetitions of a message that was not answered: ticks, dones, fetches."""


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
