"""Waits for sockets, with microseconds of resolution for short waits."""

import select
from typing import Protocol

_SELECT_MAX = 1024  # select() accepts no descriptors beyond
_FINE_US = 10_000
_LONGEST_US = 3_600_000_000  # the system accepts some weeks at most


class HasDescriptor(Protocol):
    """A socket, or an object with a descriptor."""

    def fileno(self) -> int: ...


Source = HasDescriptor | int


class Waiting:
    """Set of sources that are waited for together."""

    def __init__(self) -> None:
        self._ready = select.epoll()
        self._select_works = self._ready.fileno() < _SELECT_MAX

    def add(self, source: Source) -> None:
        """Adds a source."""
        self._ready.register(source, select.EPOLLIN)

    def remove(self, source: Source) -> None:
        """Removes a source."""
        self._ready.unregister(source)

    def wait(self, timeout_us: int) -> list[int]:
        """Returns the readable descriptors as soon as there are any; none after `timeout_us`, at most an hour."""
        if 0 < timeout_us < _FINE_US and self._select_works:  # epoll counts in milliseconds and rounds up
            if not select.select((self._ready,), (), (), timeout_us / 1e6)[0]:
                return []
            timeout_us = 0
        found = self._ready.poll(max(0, min(timeout_us, _LONGEST_US)) / 1e6)
        return [found[0][0]] if len(found) == 1 else [descriptor for descriptor, _ in found]

    def close(self) -> None:
        """Closes the descriptor for waiting."""
        self._ready.close()
