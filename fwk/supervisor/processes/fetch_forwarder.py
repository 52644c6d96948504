"""Forwards fetches for a host that has left the run to the gateway."""

from fwk.bus.receiver import Complaints, Receiver
from fwk.bus.sender import Sender
from fwk.supervisor.core import Core


class FetchForwarder:
    """Holds the port of a host without a process."""

    def __init__(self, core: Core, host: int) -> None:
        port = core.ports.host(host)
        self._gateway_port = core.ports.host(core.ports.gateway)
        self._events = core.events
        self._sender = Sender(port, core.events.network)
        complaints = Complaints(core.log)
        self._own = Receiver(self._sender.socket, core.ports.members, "of this run", "fwk/fetch", complaints)
        core.events.watch(self._own, self._forward)

    def close(self) -> None:
        """Returns the port to the host."""
        self._events.unwatch(self._own)
        self._sender.socket.close()

    def _forward(self) -> None:
        while message := self._own.receive():
            channel, data, _ = message
            if channel == b"fwk/fetch":
                self._sender.send(channel, data, self._gateway_port)
