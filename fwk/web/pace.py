"""Tells whether a run keeps its desired speed, over some seconds: the speed of a moment varies by a tick or two."""

from collections import deque
from typing import Any

from fwk.clock import US_PER_S

_SPAN_US = 4 * US_PER_S
_LEAST_US = US_PER_S
_KEPT = 0.9
"""Share of its desired speed below which a run lags."""


class PaceMeter:
    """Compares the logical time of a run with the time of a clock."""

    def __init__(self) -> None:
        self._seen: deque[tuple[int, int]] = deque()  # time of the clock, logical time
        self._clock: dict[str, Any] = {}

    def note(self, clock: dict[str, Any], now_us: int) -> None:
        """Notes what a run has said about its clock; the same answer again tells nothing new."""
        if clock is self._clock:
            return
        others = any(clock[key] != self._clock.get(key) for key in ("pace", "paused"))
        if others or clock["time_us"] < self._clock["time_us"]:
            self._seen.clear()
        self._clock = clock
        self._seen.append((now_us, clock["time_us"]))
        while len(self._seen) > 2 and self._seen[1][0] <= now_us - _SPAN_US:
            self._seen.popleft()

    @property
    def lags(self) -> bool:
        """Whether the run goes as fast as possible, or was behind its desired speed in the last seconds."""
        if not self._clock or self._clock["paused"]:
            return False
        if not self._clock["pace"]:
            return True
        (first_us, began_us), (last_us, ended_us) = self._seen[0], self._seen[-1]
        wall_us = last_us - first_us
        return wall_us >= _LEAST_US and ended_us - began_us < _KEPT * self._clock["pace"] * wall_us
