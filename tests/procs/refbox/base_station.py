"""A base station as the protocol of the RefBox describes it: reads JSON objects by TCP, each up to a NUL byte."""

import json
import socket
from typing import Any


class BaseStation:
    """Reads what a RefBox sends."""

    def __init__(self, port: int) -> None:
        self._connection = socket.create_connection(("127.0.0.1", port), timeout=5.0)
        self._data = b""

    def heard(self, count: int) -> list[dict[str, Any]]:
        """Returns the next messages; waits for them."""
        while self._data.count(b"\0") < count:
            more = self._connection.recv(4096)
            assert more, "the RefBox has closed the connection"
            self._data += more
        *messages, self._data = self._data.split(b"\0", count)
        return [json.loads(message) for message in messages]

    def say(self, data: bytes) -> None:
        """Sends bytes, which no RefBox expects."""
        self._connection.sendall(data)

    def end(self) -> None:
        """Says no more, but listens."""
        self._connection.shutdown(socket.SHUT_WR)

    def close(self) -> None:
        """Leaves."""
        self._connection.close()


def say(command: str, team: str = "", **more: Any) -> bytes:
    """Returns the bytes of a command of the RefBox."""
    return json.dumps({"command": command, "targetTeam": team, **more}).encode() + b"\0"
