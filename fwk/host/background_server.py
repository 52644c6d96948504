"""Serves other processes in a thread while a long iteration runs."""

import select
import threading
from collections.abc import Callable, Iterator
from contextlib import AbstractContextManager, contextmanager

from fwk.bus.waiting import HasDescriptor
from fwk.clock import monotonic_us

LOOK_US = 100_000
"""Longest wait of the thread: by then it has noticed that the iteration has ended."""

Handle = Callable[[], int]
"""Handles what has arrived; returns the wall time in microseconds at which it wants to be called again."""
Background = Callable[[HasDescriptor, Handle], AbstractContextManager[None]]
"""Within the context, `handle` is called when the source is readable; the caller then touches nothing that it uses."""


class BackgroundServer:
    """A thread that calls a handler when a source is readable, but only while the main thread lets it."""

    def __init__(self) -> None:
        self._serves = threading.Event()
        self._handling = threading.Lock()
        self._thread: threading.Thread | None = None

    @contextmanager
    def serving(self, source: HasDescriptor, handle: Handle) -> Iterator[None]:
        """Calls `handle` in the thread; the source and the handler are those of the first call."""
        if not self._thread:
            self._thread = threading.Thread(target=self._work, args=(source, handle), daemon=True)
            self._thread.start()
        self._serves.set()
        try:
            yield
        finally:
            self._serves.clear()
            with self._handling:  # lets a call that is under way end
                pass

    def _work(self, source: HasDescriptor, handle: Handle) -> None:
        poller = select.poll()
        poller.register(source.fileno(), select.POLLIN)
        again_us = 0
        while self._serves.wait():
            wait_us = max(0, min(again_us - monotonic_us(), LOOK_US))
            if poller.poll(wait_us / 1000) or monotonic_us() >= again_us:
                with self._handling:
                    if self._serves.is_set():
                        again_us = handle()


@contextmanager
def no_background(_source: HasDescriptor, _handle: Handle) -> Iterator[None]:
    """Does nothing: in a process with one thread, no other process waits during an iteration."""
    yield
