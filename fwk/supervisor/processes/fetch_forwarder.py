"""Forwards fetches for a host that has left the run to the gateway."""

import contextlib

from fwk.bus.sender import Sender
from fwk.lcm.messages import MessageError
from fwk.supervisor.core import Core


class FetchForwarder:
    """Owns the port of a host while that has no process."""

    def __init__(self, core: Core, host: int) -> None:
        port = core.ports.host(host)
        self._ports = core.ports
        self._events = core.events
        self._sender = Sender(port, core.events.network)
        core.events.watch(self._sender.socket, self._forward)

    def close(self) -> None:
        """Gives the port back to the host."""
        self._events.unwatch(self._sender.socket)
        self._sender.socket.close()

    def _forward(self) -> None:
        with contextlib.suppress(MessageError):  # complaints of the hosts name the sender
            message = self._sender.receive(self._ports.members)
            if message and message[0] == b"fwk/fetch":
                self._sender.send(*message, self._ports.host(self._ports.gateway))
