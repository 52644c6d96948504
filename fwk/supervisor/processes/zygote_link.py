"""The protocol between supervisor and zygote: packets of JSON on a socket pair."""

import contextlib
import dataclasses
import json
import socket
from dataclasses import dataclass
from typing import Any

from fwk.engine.assignment import Start
from fwk.supervisor.processes.starter import Ended, Started

_PACKET_MAX = 1 << 20


class ZygoteEndedError(Exception):
    """The zygote has closed its end of the connection."""


@dataclass(frozen=True)
class StartRequest:
    """A host process to be forked."""

    host: int
    start: Start
    fresh_code: bool
    """Whether the application's modules are imported anew."""


@dataclass(frozen=True)
class SignalRequest:
    """A signal for a host process."""

    pid: int
    number: int


class SupervisorEnd:
    """The supervisor's end of the connection: requests go out, events come in."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection
        connection.setblocking(False)

    def fileno(self) -> int:
        """Returns the descriptor that is readable when there are events."""
        return self._socket.fileno()

    def send(self, request: StartRequest | SignalRequest) -> None:
        """Sends a request; the events report if the zygote has ended."""
        kind = "start" if isinstance(request, StartRequest) else "signal"
        self._socket.setblocking(True)
        with contextlib.suppress(ConnectionError):
            self._socket.send(json.dumps({"request": kind, **dataclasses.asdict(request)}).encode())
        self._socket.setblocking(False)

    def events(self) -> list[Started | Ended]:
        """Returns the events since the last call.

        Raises:
            ZygoteEndedError: the zygote has ended.
        """
        found: list[Started | Ended] = []
        while True:
            try:
                packet, descriptors, _, _ = socket.recv_fds(self._socket, _PACKET_MAX, 2)
            except BlockingIOError:
                return found
            except ConnectionResetError:  # it ended with requests unread
                packet, descriptors = b"", []
            if not packet:
                raise ZygoteEndedError
            event = json.loads(packet)
            if event.pop("event") == "started":
                found.append(Started(**{**event, "streams": (descriptors[0], descriptors[1])}))
            else:
                found.append(Ended(**event))

    def close(self) -> None:
        """Closes the connection, upon which the zygote ends."""
        self._socket.close()


class ZygoteEnd:
    """The zygote's end of the connection: requests come in, events go out."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection

    def fileno(self) -> int:
        """Returns the descriptor that is readable when there is a request."""
        return self._socket.fileno()

    def receive(self) -> StartRequest | SignalRequest | None:
        """Waits for the next request; None: the supervisor has closed the connection."""
        packet = self._socket.recv(_PACKET_MAX)
        if not packet:
            return None
        request: dict[str, Any] = json.loads(packet)
        if request.pop("request") == "start":
            return StartRequest(request["host"], Start(**request["start"]), request["fresh_code"])
        return SignalRequest(**request)

    def send(self, event: Started | Ended) -> None:
        """Reports an event; the streams of a started process travel along as descriptors."""
        data = dataclasses.asdict(event)
        streams = data.pop("streams", None)
        kind = "started" if isinstance(event, Started) else "ended"
        socket.send_fds(self._socket, [json.dumps({"event": kind, **data}).encode()], streams or [])

    def close(self) -> None:
        """Closes this process's copy of the connection."""
        self._socket.close()
