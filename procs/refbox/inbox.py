"""Messages that a peer has sent over a connection, some in each tick: no flood can hold the game up."""

import socket

from procs.refbox.protocol import Stream

_BYTES = 65_536  # taken from the connection at a time
_MESSAGES = 100  # handed out in a tick; a base station reports ten times a second


class Inbox:
    """The messages of one connection; no call waits for the peer."""

    def __init__(self, connection: socket.socket) -> None:
        self._connection = connection
        self._stream = Stream()
        self._unread: list[bytes] = []

    def take(self) -> list[bytes]:
        """Returns the next messages, without their NUL, a hundred at most.

        While some are left, no more bytes are taken from the connection.

        Raises:
            ProtocolError: the peer sends a message that is too long; it is dropped, and the others follow.
            EOFError: the peer sends no more, and all that it sent was returned; it may still read.
            OSError: the connection is lost.
        """
        if not self._unread:
            self._receive()
        taken, self._unread = self._unread[:_MESSAGES], self._unread[_MESSAGES:]
        return taken

    def _receive(self) -> None:
        try:
            data = self._connection.recv(_BYTES)
        except BlockingIOError:
            return
        if not data:
            raise EOFError("it closed the connection")
        for message in self._stream.feed(data):
            self._unread.append(message)
