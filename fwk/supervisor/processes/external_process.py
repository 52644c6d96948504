"""A host process that somebody started by hand, known to the supervisor by a descriptor of it and not as its child."""

import contextlib
import os
import signal
from collections.abc import Callable

from fwk.engine.assignment import Start
from fwk.supervisor.event_loop import EventLoop


class Hand:
    """A process that waits to take a host's place in the loop; `begin` tells it that it has it.

    A process descriptor cannot come to mean another process, and it tells of the end however that happens.

    Raises:
        ProcessLookupError: there is no such process any more.
    """

    def __init__(self, pid: int, held: bool, begin: Callable[[Start], None], events: EventLoop) -> None:
        self.pid = pid
        self.held = held
        """Whether a debugger has it: then nobody hurries it."""
        self.begin = begin
        self._events = events
        self._descriptor = os.pidfd_open(pid)

    def watch(self, on_end: Callable[[], None]) -> None:
        """Calls `on_end` when it has ended."""
        self._events.watch(self._descriptor, on_end)

    def signal(self, number: int) -> None:
        """Signals it, unless it has ended meanwhile."""
        with contextlib.suppress(ProcessLookupError):
            signal.pidfd_send_signal(self._descriptor, number)

    def close(self) -> None:
        """It has ended."""
        self._events.unwatch(self._descriptor)
        os.close(self._descriptor)
