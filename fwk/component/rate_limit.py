"""Limit on lines per second, which counts the lines that it drops."""

from collections.abc import Callable

from fwk.clock import US_PER_S, monotonic_us


class RateLimit:
    """Admits `per_s` lines in each second of wall time; 0: all lines. It affects nothing but the log."""

    def __init__(self, per_s: int, now_us: Callable[[], int] = monotonic_us) -> None:
        self.per_s = per_s
        self._now_us = now_us
        self._second = -1
        self._lines = 0  # of this second
        self._dropped_now = 0
        self._dropped_before = 0

    def passes(self) -> bool:
        """Counts a line; returns whether it is within the limit."""
        if not self.per_s:
            return True
        self._update()
        self._lines += 1
        return self._lines <= self.per_s

    def drop(self, lines: int = 1) -> None:
        """Counts lines that were dropped in this second."""
        self._dropped_now += lines

    def dropped(self) -> int:
        """Returns the number of lines dropped in seconds that are over; each line is counted once."""
        if not (self._dropped_now or self._dropped_before):
            return 0
        self._update()
        found, self._dropped_before = self._dropped_before, 0
        return found

    def rest(self) -> int:
        """Returns the number of dropped lines including those of the running second."""
        found = self._dropped_before + self._dropped_now
        self._dropped_before = self._dropped_now = 0
        return found

    def _update(self) -> None:
        second = self._now_us() // US_PER_S
        if second != self._second:
            self._second, self._lines = second, 0
            self._dropped_before += self._dropped_now
            self._dropped_now = 0
