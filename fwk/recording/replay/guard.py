"""Keeps replayed components from reaching devices, other programs, the network and files that others see."""

import os
import sys
import threading
import weakref
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from functools import cache
from importlib import import_module
from typing import Any, NoReturn

from fwk.recording.replay.attempts import LCM_EVENT, attempt, typed_in_debugger
from fwk.recording.replay.descriptors import Descriptors
from fwk.recording.replay.files import Files

_ATTEMPTS_MAX = 10
"""Number of equal attempts in one iteration after which a component counts as one that never stops trying."""


class ReachesOutsideError(BaseException):
    """A replayed component tried to reach something outside; not an `Exception`, so that no component swallows it."""


class Guard:
    """Refuses access of components to the world outside: while it watches them, and in the threads that they start.

    It observes files, sockets and programs through Python's audit events, before anything is opened. A library in C
    opens a device, a socket or a file without Python; the guard notices that as soon as the call that opened it
    returns, if it is still open then.
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
        self._files = Files()
        self._descriptors = Descriptors(self._files)

    @contextmanager
    def watching(self, component: str) -> Iterator[None]:
        """Refuses attempts of a component inside.

        Raises:
            ReachesOutsideError: the component tried to reach something outside, here or earlier in a thread.
        """
        _install()
        self._check(component)
        self._descriptors.note()
        self._note_threads("")
        self._watched, self._thread = component, threading.get_ident()
        self._attempts.clear()
        if self not in _hearing:
            _hearing.append(self)
        try:
            yield
        finally:
            self._watched = ""
            self._note_threads(component)
            if not self._elsewhere:
                _hearing.remove(self)
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

    def hear(self, event: str, arguments: tuple[Any, ...]) -> None:
        """Refuses what an audit event announces, if a watched component or one of its threads raised it."""
        own = threading.get_ident() == self._thread
        component = self._watched if own else self._threads.get(threading.current_thread(), self._watched)
        if not component or not (tried := attempt(event, arguments, self._files)) or typed_in_debugger():
            return
        self.refused[component] = tried
        if own:
            self._attempts[tried] += 1
            if self._attempts[tried] > _ATTEMPTS_MAX:
                _end_replay(component, tried)
            raise ReachesOutsideError(tried)
        raise SystemExit  # ends the thread without a traceback; the component is left out with its next iteration


_hearing: list[Guard] = []
"""Guards that watch a component now, or threads that one started."""


@cache
def _install() -> None:
    """Hears audit events from now on; Python can remove no hook, so that all guards of the process share this one."""
    _let_lcm_be_heard()
    sys.addaudithook(_hear)


def _hear(event: str, arguments: tuple[Any, ...]) -> None:
    for guard in _hearing:
        guard.hear(event, arguments)


def _end_replay(component: str, tried: str) -> NoReturn:
    """Ends the process: code that catches everything and tries again cannot be left in another way."""
    sys.stdout.flush()
    sys.stderr.write(
        f"error: {component}: {tried}, which reaches outside, and tries again whenever the replay refuses "
        "that; declare 'reaches_outside' in its class, or replay other components with --only\n"
    )
    sys.stderr.flush()
    os._exit(2)


def _let_lcm_be_heard() -> None:
    """Lets the client of the LCM library, which opens and uses its sockets in C, raise an audit event."""
    with suppress(ImportError):
        library: Any = import_module("lcm")
        client: Any = library.LCM

        class HeardLCM(client):  # type: ignore[misc]
            def __new__(cls, *arguments: Any, **named: Any) -> Any:
                sys.audit(LCM_EVENT)
                return super().__new__(cls, *arguments, **named)

        library.LCM = HeardLCM
