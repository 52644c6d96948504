"""Keeps replayed components from reaching devices, other programs and the network."""

import os
import stat
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

_PROGRAMS = ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.fork", "os.forkpty", "pty.spawn")
_NETWORK = ("socket.connect", "socket.bind", "socket.sendto", "socket.sendmsg")
_HARMLESS = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom", "/dev/tty")


class ReachesOutsideError(BaseException):
    """A replayed component tried to reach something outside; not an `Exception`, so that no component swallows it."""


class Guard:
    """Refuses what components do to the world outside while it watches.

    It hears of files, sockets and programs through Python's audit events. A library in C that opens a device without
    Python does so unheard; a component that uses one has to declare that it reaches outside.
    """

    def __init__(self) -> None:
        self.refused = ""
        """What the component tried last; empty: nothing."""
        self._watching = False
        self._installed = False

    @contextmanager
    def watching(self) -> Iterator[None]:
        """Refuses attempts inside.

        Raises:
            ReachesOutsideError: the component tried to reach something outside.
        """
        if not self._installed:
            self._installed = True
            sys.addaudithook(self._hear)
        self._watching, self.refused = True, ""
        try:
            yield
        finally:
            self._watching = False
        if self.refused:  # the component caught the refusal
            raise ReachesOutsideError(self.refused)

    def _hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self._watching:
            return
        tried = ""
        if event == "open":
            tried = _device(arguments[0])
        elif event in _PROGRAMS:
            tried = "it starts a program"
        elif event in _NETWORK:
            tried = "it uses the network"
        if tried:
            self.refused = tried
            raise ReachesOutsideError(tried)


def _device(path: Any) -> str:
    """Describes a device file; empty: the path is none."""
    if not isinstance(path, str | bytes):  # a descriptor that is open already
        return ""
    name = os.fsdecode(path)
    if name in _HARMLESS or name.startswith("/dev/shm/"):
        return ""
    try:
        mode = os.stat(name).st_mode
    except (OSError, ValueError):
        return f"it opens {name}" if name.startswith("/dev/") else ""
    special = stat.S_ISCHR(mode) or stat.S_ISBLK(mode) or stat.S_ISFIFO(mode)
    return f"it opens {name}" if special else ""
