"""Sends LCM messages from the port that identifies a process of a run."""

import itertools
from collections import deque

from fwk.bus.network import Network
from fwk.bus.sockets import GROUP, LOOPBACK, Address
from fwk.lcm import wire

FRAGMENT_INTERVAL_US = 1_000
"""Wall time between two fragments of a paced message."""
NEVER_US = 1 << 62
"""A wall time that never comes."""


class Sender:
    """Sends LCM messages from a port of its own, by which receivers identify the process.

    `socket` receives from that port. A paced message needs further calls of `send_due`, at the time of `due_us`.
    """

    def __init__(self, port: int, network: Network) -> None:
        self.port = port
        self.socket = network.own_socket(port)
        self.refused = 0
        """Datagrams that the system did not take; receivers fetch them again."""
        self.due_us = NEVER_US
        """Wall time at which the next fragment of a paced message is due."""
        self._network = network
        # The next process on this port must not seem to continue a message that this one left incomplete. A process
        # sends less than one message a microsecond, so the numbers of two incarnations do not meet.
        self._number = itertools.count(network.now_us())
        self._paced: deque[tuple[bytes, Address]] = deque()

    def publish(self, channel: bytes, data: bytes, port: int) -> None:
        """Sends a message to all receivers on `port` of the group."""
        self._send(channel, data, (GROUP, port))

    def publish_paced(self, channel: bytes, data: bytes, port: int) -> None:
        """Sends like `publish`, a millisecond between fragments: a small receive buffer holds one at a time."""
        datagrams = wire.datagrams(next(self._number) & 0xFFFFFFFF, channel, data)
        if len(datagrams) == 1 or not self._paced:
            self._put(datagrams.pop(0), (GROUP, port))
        if datagrams and not self._paced:
            self.due_us = self._network.now_us() + FRAGMENT_INTERVAL_US
        self._paced.extend((datagram, (GROUP, port)) for datagram in datagrams)

    @property
    def paced_until_us(self) -> int:
        """Wall time at which the last fragment under way is sent; 0: none is under way."""
        return self.due_us + (len(self._paced) - 1) * FRAGMENT_INTERVAL_US if self._paced else 0

    def send_due(self) -> None:
        """Sends the next fragment of a paced message if its time has come."""
        if self._paced and (now_us := self._network.now_us()) >= self.due_us:
            self._put(*self._paced.popleft())
            self.due_us = now_us + FRAGMENT_INTERVAL_US if self._paced else NEVER_US

    def send(self, channel: bytes, data: bytes, port: int) -> None:
        """Sends a message to the one process that has `port`."""
        self._send(channel, data, (LOOPBACK, port))

    def _send(self, channel: bytes, data: bytes, address: Address) -> None:
        number = next(self._number) & 0xFFFFFFFF
        try:
            if len(data) < wire.SURELY_SHORT:
                self.socket.sendto(wire.in_one(number, channel, data), address)
                return
            for datagram in wire.datagrams(number, channel, data):
                self.socket.sendto(datagram, address)
        except (OSError, OverflowError):  # readers fetch the whole message, as in `_put`; or the port does not exist
            self.refused += 1

    def _put(self, datagram: bytes, address: Address) -> None:
        try:
            self.socket.sendto(datagram, address)
        except OSError:  # a full buffer, a firewall, no receiver: equivalent to a datagram lost on its way
            self.refused += 1
