"""Server side of the control sockets: takes requests, one JSON object a line, and never waits for a client."""

import contextlib
import errno
import json
import select
import socket
from collections.abc import Callable, Sequence
from typing import Any

from fwk.control.address import obeys, peer_of

REQUEST_MAX = 64 << 10
REPLIES_MAX = 8 << 20  # bytes kept for a client that does not read
CONNECTIONS_MAX = 32
REQUESTS_MAX = 64  # bytes read at once
_CHUNK = 64 << 10

Answer = Callable[[bytes, "Connection"], None]
"""Takes a request; replies at once, later, or again and again."""


class ControlNameError(Exception):
    """Another process holds the name of a control socket; the text names the remedy."""


class Connection:
    """Connection of one client."""

    def __init__(self, connection: socket.socket, changed: Callable[["Connection"], None]) -> None:
        self.open = True
        self.skipped = 0  # stream messages left out because the client did not read
        self.asked = 0  # requests taken
        self.waiting = 0  # requests not answered yet
        self.streams = False
        self.pid, self.uid = peer_of(connection)
        self._socket = connection
        self._changed = changed
        self._request = b""
        self._replies = bytearray()
        connection.setblocking(False)

    def fileno(self) -> int:
        """Returns the descriptor to wait for."""
        return self._socket.fileno()

    @property
    def full(self) -> bool:
        """Whether bytes wait to be sent."""
        return bool(self._replies)

    @property
    def idle(self) -> bool:
        """Whether the client waits for nothing."""
        return not (self.waiting or self.streams or self.full)

    def reply(self, message: dict[str, Any], descriptors: Sequence[int] = ()) -> None:
        """Sends as much as the socket takes and keeps the rest; disconnects a client that does not read."""
        if not self.open:
            return
        self.waiting = max(0, self.waiting - 1)
        self._replies += json.dumps(message).encode() + b"\n"
        if descriptors:
            with contextlib.suppress(OSError):  # `flush` detects the error
                del self._replies[: socket.send_fds(self._socket, [self._replies[:_CHUNK]], descriptors)]
        self.flush()
        if len(self._replies) > REPLIES_MAX:
            self.close()

    def stream(self, message: dict[str, Any]) -> None:
        """Sends one message of a stream; leaves it out, and counts it, while the client has not read earlier ones."""
        self.streams = True
        if self._replies:
            self.skipped += 1
            return
        self.reply({**message, "skipped": self.skipped})
        self.skipped = 0

    def refuse(self, error: str) -> None:
        """Replies with an error: the mistake and the correction."""
        self.reply({"ok": False, "error": error})

    def flush(self) -> None:
        """Sends kept bytes."""
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
        """Returns the complete requests that have arrived."""
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
        wrong = ""
        if len(self._request) > REQUEST_MAX:
            wrong = f"a request, with all texts in it, has at most {REQUEST_MAX:,} bytes; send shorter texts"
        elif len(found) > REQUESTS_MAX:
            wrong = f"{len(found)} requests at once; send at most {REQUESTS_MAX}"
        if wrong:
            self.refuse(wrong)
            self.close()
            return []
        return found

    def close(self) -> None:
        """Disconnects the client."""
        if self.open:
            self.open = False
            self._changed(self)
            self._socket.close()


def listen(address: str) -> socket.socket:
    """Opens an abstract unix socket that takes connections.

    Raises:
        ControlNameError: another process has bound the address.
    """
    listener = socket.socket(socket.AF_UNIX, socket.SOCK_STREAM)
    try:
        listener.bind(address)
    except OSError as error:
        listener.close()
        if error.errno != errno.EADDRINUSE:
            raise
        name = address.lstrip("\0")
        raise ControlNameError(
            f"another process has the control socket @{name}; end it, or start this run with another --bus-port"
        ) from error
    listener.listen()
    listener.setblocking(False)
    return listener


class Server:
    """Serves a listening unix socket; `fileno` is readable when `handle` has something to do."""

    def __init__(self, listener: socket.socket, answer: Answer) -> None:
        self._answer = answer
        self._listener = listener
        self._epoll = select.epoll()
        self._epoll.register(self._listener, select.EPOLLIN)
        self._connections: dict[int, Connection] = {}

    def fileno(self) -> int:
        """Returns the descriptor to wait for."""
        return self._epoll.fileno()

    def close(self) -> None:
        """Disconnects all clients and stops listening."""
        for connection in list(self._connections.values()):
            connection.flush()
            connection.close()
        self._epoll.close()
        self._listener.close()

    def handle(self) -> None:
        """Does all work that needs no waiting: reads at most one chunk of input from each client."""
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
        with contextlib.suppress(OSError):  # the client has left again, or no descriptor is free; the run goes on
            accepted, _ = self._listener.accept()
            connection = Connection(accepted, self._changed)
            self._connections[connection.fileno()] = connection
            self._epoll.register(connection.fileno(), select.EPOLLIN)
            if not obeys(connection.uid):
                connection.refuse(
                    f"user {connection.uid} did not start this run; only its own user and root are obeyed"
                )
                connection.close()
            elif len(self._connections) > CONNECTIONS_MAX and not self._make_room(connection):
                connection.refuse(f"{CONNECTIONS_MAX} connections are open and in use already; end one")
                connection.close()

    def _make_room(self, newest: Connection) -> bool:
        """Disconnects the oldest idle client, preferring those that never asked; returns whether there was one."""
        idle = [each for each in self._connections.values() if each is not newest and each.idle]
        if idle:
            chosen = min(idle, key=lambda each: each.asked > 0)  # of equal ones the oldest
            chosen.refuse("disconnected: idle, and another client needs the connection")
            chosen.close()
        return bool(idle)

    def _take(self, line: bytes, connection: Connection) -> None:
        if not connection.open or not line.strip():
            return
        connection.asked += 1
        connection.waiting += 1
        self._answer(line, connection)

    def _changed(self, connection: Connection) -> None:
        descriptor = connection.fileno()
        if not connection.open:
            self._epoll.unregister(descriptor)
            del self._connections[descriptor]
        else:
            self._epoll.modify(descriptor, select.EPOLLIN | (select.EPOLLOUT if connection.full else 0))
