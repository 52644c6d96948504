"""A host process that the supervisor did not start and knows by a process descriptor."""

import contextlib
import os
import signal
from collections.abc import Callable

from fwk.engine.assignment import Start
from fwk.supervisor.event_loop import EventLoop


class ExternalProcess:
    """A process that waits to take a host's place in the loop; `begin` informs it that it has the place.

    A process descriptor never comes to mean another process, and it reports the end in any case.

    Raises:
        ProcessLookupError: the process has ended.
    """

    def __init__(self, pid: int, held: bool, begin: Callable[[Start], None], events: EventLoop) -> None:
        self.pid = pid
        self.held = held
        """Whether a debugger holds it, so that no time limit applies."""
        self.begin = begin
        self._events = events
        self._descriptor = os.pidfd_open(pid)

    def watch(self, on_end: Callable[[], None]) -> None:
        """Calls `on_end` when the process has ended."""
        self._events.watch(self._descriptor, on_end)

    def signal(self, number: int) -> None:
        """Signals the process, unless it has ended."""
        with contextlib.suppress(ProcessLookupError):
            signal.pidfd_send_signal(self._descriptor, number)

    def close(self) -> None:
        """Closes the descriptor."""
        self._events.unwatch(self._descriptor)
        os.close(self._descriptor)
