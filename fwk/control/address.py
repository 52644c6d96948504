"""Where runs listen for requests, which runs there are, and whom they obey."""

import os
import socket
import struct
from pathlib import Path

_SUPERVISOR = "fwk-control-"
_GATEWAY = "fwk-board-"
_CREDENTIALS = struct.Struct("3i")  # pid, uid, gid
_ROOT = 0


def supervisor_address(bus_port: int) -> str:
    """The abstract unix socket of the supervisor of the run on that port."""
    return f"\0{_SUPERVISOR}{bus_port}"


def gateway_address(bus_port: int) -> str:
    """The abstract unix socket of that run's gateway, which knows every channel's newest message."""
    return f"\0{_GATEWAY}{bus_port}"


def running() -> list[int]:
    """Bus ports of the runs on this machine, from the kernel's list of sockets."""
    mark = f"@{_SUPERVISOR}"
    names = {line.split()[-1] for line in Path("/proc/net/unix").read_text().splitlines() if mark in line}
    return sorted(int(name.removeprefix(mark)) for name in names if name.removeprefix(mark).isdecimal())


def peer_of(connection: socket.socket) -> tuple[int, int]:
    """Numbers of process and user at the other end, as the kernel knows them; process 0: it cannot be seen."""
    data = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    pid, uid, _ = _CREDENTIALS.unpack(data)
    return pid, uid


def obeys(uid: int) -> bool:
    """Whether a run of ours does what this user says: the user who started it, or root."""
    return uid in (os.geteuid(), _ROOT)
