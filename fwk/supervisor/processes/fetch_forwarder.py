"""Stands in for a host that has left the run: whoever lacks one of its messages is sent on to the gateway."""

import contextlib

from fwk.bus.sender import Sender
from fwk.lcm.messages import MessageError
from fwk.model.plan import Plan
from fwk.model.ports import Ports
from fwk.supervisor.event_loop import EventLoop


class StandIn:
    """Has the port of the host as long as no process of its own does."""

    def __init__(self, plan: Plan, host: int, events: EventLoop) -> None:
        ports = Ports.of(plan)
        self._gateway = ports.host(ports.gateway)
        self._members = ports.members
        self._sender = Sender(ports.host(host), events.network)
        self._events = events
        events.watch(self._sender.socket, self._pass_on)

    def close(self) -> None:
        """The host comes back."""
        self._events.unwatch(self._sender.socket)
        self._sender.socket.close()

    def _pass_on(self) -> None:
        with contextlib.suppress(MessageError):  # a stranger's; the hosts' complaints name it
            message = self._sender.receive(self._members)
            if message and message[0] == b"fwk/fetch":
                self._sender.send(*message, self._gateway)
