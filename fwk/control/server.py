"""The side that is asked: takes requests, one JSON object a line, and never waits for who asks."""

import contextlib
import json
import select
import socket
from collections.abc import Callable, Sequence
from typing import Any

from fwk.control.address import obeys, peer_of

REQUEST_MAX = 64 << 10
REPLIES_MAX = 8 << 20  # bytes that wait for one who does not read
CONNECTIONS_MAX = 32
REQUESTS_MAX = 64  # that may arrive at once
_CHUNK = 64 << 10

Answer = Callable[[bytes, "Connection"], None]
"""Takes a request; replies at once, later, or again and again."""


class Connection:
    """One who asks."""

    def __init__(self, connection: socket.socket, changed: Callable[["Connection"], None]) -> None:
        self.open = True
        self.skipped = 0  # messages of a stream that found no room
        self.pid, self.uid = peer_of(connection)
        self._socket = connection
        self._changed = changed
        self._request = b""
        self._replies = bytearray()
        connection.setblocking(False)

    def fileno(self) -> int:
        """For waiting."""
        return self._socket.fileno()

    @property
    def full(self) -> bool:
        """Whether something waits to be sent."""
        return bool(self._replies)

    def reply(self, message: dict[str, Any], descriptors: Sequence[int] = ()) -> None:
        """Sends as much as goes, keeps the rest; who does not read for long is left."""
        if not self.open:
            return
        self._replies += json.dumps(message).encode() + b"\n"
        if descriptors:
            with contextlib.suppress(OSError):  # `flush` finds out
                del self._replies[: socket.send_fds(self._socket, [self._replies[:_CHUNK]], descriptors)]
        self.flush()
        if len(self._replies) > REPLIES_MAX:
            self.close()

    def stream(self, message: dict[str, Any]) -> None:
        """As `reply`, for one of many: left out if the last ones are not read yet, and counted."""
        if self._replies:
            self.skipped += 1
            return
        self.reply({**message, "skipped": self.skipped})
        self.skipped = 0

    def refuse(self, error: str) -> None:
        """Says what is wrong, and what would be right."""
        self.reply({"ok": False, "error": error})

    def flush(self) -> None:
        """Sends what waits."""
        try:
            while self._replies:
                del self._replies[: self._socket.send(self._replies[:_CHUNK])]
        except BlockingIOError:
            pass
        except OSError:
            self.close()
        if self.open:
            self._changed(self)

    def lines(self) -> list[bytes]:
        """Whole requests that have arrived."""
        try:
            data = self._socket.recv(_CHUNK)
        except BlockingIOError:
            return []
        except OSError:
            data = b""
        if not data:
            self.close()
            return []
        *found, self._request = (self._request + data).split(b"\n")
        if len(self._request) > REQUEST_MAX or len(found) > REQUESTS_MAX:
            self.refuse(f"a request has at most {REQUEST_MAX} bytes, and at most {REQUESTS_MAX} may come at once")
            self.close()
            return []
        return found

    def close(self) -> None:
        """Leaves it."""
        if self.open:
            self.open = False
            self._changed(self)
            self._socket.close()


class Server:
    """Listens; `fileno` is readable when `handle` has something to do."""

    def __init__(self, address: str, answer: Answer) -> None:
        self._answer = answer
        self._listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
        self._listener.bind(address)
        self._listener.listen()
        self._listener.setblocking(False)
        self._epoll = select.epoll()
        self._epoll.register(self._listener, select.EPOLLIN)
        self._connections: dict[int, Connection] = {}

    def fileno(self) -> int:
        """For waiting."""
        return self._epoll.fileno()

    def close(self) -> None:
        """Leaves everybody."""
        for connection in list(self._connections.values()):
            connection.flush()
            connection.close()
        self._epoll.close()
        self._listener.close()

    def handle(self) -> None:
        """Does what can be done without waiting: at most a chunk for each who asks."""
        for descriptor, events in self._epoll.poll(0):
            connection = self._connections.get(descriptor)
            if connection is None:
                self._accept()
                continue
            if events & select.EPOLLOUT:
                connection.flush()
            if connection.open and events & ~select.EPOLLOUT:
                for line in connection.lines():
                    self._take(line, connection)

    def _accept(self) -> None:
        with contextlib.suppress(OSError):  # gone again, or no descriptor is left; the run goes on
            accepted, _ = self._listener.accept()
            connection = Connection(accepted, self._changed)
            self._connections[connection.fileno()] = connection
            self._epoll.register(connection.fileno(), select.EPOLLIN)
            if not obeys(connection.uid):
                connection.refuse(
                    f"user {connection.uid} did not start this run; only its own user and root are obeyed"
                )
                connection.close()
            elif len(self._connections) > CONNECTIONS_MAX:
                connection.refuse(f"there are {CONNECTIONS_MAX} connections already; end one")
                connection.close()

    def _take(self, line: bytes, connection: Connection) -> None:
        if not connection.open or not line.strip():
            return
        self._answer(line, connection)

    def _changed(self, connection: Connection) -> None:
        descriptor = connection.fileno()
        if not connection.open:
            self._epoll.unregister(descriptor)
            del self._connections[descriptor]
        else:
            self._epoll.modify(descriptor, select.EPOLLIN | (select.EPOLLOUT if connection.full else 0))
