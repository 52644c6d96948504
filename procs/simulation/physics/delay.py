"""A delay line: what goes in comes out a fixed time later, in order."""

from collections import deque
from typing import Generic, TypeVar

T = TypeVar("T")


class DelayLine(Generic[T]):
    """First in, first out, `delay_us` later."""

    def __init__(self, delay_us: int) -> None:
        self._delay_us = delay_us
        self._waiting: deque[tuple[int, T]] = deque()

    def put(self, item: T, now_us: int) -> None:
        """Puts an item in; calls have to be in the order of time."""
        self._waiting.append((now_us + self._delay_us, item))

    def due(self, now_us: int) -> list[T]:
        """Takes out everything whose time has come, oldest first."""
        items = []
        while self._waiting and self._waiting[0][0] <= now_us:
            items.append(self._waiting.popleft()[1])
        return items
