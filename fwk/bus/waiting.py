"""Waiting for sockets, to the microsecond where it matters."""

import select
from typing import Protocol

_SELECT_MAX = 1024  # select() takes no descriptors beyond
_FINE_US = 10_000
_LONGEST_US = 3_600_000_000  # the system takes some weeks at most


class HasDescriptor(Protocol):
    """A socket, or what has one."""

    def fileno(self) -> int: ...


Source = HasDescriptor | int


class Waiting:
    """Sources to wait for together."""

    def __init__(self) -> None:
        self._ready = select.epoll()
        self._select_works = self._ready.fileno() < _SELECT_MAX

    def add(self, source: Source) -> None:
        """From now on waits for this one, too."""
        self._ready.register(source, select.EPOLLIN)

    def remove(self, source: Source) -> None:
        """No longer."""
        self._ready.unregister(source)

    def wait(self, timeout_us: int) -> list[int]:
        """The descriptors that have something, as soon as one has, or none after that time, or an hour."""
        if not 0 < timeout_us < _FINE_US or not self._select_works:
            return [descriptor for descriptor, _ in self._ready.poll(max(0, min(timeout_us, _LONGEST_US)) / 1e6)]
        # epoll counts in milliseconds and rounds up
        if not select.select((self._ready,), (), (), timeout_us / 1e6)[0]:
            return []
        return [descriptor for descriptor, _ in self._ready.poll(0)]

    def close(self) -> None:
        """Gives its own descriptor back."""
        self._ready.close()
