"""Recognizes in Python's audit events what reaches the world outside of a replay."""

import os
import sys
from collections.abc import Iterator
from types import FrameType
from typing import Any

from fwk.recording.replay.descriptors import is_device
from fwk.recording.replay.files import Files, is_harmless

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
_LOOKUPS = ("ctypes.util", "platform")
"""Modules of Python that start programs to examine the machine, for libraries that are being imported."""
_PROMPTS = ("cmd", "_pydevd_bundle.pydevd_vars")
_TYPED = ("onecmd", "evaluate_expression")
"""Modules of debuggers, and their functions that carry out what a user types; `cmd` is that of pdb."""


def attempt(event: str, arguments: tuple[Any, ...], files: Files) -> str:
    """Describes the access to the outside; empty: there is none."""
    if event == "open":
        return _opening(arguments[0]) or files.opening(arguments[0], arguments[2])
    if event in _PROGRAMS:
        return "" if _asks_about_the_machine() else "it starts a program"
    if event in _SIGNALS:
        return "it sends a signal"
    return "it uses the network" if event in _NETWORK else files.change(event, arguments)


def _opening(path: Any) -> str:
    """Describes the opening of a device; empty: the file is another one."""
    if not isinstance(path, str | bytes | os.PathLike):  # a descriptor that is open already
        return ""
    name = os.fsdecode(path)
    if is_harmless(name):
        return ""
    try:
        mode = os.stat(name).st_mode
    except (OSError, ValueError):
        return f"it opens {name}" if name.startswith("/dev/") else ""
    return f"it opens {name}" if is_device(mode) else ""


def typed_in_debugger() -> bool:
    """Returns whether a user's own words at the prompt of a debugger do this."""
    return any(frame.f_globals.get("__name__") in _PROMPTS and frame.f_code.co_name in _TYPED for frame in _callers())


def _asks_about_the_machine() -> bool:
    return any(frame.f_globals.get("__name__") in _LOOKUPS for frame in _callers())


def _callers() -> Iterator[FrameType]:
    frame: FrameType | None = sys._getframe(1)
    while frame := frame and frame.f_back:
        yield frame
