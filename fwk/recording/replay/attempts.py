"""Recognizes in Python's audit events what reaches the world outside of a replay."""

import os
import stat
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import FrameType
from typing import Any

from fwk.recording.replay.descriptors import is_device, is_harmless

LCM_EVENT = "lcm.LCM"
"""Audit event of the LCM library's client, which opens its sockets in C; the guard raises it."""
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
_NETWORK = ("socket.connect", "socket.bind", "socket.sendto", "socket.sendmsg", LCM_EVENT)
_CHANGES = {
    "os.remove": "removes",
    "os.rmdir": "removes",
    "os.rename": "renames",
    "os.truncate": "writes",
    "os.symlink": "makes",
    "os.link": "makes",
    "sqlite3.connect": "writes",
}
"""Events of changed files, each with its verb; the place of the file's name is in `_NAME`."""
_NAME = {"os.symlink": 1, "os.link": 1}
_FOLDER = {"os.remove": 1, "os.rmdir": 1}  # place of the descriptor of the folder that the name belongs to
_TEMPORARY = ("tempfile.mkstemp", "tempfile.mkdtemp")
_LOOKUPS = ("ctypes.util", "platform")
"""Modules of Python that start programs to examine the machine, for libraries that are being imported."""
_PROMPTS = ("cmd", "_pydevd_bundle.pydevd_vars")
_TYPED = ("onecmd", "evaluate_expression")
"""Modules of debuggers, and their functions that carry out what a user types; `cmd` is that of pdb."""


class Attempts:
    """Describes audit events that reach outside; keeps in mind which files are temporary."""

    def __init__(self) -> None:
        self._temporary: list[Path] = []
        self._cache = Path(os.path.realpath(os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")))
        tempfile.gettempdir()  # tries once which folder can be written

    def described(self, event: str, arguments: tuple[Any, ...]) -> str:
        """Describes the access to the outside; empty: there is none."""
        if event == "open":
            return self._opening(arguments[0], arguments[2])
        if event in _CHANGES:
            return self._change(event, arguments)
        if event in _TEMPORARY:
            self._temporary.append(Path(os.path.realpath(os.fsdecode(arguments[0]))))
            return ""
        if event in _PROGRAMS:
            return "" if _asks_about_the_machine() else "it starts a program"
        if event in _SIGNALS:
            return "it sends a signal"
        return "it uses the network" if event in _NETWORK else ""

    def _opening(self, path: Any, flags: int) -> str:
        """Describes the opening of a device, or of any file that may be written."""
        if not isinstance(path, str | bytes | os.PathLike):  # a descriptor that is open already
            return ""
        name = os.fsdecode(path)
        if is_harmless(name):
            return ""
        try:
            mode = os.stat(name).st_mode
        except (OSError, ValueError):
            mode = 0
        if is_device(mode) or (not mode and name.startswith("/dev/")):
            return f"it opens {name}"
        writes = flags & (os.O_WRONLY | os.O_RDWR | os.O_TRUNC) and not stat.S_ISDIR(mode)
        return f"it writes {name}" if writes and not self._is_private(name) else ""

    def _change(self, event: str, arguments: tuple[Any, ...]) -> str:
        path = arguments[_NAME.get(event, 0)]
        if not isinstance(path, str | bytes | os.PathLike):
            return ""
        name = os.fsdecode(path)
        if event in _FOLDER and (folder := arguments[_FOLDER[event]]) >= 0:
            name = os.path.join(os.path.realpath(f"/proc/self/fd/{folder}"), name)
        if event == "sqlite3.connect" and (not name or ":memory:" in name or "mode=ro" in name):
            return ""
        return "" if self._is_private(name) else f"it {_CHANGES[event]} {name}"

    def _is_private(self, name: str) -> bool:
        """Returns whether a file is temporary, or one that a library keeps for itself, such as compiled code."""
        path = Path(os.path.realpath(os.path.dirname(name)), os.path.basename(name))
        return "__pycache__" in path.parts or any(map(path.is_relative_to, (self._cache, *self._temporary)))


def typed_in_debugger() -> bool:
    """Returns whether a user's own words at the prompt of a debugger do this."""
    return any(frame.f_globals.get("__name__") in _PROMPTS and frame.f_code.co_name in _TYPED for frame in _callers())


def _asks_about_the_machine() -> bool:
    return any(frame.f_globals.get("__name__") in _LOOKUPS for frame in _callers())


def _callers() -> Iterator[FrameType]:
    frame: FrameType | None = sys._getframe(1)
    while frame := frame and frame.f_back:
        yield frame
