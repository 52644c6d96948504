"""A limit to lines a second, which counts what it holds back."""

from collections.abc import Callable

from fwk.clock import US_PER_S, monotonic_us


class RateLimit:
    """Room for `per_s` lines in each second; 0: for all. It decides nothing but what is logged."""

    def __init__(self, per_s: int, now_us: Callable[[], int] = monotonic_us) -> None:
        self.per_s = per_s
        self._now_us = now_us
        self._second = -1
        self._lines = 0  # of this second
        self._dropped_now = 0
        self._dropped_before = 0

    def passes(self) -> bool:
        """Whether there is room for one more line."""
        if not self.per_s:
            return True
        self._look_at_the_clock()
        self._lines += 1
        return self._lines <= self.per_s

    def drop(self, lines: int = 1) -> None:
        """Counts lines that were held back in this second."""
        self._dropped_now += lines

    def dropped(self) -> int:
        """How many lines were held back in seconds that are over; each is told once."""
        if not (self._dropped_now or self._dropped_before):
            return 0
        self._look_at_the_clock()
        found, self._dropped_before = self._dropped_before, 0
        return found

    def rest(self) -> int:
        """As `dropped`, at the end: those of this second too."""
        found = self._dropped_before + self._dropped_now
        self._dropped_before = self._dropped_now = 0
        return found

    def _look_at_the_clock(self) -> None:
        second = self._now_us() // US_PER_S
        if second != self._second:
            self._second, self._lines = second, 0
            self._dropped_before += self._dropped_now
            self._dropped_now = 0
