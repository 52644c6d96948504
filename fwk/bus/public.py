"""The public bus: an ordinary LCM udpm URL, which lcm-spy, lcm-logger and programs in any language understand."""

import contextlib
import ctypes
import itertools
import os
import socket
import struct

from fwk.bus.listeners import Listeners
from fwk.bus.sockets import BUFFER_BYTES, LOOPBACK
from fwk.lcm import wire
from fwk.model.public_url import parse_url

_ANY = "0.0.0.0"
"""Interface: that of the route."""
_SO_ATTACH_FILTER = 26
_DATAGRAMS_AT_ONCE = 5000  # more fragments than the largest message has


class PublicBus:
    """Publishes and receives on one LCM bus; does not receive its own messages.

    Raises:
        OSError: another program has the port, or the machine has no multicast.
    """

    def __init__(self, url: str) -> None:
        group, port, ttl = parse_url(url)
        self._address = (group, port)
        self._number = itertools.count()
        self._leaves_machine = ttl > 0
        self._sender = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._receiver = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        try:
            self._open(group, port, ttl)
        except OSError:
            self._sender.close()
            self._receiver.close()
            raise
        _ignore_source(self._receiver, self._sender.getsockname()[1])
        self._assembler = wire.Assembler()
        self._listeners = Listeners(port, os.fstat(self._receiver.fileno()).st_ino)

    def _open(self, group: str, port: int, ttl: int) -> None:
        self._sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_TTL, ttl)
        self._sender.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, BUFFER_BYTES)
        self._receiver.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self._receiver.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, BUFFER_BYTES)
        self._receiver.bind((group, port))
        self._receiver.setblocking(False)
        self._sender.bind(("", 0))
        try:
            self._use(_ANY)
        except OSError:  # no multicast route: the loopback interface is always there
            self._use(LOOPBACK)

    def fileno(self) -> int:
        """Returns the descriptor of the receiving socket."""
        return self._receiver.fileno()

    def close(self) -> None:
        """Closes both sockets."""
        self._sender.close()
        self._receiver.close()
        self._listeners.close()

    def publish(self, channel: str, data: bytes) -> None:
        """Sends a message; lost messages are not sent again on this bus."""
        for datagram in self.datagrams(channel, data):
            self.send(datagram)

    def datagrams(self, channel: str, data: bytes) -> list[bytes]:
        """Returns the datagrams of a message, for `send`."""
        return wire.datagrams(next(self._number) & 0xFFFFFFFF, channel.encode(), data)

    def send(self, datagram: bytes) -> None:
        """Sends one datagram; a datagram that the system does not take is lost."""
        with contextlib.suppress(OSError):
            self._sender.sendto(datagram, self._address)

    def busy_listeners(self) -> list[str] | None:
        """Returns the names of the programs that still work on earlier messages; None if no program can listen."""
        busy = self._listeners.busy()
        return [] if busy is None and self._leaves_machine else busy

    def receive(self) -> tuple[str, bytes, int] | None:
        """Returns the next message of another program as (channel, data, port of its sender); None when none waits.

        After many fragments that complete no message the result is None too; the caller has to wait and come back.

        Raises:
            MessageError: a datagram that is not of LCM's format.
        """
        for _ in range(_DATAGRAMS_AT_ONCE):
            try:
                datagram, address = self._receiver.recvfrom(wire.DATAGRAM_MAX)
            except BlockingIOError:
                return None
            self._listeners.expect()
            if not datagram:
                continue
            message = self._assembler.feed(datagram, address[1])
            if message is not None:
                return message[0].decode("utf-8", "replace"), message[1], address[1]
        return None

    def _use(self, interface: str) -> None:
        """Sends and receives through an interface.

        The search for a route sends nothing, because LCM in Java complains of datagrams without content.
        """
        group, address = self._address[0], socket.inet_aton(interface)
        self._sender.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, address)
        with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as probe:
            probe.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, address)
            probe.connect(self._address)
        self._receiver.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, socket.inet_aton(group) + address)


def _ignore_source(receiver: socket.socket, port: int) -> None:
    """Makes the kernel drop datagrams from one source port: those that the gateway itself sent."""
    program = struct.pack(
        "HBBI" * 4,
        *(0x28, 0, 0, 0),  # load half word 0 of the UDP header: the source port
        *(0x15, 0, 1, port),  # equal: next, else one further
        *(0x06, 0, 0, 0),  # drop
        *(0x06, 0, 0, 0xFFFFFFFF),  # keep
    )
    memory = ctypes.create_string_buffer(program)
    receiver.setsockopt(
        socket.SOL_SOCKET, _SO_ATTACH_FILTER, struct.pack("HxxxxxxP", len(program) // 8, ctypes.addressof(memory))
    )
