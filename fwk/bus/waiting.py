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
        self._poll = self._ready.poll
        self._select_works = self._ready.fileno() < _SELECT_MAX

    def add(self, source: Source) -> None:
        """Adds a source."""
        self._ready.register(source, select.EPOLLIN)

    def remove(self, source: Source) -> None:
        """Removes a source."""
        self._ready.unregister(source)

    def wait(self, timeout_us: int) -> list[int]:
        """Returns the readable descriptors as soon as there are any; none after `timeout_us`, at most an hour."""
        if timeout_us >= _FINE_US:
            found = self._poll(timeout_us / 1e6 if timeout_us < _LONGEST_US else _LONGEST_US / 1e6)
        elif timeout_us > 0 and not self._readable_within(timeout_us):
            return []
        else:
            found = self._poll(0)
        return [found[0][0]] if len(found) == 1 else [descriptor for descriptor, _ in found]

    def _readable_within(self, timeout_us: int) -> bool:
        """Waits to the microsecond, where the system can: epoll counts in milliseconds and rounds up."""
        if self._select_works:
            return bool(select.select((self._ready,), (), (), timeout_us / 1e6)[0])
        return bool(self._poll(timeout_us / 1e6))

    def close(self) -> None:
        """Closes the descriptor for waiting."""
        self._ready.close()
