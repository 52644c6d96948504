"""Tick records on their way to the gateway: kept, and sent again to who lacks them."""

import contextlib
import struct
from collections import deque

from fwk.bus.ports import Ports
from fwk.bus.sockets import Sender
from fwk.messages import MessageError
from fwk.supervisor.mailbox import Mailbox
from lcmtypes.core import fetch_t

KEPT = 64  # ticks; the loop is never that far ahead of the gateway


class Records:
    """The newest tick records. The gateway asks at the supervisor's port for those that it lacks."""

    def __init__(self, ports: Ports, run: int, sender: Sender, mailbox: Mailbox) -> None:
        self._ports = ports
        self._run = run
        self._sender = sender
        self._kept: deque[tuple[int, bytes]] = deque(maxlen=KEPT)
        mailbox.watch(sender.socket.fileno(), self._on_asked)

    def publish(self, tick: int, data: bytes) -> None:
        """Sends the record of a tick and keeps it for a while."""
        self._kept.append((tick, data))
        self._sender.publish(b"fwk/record", data, self._ports.record)

    def repeat(self, first: int, last: int) -> None:
        """Sends the records of these ticks again."""
        for tick, data in self._kept:
            if first <= tick <= last:
                self._sender.publish(b"fwk/record", data, self._ports.record)

    def _on_asked(self) -> None:
        with contextlib.suppress(MessageError, ValueError, struct.error):  # a stranger's; hosts' complaints name it
            message = self._sender.receive(self._ports.members)
            if message and message[0] == b"fwk/fetch":
                fetch = fetch_t.decode(message[1])
                if fetch.run == self._run:
                    self.repeat(fetch.first_sequence, fetch.last_sequence)
