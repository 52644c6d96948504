"""UDP sockets of this machine and the processes that have them, as the kernel shows them."""

import os
import socket
import struct
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple

_TABLES = Path("/proc/net/udp"), Path("/proc/net/udp6")
# Linux's sock_diag (netlink/diag.h, inet_diag.h): a request for sockets, and what the kernel answers for each.
_SOCK_DIAG, _SOCK_DIAG_BY_FAMILY = 4, 20
_REQUEST_AND_DUMP, _ERROR, _DONE = 0x301, 2, 3
_HEADER = struct.Struct("=IHHII")  # length with this header, type, flags, number, sender
_REQUEST = struct.Struct("=BBBBI 2s2s32xI8s")  # family, protocol, -, -, states, port, port of a peer, interface, cookie
_ANSWER = struct.Struct("=4x48x4x I 4x II")  # datagrams' bytes that wait, user, inode
_ANY = 0xFFFFFFFF
_ANSWER_BYTES = 1 << 16
_ANSWER_S = 1.0


class UdpSocket(NamedTuple):
    """A UDP socket that is bound to a port."""

    inode: str
    user: str
    """Number of the user."""
    waiting: bool
    """Whether datagrams wait in it."""


def sockets_on(port: int) -> list[UdpSocket]:
    """Returns the sockets of all users that are bound to a port; none where the kernel does not show them.

    A socket of IPv6 may receive IPv4, too: Java opens such ones.
    """
    try:
        return [*_asked_for(port, socket.AF_INET), *_asked_for(port, socket.AF_INET6)]
    except OSError:  # a kernel without this interface
        return list(_in_table(port))


def _asked_for(port: int, family: int) -> Iterator[UdpSocket]:
    """Asks the kernel for the sockets of one port: with a thousand sockets 40 times faster than the table of all."""
    anything = struct.pack("=II", _ANY, _ANY)
    wanted = _REQUEST.pack(family, socket.IPPROTO_UDP, 0, 0, _ANY, port.to_bytes(2, "big"), b"", 0, anything)
    with socket.socket(socket.AF_NETLINK, socket.SOCK_RAW, _SOCK_DIAG) as kernel:
        kernel.settimeout(_ANSWER_S)
        kernel.send(_HEADER.pack(_HEADER.size + len(wanted), _SOCK_DIAG_BY_FAMILY, _REQUEST_AND_DUMP, 1, 0) + wanted)
        while True:
            answers, start = kernel.recv(_ANSWER_BYTES), 0
            while start < len(answers):
                length, kind, *_ = _HEADER.unpack_from(answers, start)
                if kind == _DONE:
                    return
                if kind == _ERROR:
                    raise OSError("the kernel does not list UDP sockets")
                waiting, user, inode = _ANSWER.unpack_from(answers, start + _HEADER.size)
                yield UdpSocket(str(inode), str(user), waiting > 0)
                start += length + 3 & ~3  # answers begin at multiples of four bytes


def _in_table(port: int) -> Iterable[UdpSocket]:
    """Reads the tables twice: the kernel passes over a socket if another one is closed while a table is read."""
    ending, found = f":{port:04X}", {}
    for table in _TABLES * 2:
        with suppress(OSError):  # a kernel without IPv6
            for line in table.read_text().splitlines():
                if ending in line:
                    columns = line.split()
                    if columns[1].endswith(ending):
                        found[columns[9]] = UdpSocket(columns[9], columns[7], not columns[4].endswith(":00000000"))
    return found.values()


def owners(inodes: Iterable[str]) -> Iterator[tuple[str, int]]:
    """Yields each of these sockets with the process number of each of its owners, as far as this user may know them."""
    links = {f"socket:[{inode}]": inode for inode in inodes}
    for process in sorted(map(int, filter(str.isdigit, os.listdir("/proc") if links else ()))):
        for link in dict.fromkeys(_links(f"/proc/{process}/fd")):
            if link in links:
                yield links[link], process


def _links(folder: str) -> Iterator[str]:
    with suppress(OSError):  # of another user, or ended
        for name in os.listdir(folder):
            with suppress(OSError):  # closed
                yield os.readlink(f"{folder}/{name}")


def process_name(process: int) -> str:
    """Returns the name of a process as `ps` shows it; empty if it has ended."""
    with suppress(OSError):
        return Path(f"/proc/{process}/comm").read_text().strip()
    return ""
