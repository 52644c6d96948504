"""Asks the kernel which user has the other end of a TCP connection within this machine."""

import contextlib
import ipaddress
import socket
import struct

_SOCK_DIAG = 4  # netlink protocol
_BY_FAMILY = 20  # message type of requests and answers
_REQUEST = 1  # netlink flag
_ALL_STATES = 0xFFFFFFFF
_NO_COOKIE = 0xFFFFFFFF
_HEAD = struct.Struct("=IHHII")  # length, type, flags, sequence number, port
_QUERY = struct.Struct("=BBBBI")  # family, protocol, extensions, padding, states
_PORTS = struct.Struct("!HH")
_REST = struct.Struct("=III")  # interface, cookie in two halves
_UID = struct.Struct("=I")
_UID_AT = 80  # after the head, four bytes, the socket's identity, and three counters
_TIMEOUT_S = 1.0


def user_of(own: tuple[str, int], other: tuple[str, int]) -> int | None:
    """Returns the user of the socket with address `own` that is connected to `other`.

    None: this machine has no such socket, or the kernel does not answer.
    """
    try:
        family = socket.AF_INET6 if ":" in own[0] else socket.AF_INET
        addresses = _padded(own[0]) + _padded(other[0])
    except ValueError:
        return None
    query = _QUERY.pack(family, socket.IPPROTO_TCP, 0, 0, _ALL_STATES)
    query += _PORTS.pack(own[1], other[1]) + addresses + _REST.pack(0, _NO_COOKIE, _NO_COOKIE)
    with (
        contextlib.suppress(OSError, struct.error),
        socket.socket(socket.AF_NETLINK, socket.SOCK_DGRAM, _SOCK_DIAG) as kernel,
    ):
        kernel.settimeout(_TIMEOUT_S)
        kernel.send(_HEAD.pack(_HEAD.size + len(query), _BY_FAMILY, _REQUEST, 1, 0) + query)
        answer = kernel.recv(4096)
        if _HEAD.unpack_from(answer)[1] == _BY_FAMILY:
            uid: int = _UID.unpack_from(answer, _UID_AT)[0]
            return uid
    return None


def _padded(address: str) -> bytes:
    return ipaddress.ip_address(address).packed.ljust(16, b"\0")
