"""Recognizes changes of files, which would overwrite the results of the run in a replay."""

import os
import sys
import tempfile
from pathlib import Path
from typing import Any

_CHANGES: dict[str, tuple[str, dict[int, int | None]]] = {
    "os.remove": ("removes", {0: 1}),
    "os.rmdir": ("removes", {0: 1}),
    "os.rename": ("renames", {0: 2, 1: 3}),
    "os.mkdir": ("makes", {0: 2}),
    "os.symlink": ("makes", {1: 2}),
    "os.link": ("makes", {1: 3}),
    "os.truncate": ("writes", {0: None}),
    "os.chmod": ("changes", {0: 2}),
    "os.chown": ("changes", {0: 3}),
    "os.utime": ("changes", {0: 3}),
    "sqlite3.connect": ("writes", {0: None}),
}
"""Audit events of changed files: a verb, and the place of each name with that of the descriptor of its folder."""
_HARMLESS = ("/dev/null", "/dev/zero", "/dev/full", "/dev/random", "/dev/urandom", "/dev/tty")
_WITHIN = ("/dev/shm/", "/dev/pts/ptmx")
_TEMPORARY = ("tempfile.mkstemp", "tempfile.mkdtemp")
_OPENED_TO_WRITE = os.O_WRONLY | os.O_RDWR | os.O_TRUNC


class Files:
    """Describes audit events that change files; keeps in mind which files are temporary.

    Private files are those that `tempfile` makes, caches of libraries and compiled code: no other program reads them.
    """

    def __init__(self) -> None:
        home = os.path.expanduser("~")
        self._settings = _real(os.environ.get("XDG_CONFIG_HOME") or f"{home}/.config")
        self._private = [_real(os.environ.get("XDG_CACHE_HOME") or f"{home}/.cache")]
        self._private += [_real(sys.pycache_prefix)] if sys.pycache_prefix else []
        tempfile.gettempdir()  # tries once which folder can be written

    def opening(self, path: Any, flags: int) -> str:
        """Describes the opening of a file that may be written; empty: it is only read, or private."""
        if not flags & _OPENED_TO_WRITE or not isinstance(path, str | bytes | os.PathLike) or os.path.isdir(path):
            return ""
        return "" if self.is_private(os.fsdecode(path)) else f"it writes {os.fsdecode(path)}"

    def change(self, event: str, arguments: tuple[Any, ...]) -> str:
        """Describes the change of a file; empty: the event is another one, or the file is private."""
        if event in _TEMPORARY:
            self._private.append(_real(os.fsdecode(arguments[0])))
        if event not in _CHANGES:
            return ""
        verb, names = _CHANGES[event]
        for place, folder in names.items():
            path = arguments[place]
            if not isinstance(path, str | bytes | os.PathLike):  # the descriptor of a file that is open already
                continue
            name = os.path.join(_folder(arguments[folder] if folder else -1), os.fsdecode(path))
            if not self.is_private(name) and not self._is_nothing(event, name):
                return f"it {verb} {name}"
        return ""

    def is_private(self, name: str) -> bool:
        """Returns whether no other program sees a file: it is temporary, or a library keeps it for itself."""
        path = _real(name)
        return is_harmless(name) or "__pycache__" in path.parts or any(map(path.is_relative_to, self._private))

    def _is_nothing(self, event: str, name: str) -> bool:
        """Returns whether a change changes nothing: a database in memory, a folder that exists or is for settings."""
        if event == "sqlite3.connect":
            return not name or ":memory:" in name or "mode=ro" in name
        return event == "os.mkdir" and (os.path.isdir(name) or _real(name).is_relative_to(self._settings))


def is_harmless(name: str) -> bool:
    """Returns whether a path belongs to a file in /dev that reaches nothing."""
    return name in _HARMLESS or name.startswith(_WITHIN)


def _real(name: str) -> Path:
    """Returns the place of a file; a link counts as the file itself, since it is the link that is removed."""
    return Path(os.path.realpath(os.path.dirname(name)), os.path.basename(name))


def _folder(descriptor: int) -> str:
    return os.path.realpath(f"/proc/self/fd/{descriptor}") if descriptor >= 0 else ""
