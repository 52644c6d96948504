"""Control sockets of the runs on this machine: their addresses, owners, and permitted users."""

import os
import socket
import struct

_SUPERVISOR = "fwk-control-"
_GATEWAY = "fwk-board-"
_CREDENTIALS = struct.Struct("3i")  # pid, uid, gid
_ROOT = 0


def supervisor_address(bus_port: int) -> str:
    """Returns the abstract unix socket of the supervisor of the run on that port."""
    return f"\0{_SUPERVISOR}{bus_port}"


def gateway_address(bus_port: int) -> str:
    """Returns the abstract unix socket of that run's gateway, which holds the newest message of each channel."""
    return f"\0{_GATEWAY}{bus_port}"


def supervisor_beside(control_address: str) -> str:
    """Returns the address of the supervisor of the run that a control socket belongs to."""
    return control_address.replace(_GATEWAY, _SUPERVISOR)


def running() -> list[int]:
    """Returns the bus ports of the runs on this machine, from the kernel's list of sockets.

    Any user can bind a socket of any name, also of bytes that are not UTF-8; such names are ignored.
    """
    mark = f"@{_SUPERVISOR}".encode()
    with open("/proc/net/unix", "rb") as sockets:
        ports = [line.rstrip(b"\n").rpartition(mark)[2] for line in sockets if mark in line]
    return sorted({int(port) for port in ports if port.isdigit() and len(port) < 6})


def peer_of(connection: socket.socket) -> tuple[int, int]:
    """Returns process and user number of the other end, as the kernel knows them; process 0: not visible from here."""
    data = connection.getsockopt(socket.SOL_SOCKET, socket.SO_PEERCRED, _CREDENTIALS.size)
    pid, uid, _ = _CREDENTIALS.unpack(data)
    return pid, uid


def obeys(uid: int) -> bool:
    """Returns whether a run of this user obeys that user: the user who started the run, and root, are obeyed."""
    return uid in (os.geteuid(), _ROOT)


def trusts(uid: int) -> bool:
    """Returns whether a tool of this user trusts a socket of that user; root uses the runs of all users."""
    return uid in (os.geteuid(), _ROOT) or os.geteuid() == _ROOT
