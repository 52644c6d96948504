"""Keeps replayed components from reaching devices, other programs and the network."""

import os
import sys
import threading
import weakref
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any, NoReturn

from fwk.recording.replay.descriptors import Descriptors, is_device, is_harmless

_PROGRAMS = (
    "subprocess.Popen",
    "os.system",
    "os.exec",
    "os.posix_spawn",
    "os.spawn",
    "os.fork",
    "os.forkpty",
    "pty.spawn",
)
_SIGNALS = ("os.kill", "os.killpg")
_NETWORK = ("socket.connect", "socket.bind", "socket.sendto", "socket.sendmsg")
_MACHINE = ("/sys/", "/proc/")
_ATTEMPTS_MAX = 10
"""Number of equal attempts in one iteration after which a component counts as one that never stops trying."""
_LOOKUPS = ("ctypes.util", "platform")
"""Modules of Python that start programs to examine the machine, for libraries that are being imported."""


class ReachesOutsideError(BaseException):
    """A replayed component tried to reach something outside; not an `Exception`, so that no component swallows it."""


class Guard:
    """Refuses access of components to the world outside: while it watches them, and in the threads that they start.

    It observes files, sockets and programs through Python's audit events, before anything is opened. A library in C
    opens a device without Python; the guard notices that as soon as the call that opened it returns.
    """

    def __init__(self) -> None:
        self.refused: dict[str, str] = {}
        """Components that tried to reach something outside, each with what it tried last."""
        self._watched = ""  # component that is being executed in the thread of the replay
        self._thread = 0  # thread of the replay
        self._threads: weakref.WeakKeyDictionary[threading.Thread, str] = weakref.WeakKeyDictionary()
        """Every thread besides that of the replay, with the component that started it; empty: none that is watched."""
        self._attempts: Counter[str] = Counter()  # of the component that is being executed
        self._elsewhere = False  # a watched component started a thread
        self._installed = False
        self._descriptors = Descriptors()

    @contextmanager
    def watching(self, component: str) -> Iterator[None]:
        """Refuses attempts of a component inside.

        Raises:
            ReachesOutsideError: the component tried to reach something outside, here or earlier in a thread.
        """
        if not self._installed:
            self._installed = True
            sys.addaudithook(self._hear)
        self._check(component)
        self._descriptors.note()
        self._note_threads("")
        self._watched, self._thread = component, threading.get_ident()
        self._attempts.clear()
        try:
            yield
        finally:
            self._watched = ""
            self._note_threads(component)
        if opened := self._descriptors.opened():
            self.refused[component] = f"it opens {opened}"
        self._check(component)  # the component may have caught the refusal

    def _check(self, component: str) -> None:
        if component in self.refused:
            raise ReachesOutsideError(self.refused[component])

    def _note_threads(self, component: str) -> None:
        for thread in threading.enumerate():
            if self._threads.setdefault(thread, component):
                self._elsewhere = True

    def _hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        if not self._watched and not self._elsewhere:
            return
        own = threading.get_ident() == self._thread
        component = self._watched if own else self._threads.get(threading.current_thread(), self._watched)
        if not component or not (tried := _attempt(event, arguments)):
            return
        self.refused[component] = tried
        if own:
            self._attempts[tried] += 1
            if self._attempts[tried] > _ATTEMPTS_MAX:
                _end_replay(component, tried)
            raise ReachesOutsideError(tried)
        raise SystemExit  # ends the thread without a traceback; the component is left out with its next iteration


def _end_replay(component: str, tried: str) -> NoReturn:
    """Ends the process: code that catches everything and tries again cannot be left in another way."""
    sys.stdout.flush()
    sys.stderr.write(
        f"error: {component}: {tried}, which would reach the real world, and tries again whenever the replay refuses "
        "that; declare 'reaches_outside' in its class, or replay other components with --only\n"
    )
    sys.stderr.flush()
    os._exit(2)


def _attempt(event: str, arguments: tuple[Any, ...]) -> str:
    """Describes the access to the outside; empty: there is none."""
    if event == "open":
        return _opening(arguments[0], arguments[2])
    if event in _PROGRAMS:
        return "" if _asks_about_the_machine() else "it starts a program"
    if event in _SIGNALS:
        return "it sends a signal"
    return "it uses the network" if event in _NETWORK else ""


def _opening(path: Any, flags: int) -> str:
    """Describes the opening of a device or of a setting of the machine; empty: the file is another one."""
    if not isinstance(path, str | bytes | os.PathLike):  # a descriptor that is open already
        return ""
    name = os.fsdecode(path)
    if is_harmless(name):
        return ""
    if flags & (os.O_WRONLY | os.O_RDWR) and os.path.realpath(name).startswith(_MACHINE):
        return f"it writes {name}"
    try:
        mode = os.stat(name).st_mode
    except (OSError, ValueError):
        return f"it opens {name}" if name.startswith("/dev/") else ""
    return f"it opens {name}" if is_device(mode) else ""


def _asks_about_the_machine() -> bool:
    frame = sys._getframe()
    while frame.f_back is not None:
        frame = frame.f_back
        if frame.f_globals.get("__name__") in _LOOKUPS:
            return True
    return False
