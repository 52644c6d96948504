"""Sockets of the inner buses: multicast on the loopback interface, never further."""

import itertools
import secrets
import select
import socket
from typing import Any

from fwk.clock import US_PER_S, sleep_s
from fwk.lcm import wire
from fwk.lcm.messages import MessageError

GROUP = "239.255.76.67"  # LCM's default group
LOOPBACK = "127.0.0.1"
BUFFER_BYTES = 4 << 20
_BREATH_S = 0.001
_IP_MULTICAST_ALL = 49  # Python has no name for it


Address = tuple[str, int]


def port_of(address: Address) -> int:
    """The port of a sender of this run; 0 for whoever sends from another address, where the run's ports are free."""
    return address[1] if address[0] == LOOPBACK else 0


def told(address: Address) -> str:
    """Where a datagram came from, for people."""
    return f"port {address[1]}" if address[0] == LOOPBACK else f"{address[0]}, port {address[1]}"


def multicast_receiver(port: int, buffer_bytes: int = BUFFER_BYTES) -> socket.socket:
    """A non-blocking socket that hears the group on `port`, as do any others on this machine."""
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
    # Otherwise the socket would hear the network, too, as soon as any program here joins the group there.
    made.setsockopt(socket.IPPROTO_IP, _IP_MULTICAST_ALL, 0)
    made.bind((GROUP, port))
    membership = socket.inet_aton(GROUP) + socket.inet_aton(LOOPBACK)
    made.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, membership)
    made.setblocking(False)
    return made


def own_socket(port: int) -> socket.socket:
    """Opens a non-blocking socket that sends from `port`, to this machine only, and hears what is sent to `port`."""
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    made.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, socket.inet_aton(LOOPBACK))
    made.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, 0)
    made.bind((LOOPBACK, port))
    made.setblocking(False)
    return made


class Sender:
    """Sends LCM messages from a port of its own, by which receivers know who it is; hears what is sent to that port."""

    def __init__(self, port: int, made: Any = None) -> None:
        self.port = port
        self.socket = made or own_socket(port)
        # Not from 0: whoever sends from this port next must not seem to go on with a message that this one left undone.
        self._number = itertools.count(secrets.randbits(32))
        self._assembler = wire.Assembler()
        self.refused = 0  # datagrams that the system would not take; receivers fetch them again

    def publish(self, channel: bytes, data: bytes, port: int) -> None:
        """Sends a message to everybody on `port` of the group."""
        self._send(channel, data, (GROUP, port))

    def publish_slowly(self, channel: bytes, data: bytes, port: int) -> None:
        """As `publish`, a fragment a millisecond: for who has no room for all fragments of a large message at once."""
        first, *others = wire.datagrams(next(self._number) & 0xFFFFFFFF, channel, data)
        self._put(first, (GROUP, port))
        for datagram in others:
            sleep_s(_BREATH_S)
            self._put(datagram, (GROUP, port))

    def send(self, channel: bytes, data: bytes, port: int) -> None:
        """Sends a message to the one process that has `port`."""
        self._send(channel, data, (LOOPBACK, port))

    def wait(self, timeout_us: int) -> None:
        """Waits until something is there to be received, but not for longer."""
        select.select([self.socket], [], [], timeout_us / US_PER_S)

    def receive(self, members: range) -> tuple[bytes, bytes] | None:
        """The next message that was sent to this port alone, as (channel, data); None when nothing is waiting.

        Raises:
            MessageError: it is no LCM message, or does not come from one of the ports of `members`.
        """
        message = None
        while message is None:
            try:
                datagram, address = self.socket.recvfrom(wire.DATAGRAM_MAX)
            except OSError:  # nothing there, or the news that an earlier datagram found nobody
                return None
            if port_of(address) not in members:
                raise MessageError(f"datagram from {told(address)}, which is not of this run")
            message = self._assembler.feed(datagram, address[1])
        return message

    def _send(self, channel: bytes, data: bytes, address: tuple[str, int]) -> None:
        for datagram in wire.datagrams(next(self._number) & 0xFFFFFFFF, channel, data):
            self._put(datagram, address)

    def _put(self, datagram: bytes, address: tuple[str, int]) -> None:
        try:
            self.socket.sendto(datagram, address)
        except OSError:  # a full buffer, a firewall's drop, nobody there: the same as a datagram lost on its way
            self.refused += 1
