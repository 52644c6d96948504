"""Somebody who answers the others while a long iteration runs."""

import select
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

_LOOK_MS = 100


class Attendant:
    """A thread that calls `handle` when there is something to read, but only while the main thread lets it."""

    def __init__(self, descriptor: int, handle: Callable[[], object]) -> None:
        self._descriptor = descriptor
        self._handle = handle
        self._attends = threading.Event()
        self._handling = threading.Lock()
        self._thread: threading.Thread | None = None

    @contextmanager
    def serving(self) -> Iterator[None]:
        """Meanwhile the main thread touches nothing that `handle` does."""
        if not self._thread:
            self._thread = threading.Thread(target=self._work, daemon=True)
            self._thread.start()
        self._attends.set()
        try:
            yield
        finally:
            self._attends.clear()
            with self._handling:  # what it does just now comes to its end
                pass

    def _work(self) -> None:
        poller = select.poll()
        poller.register(self._descriptor, select.POLLIN)
        while self._attends.wait():
            if poller.poll(_LOOK_MS):
                with self._handling:
                    if self._attends.is_set():
                        self._handle()
