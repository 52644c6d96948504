"""Peers whose machine is switched off: they say no farewell, so the system has to ask whether they are there."""

import socket

_GONE_S = 20
"""A peer that does not answer for so long is gone; by itself the system would send on for 15 minutes."""
_PROBES = 4
_OPTIONS = (
    (socket.SOL_SOCKET, socket.SO_KEEPALIVE, 1),
    (socket.IPPROTO_TCP, socket.TCP_KEEPIDLE, _GONE_S // _PROBES),
    (socket.IPPROTO_TCP, socket.TCP_KEEPINTVL, _GONE_S // _PROBES),
    (socket.IPPROTO_TCP, socket.TCP_KEEPCNT, _PROBES - 1),
    (socket.IPPROTO_TCP, socket.TCP_USER_TIMEOUT, 1000 * _GONE_S),
)


def notice_absence(connection: socket.socket) -> None:
    """Lets a connection fail 20 s after its peer has vanished."""
    for level, option, value in _OPTIONS:
        connection.setsockopt(level, option, value)
