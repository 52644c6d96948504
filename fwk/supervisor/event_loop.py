"""The supervisor's waits: each readable source has a handler, and handlers emit typed events into one queue."""

from collections import deque
from collections.abc import Callable
from typing import Any, TypeVar

from fwk.bus.network import Network, Steps
from fwk.bus.waiting import Source

E = TypeVar("E")
Handler = Callable[[], None]

COARSE_US = 1_500
"""Margin before the end of a precise wait: the system counts longer waits in whole milliseconds."""


class EventLoop:
    """Waits on a network, collects what readable sources emit, and hands each event to its subscribers.

    Events are handled in the order in which they were emitted, after all sources that were readable together.
    """

    def __init__(self, network: Network) -> None:
        self.now_us = network.now_us
        self.network = network
        self._handlers: dict[int, Handler] = {}
        self._queue: deque[Any] = deque()
        self._subscribers: dict[type[Any], list[Callable[[Any], None]]] = {}
        self._afterwards: list[Handler] = []

    def watch(self, source: Source, handler: Handler) -> None:
        """Calls `handler` in waits from now on when `source` is readable."""
        self._handlers[_descriptor(source)] = handler
        self.network.watch(source)

    def unwatch(self, source: Source) -> None:
        """Removes `source` from the waits."""
        if self._handlers.pop(_descriptor(source), None):
            self.network.unwatch(source)

    def subscribe(self, kind: type[E], handler: Callable[[E], None]) -> None:
        """Calls `handler` with each event of a type."""
        self._subscribers.setdefault(kind, []).append(handler)

    def after_each_wait(self, handler: Handler) -> None:
        """Calls `handler` whenever events may have been handled."""
        self._afterwards.append(handler)

    def emit(self, event: object) -> None:
        """Puts an event into the queue."""
        self._queue.append(event)

    def dispatch(self) -> None:
        """Passes the events in the queue to their subscribers, and also those that these emit."""
        while self._queue:
            event = self._queue.popleft()
            for subscriber in self._subscribers.get(type(event), ()):
                subscriber(event)

    def wait(self, until_us: int) -> Steps[None]:
        """Handles what has arrived; if nothing has, waits for the first event, until `until_us` at most."""
        for descriptor in (yield until_us):
            handler = self._handlers.get(descriptor)
            if handler:
                handler()
        self.dispatch()
        for afterwards in self._afterwards:
            afterwards()

    def wait_on_time(self, until_us: int) -> Steps[None]:
        """Waits like `wait`; the last part of a long wait is a separate wait, so that it ends on time."""
        early_us = until_us - COARSE_US
        yield from self.wait(early_us if early_us > self.now_us() else until_us)


def _descriptor(source: Source) -> int:
    return source if isinstance(source, int) else source.fileno()
