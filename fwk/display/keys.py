"""Keys of the live display: reads single keys from the terminal and restores its settings at the end."""

import os
import signal
import sys
import termios
import tty
from typing import Self

_ESCAPES = {b"\x1b[A": "up", b"\x1b[B": "down", b"\x1b[C": "right", b"\x1b[D": "left", b"\x1b": "escape"}
_NAMES = {b" ": "space", b"\t": "tab", b"\r": "enter", b"\n": "enter"}


class Keyboard:
    """Reads single keys from the terminal without echo; Ctrl-C still interrupts the run.

    Without a terminal, or in the background, there are no keys.
    """

    def __init__(self, descriptor: int | None = None) -> None:
        self._descriptor = _terminal() if descriptor is None else descriptor
        self._before: list[object] | None = None

    def __enter__(self) -> Self:
        if self._descriptor is not None:
            signal.signal(signal.SIGTTOU, signal.SIG_IGN)
            signal.signal(signal.SIGTTIN, signal.SIG_IGN)
            try:
                self._before = termios.tcgetattr(self._descriptor)
                tty.setcbreak(self._descriptor, termios.TCSADRAIN)
            except (termios.error, OSError):
                self._descriptor = None
        return self

    def __exit__(self, *_: object) -> None:
        restore(self._descriptor, self._before)

    @property
    def descriptors(self) -> list[int]:
        """Returns the descriptors to wait for; empty without a terminal."""
        return [] if self._descriptor is None else [self._descriptor]

    def read(self) -> list[str]:
        """Returns the keys that have been pressed, by name: letters, `space`, `tab`, `up`, `escape` and so on."""
        if self._descriptor is None:
            return []
        try:
            data = os.read(self._descriptor, 64)
        except OSError:
            data = b""
        if not data:  # the terminal has gone, or the run is in the background
            self._descriptor = None
        return list(_keys(data))


def terminal_settings() -> list[object] | None:
    """Returns the settings of the terminal, to be given back with `restore`; None without a terminal."""
    try:
        return termios.tcgetattr(0) if sys.stdin is not None and os.isatty(0) else None
    except (termios.error, OSError):
        return None


def restore(descriptor: int | None, settings: list[object] | None) -> None:
    """Gives a terminal the settings that it had before."""
    if descriptor is None or settings is None:
        return
    try:
        termios.tcsetattr(descriptor, termios.TCSADRAIN, settings)  # type: ignore[arg-type]
    except (termios.error, OSError):
        return


def _terminal() -> int | None:
    try:
        return 0 if os.isatty(0) and os.tcgetpgrp(0) == os.getpgrp() else None
    except OSError:
        return None


def _keys(data: bytes) -> list[str]:
    found = []
    while data:
        if data.startswith(b"\x1b"):
            word = next((each for each in _ESCAPES if data.startswith(each)), b"\x1b")
            found.append(_ESCAPES[word])
            data = data[len(word) :]
        else:
            found.append(_NAMES.get(data[:1], data[:1].decode("ascii", "replace")))
            data = data[1:]
    return found
