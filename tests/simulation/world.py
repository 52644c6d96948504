"""A world of processes in one thread: a heap of events, a simulated wall clock, and a seed that orders everything."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from random import Random
from typing import TYPE_CHECKING

from tests.simulation.faults import Weather
from tests.simulation.trace import Trace

if TYPE_CHECKING:
    from tests.simulation.process import Process

START_US = 1_000_000_000
"""Wall time at which every world begins."""
EVENTS_MAX = 2_000_000
"""No history needs more events; a world that does is in an endless loop."""


class StuckError(Exception):
    """The world does not end; the message describes its progress."""


class World:
    """Wall time and events. The seed determines the order of simultaneous events."""

    def __init__(self, seed: int, weather: Weather, trace: Trace) -> None:
        self.now_us = START_US
        self.random = Random(seed)
        self.weather = weather
        self.trace = trace
        self.events = 0
        self.running: Process | None = None
        """The process whose step runs."""
        self._heap: list[tuple[int, float, int, Callable[[], None]]] = []

    def at(self, time_us: int, action: Callable[[], None]) -> None:
        """Schedules `action` at a wall time, or now if that has passed."""
        heapq.heappush(self._heap, (time_us, self.random.random(), self.events, action))
        self.events += 1

    def after(self, delay_us: int, action: Callable[[], None]) -> None:
        """Schedules `action` after some wall time."""
        self.at(self.now_us + delay_us, action)

    def jump(self, ahead_us: int) -> None:
        """Moves the clock ahead; events due in between happen now, in their order."""
        self.now_us += ahead_us

    def run(self, until: Callable[[], bool], limit_us: int) -> None:
        """Runs events until `until` is true.

        Raises:
            StuckError: it is still false after that wall time, or no further event can happen.
        """
        heap = self._heap
        while not until():
            if not heap:
                raise StuckError("nothing can happen any more")
            time_us, _, _, action = heapq.heappop(heap)
            self.now_us = max(self.now_us, time_us)
            if self.now_us > START_US + limit_us or self.events > EVENTS_MAX:
                raise StuckError(f"no end after {(self.now_us - START_US) / 1e6:.1f} s and {self.events} events")
            action()
