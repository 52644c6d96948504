"""A delay line: what goes in comes out a fixed time later, in order."""

import sys
from collections import deque
from typing import Generic, TypeVar

T = TypeVar("T")


class DelayLine(Generic[T]):
    """First in, first out, `delay_us` later."""

    def __init__(self, delay_us: int) -> None:
        self.next_us = sys.maxsize
        """Time at which the oldest item comes out; far away if there is none."""
        self._delay_us = delay_us
        self._waiting: deque[tuple[int, T]] = deque()

    def put(self, item: T, now_us: int) -> None:
        """Puts an item in; calls have to be in the order of time."""
        self._waiting.append((now_us + self._delay_us, item))
        self.next_us = self._waiting[0][0]

    def clear(self) -> None:
        """Drops everything that has not come out yet."""
        self._waiting.clear()
        self.next_us = sys.maxsize

    def due(self, now_us: int) -> list[T]:
        """Takes out everything whose time has come, oldest first."""
        items = []
        while self.next_us <= now_us:
            items.append(self._waiting.popleft()[1])
            self.next_us = self._waiting[0][0] if self._waiting else sys.maxsize
        return items
