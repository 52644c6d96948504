"""The supervisor's waits: each readable source on the network has a handler."""

from collections.abc import Callable
from typing import Protocol

from fwk.bus.network import Network, Steps
from fwk.bus.waiting import Source

Handler = Callable[[], None]

COARSE_US = 1_500
"""A wait that is to end on time ends so long before: the system counts longer waits in whole milliseconds."""


class EventSource(Protocol):
    """A source of events outside the run's buses: signals, the zygote, the control server."""

    def fileno(self) -> int:
        """Returns the descriptor that is readable when `handle` has something to do."""
        ...

    def handle(self) -> None:
        """Handles what has arrived without waiting."""
        ...


class EventLoop:
    """Waits on a network and calls the handlers of the sources that are readable."""

    def __init__(self, network: Network) -> None:
        self.now_us = network.now_us
        self.network = network
        self.afterwards: Handler = lambda: None
        """Called after each wait."""
        self._handlers: dict[int, Handler] = {}

    def watch(self, source: Source, handler: Handler) -> None:
        """Calls `handler` in waits from now on when `source` is readable."""
        self._handlers[_descriptor(source)] = handler
        self.network.watch(source)

    def unwatch(self, source: Source) -> None:
        """Leaves `source` out of the waits from now on."""
        if self._handlers.pop(_descriptor(source), None):
            self.network.unwatch(source)

    def wait(self, until_us: int) -> Steps[None]:
        """Handles what has arrived; if nothing has, waits for the first event, until `until_us` at most."""
        for descriptor in (yield until_us):
            handler = self._handlers.get(descriptor)
            if handler:
                handler()
        self.afterwards()

    def wait_on_time(self, until_us: int) -> Steps[None]:
        """As `wait`; the last part of a long wait is a wait of its own, so that it ends on time."""
        early_us = until_us - COARSE_US
        yield from self.wait(early_us if early_us > self.now_us() else until_us)


def _descriptor(source: Source) -> int:
    return source if isinstance(source, int) else source.fileno()
