"""Finds devices, connections and files to write that a library in C has opened."""

import fcntl
import os
import socket
import stat
import struct
from pathlib import Path

from fwk.recording.replay.files import Files, is_harmless

_TIOCGPTN = 0x80045430  # asks a pseudo terminal for its number; Python 3.11 does not name it
_OPEN = Path("/proc/self/fd")


class Descriptors:
    """Compares the open descriptors of this process before and after a call.

    A descriptor that is opened takes the lowest free number; while that number stays the same, nothing is looked at.
    """

    def __init__(self, files: Files) -> None:
        self._files = files
        self._lowest = -1
        self._known: set[str] = set()

    def note(self) -> None:
        """Notes the open descriptors before a call."""
        if _lowest_free() != self._lowest:
            self._lowest = _lowest_free()
            self._known = set(os.listdir(_OPEN)) - {str(self._lowest)}  # the descriptor of the listing itself

    def opened(self) -> str:
        """Describes a device, a connection or a file to write that was opened since `note`; empty: none."""
        if _lowest_free() == self._lowest:
            return ""
        opened = sorted(set(os.listdir(_OPEN)) - self._known, key=int)
        own = {name for number in opened if (name := _own_terminal(int(number)))}
        return next((found for number in opened if (found := self._reached(int(number), own))), "")

    def _reached(self, number: int, own_terminals: set[str]) -> str:
        try:
            about, name = os.fstat(number), os.readlink(_OPEN / str(number))
            flags = fcntl.fcntl(number, fcntl.F_GETFL)
        except OSError:  # closed in between
            return ""
        if stat.S_ISSOCK(about.st_mode):
            return _connection(number)
        if is_harmless(name) or name in own_terminals or name == "/dev/ptmx" or name.startswith("pipe:"):
            return ""
        if stat.S_ISREG(about.st_mode) and about.st_nlink and self._files.opening(name, flags):
            return f"{name} to write"
        return name if is_device(about.st_mode) else ""


def is_device(mode: int) -> bool:
    """Returns whether a file's mode is that of a device or of a pipe with a name."""
    return stat.S_ISCHR(mode) or stat.S_ISBLK(mode) or stat.S_ISFIFO(mode)


def _lowest_free() -> int:
    number = os.dup(0) if _is_open(0) else os.open("/dev/null", os.O_RDONLY)
    os.close(number)
    return number


def _is_open(number: int) -> bool:
    try:
        fcntl.fcntl(number, fcntl.F_GETFD)
    except OSError:
        return False
    return True


def _own_terminal(number: int) -> str:
    """Returns the path of the pseudo terminal of which this descriptor is the master; empty: it is another file."""
    try:
        (index,) = struct.unpack("I", fcntl.ioctl(number, _TIOCGPTN, b"\0\0\0\0"))
    except OSError:
        return ""
    return f"/dev/pts/{index}"


def _connection(number: int) -> str:
    """Describes a socket of the network or of hardware; empty: it is one within the machine."""
    with socket.socket(fileno=os.dup(number)) as copy:
        if copy.family in (socket.AF_UNIX, socket.AF_NETLINK):
            return ""
        if copy.family in (socket.AF_INET, socket.AF_INET6):
            address, port, *_ = copy.getsockname()
            return f"a connection at {address}:{port}" if port else "a socket of the network"
        return f"a socket of family {copy.family}"
