"""Receives the LCM messages that arrive at one socket, and counts what it refuses."""

from collections.abc import Callable, Container, Iterator

from fwk.bus.network import DatagramSocket
from fwk.bus.sockets import LOOPBACK, told
from fwk.component.log import Logger
from fwk.lcm import wire
from fwk.lcm.messages import MessageError

Complain = Callable[[str, str], None]
"""Takes a channel and the reason why a datagram was refused; names and counts it."""


class Receiver:
    """Assembles the messages of one socket and refuses foreign datagrams.

    Args:
        socket: where the datagrams arrive.
        senders: ports of this machine from which datagrams are accepted.
        owner: owner of these ports in a complaint: "the supervisor's", "of this run".
        topic: channel that complaints name.
        complain: takes each refused datagram.
    """

    def __init__(
        self, socket: DatagramSocket, senders: Container[int], owner: str, topic: str, complain: Complain
    ) -> None:
        self.socket = socket
        self._senders = senders
        self._owner = owner
        self.topic = topic
        self._complain = complain
        self._assembler = wire.Assembler()

    def fileno(self) -> int:
        """Returns the descriptor of the socket."""
        return self.socket.fileno()

    def receive(self) -> tuple[bytes, bytes, int] | None:
        """Returns the next message as (channel, data, port of its sender); None when none waits."""
        while True:
            try:
                datagram, address = self.socket.recvfrom(wire.DATAGRAM_MAX)
            except OSError:  # no datagram, or an error report about an earlier one without a receiver
                return None
            host, port = address
            try:
                if port not in self._senders or host != LOOPBACK:
                    raise MessageError(f"datagram from {told(address)}, which is not {self._owner}")
                message = self._assembler.feed(datagram, port)
            except MessageError as error:
                self.refuse(str(error))
                continue
            if message is not None:
                return (*message, port)

    def messages(self, *channels: bytes) -> Iterator[tuple[bytes, bytes]]:
        """Yields what waits as (channel, data), and refuses messages of other channels than these."""
        while message := self.receive():
            if message[0] in channels:
                yield message[0], message[1]
            else:
                self.refuse(f"message of channel {message[0].decode(errors='replace')!r} here")

    def refuse(self, reason: str) -> None:
        """Counts and names a message that cannot be used."""
        self._complain(self.topic, f"{reason}; refused")


class Complaints:
    """Counter of refused datagrams that logs each kind."""

    def __init__(self, log: Logger) -> None:
        self.total = 0
        self._log = log
        self._counts: dict[tuple[str, str], int] = {}

    def __call__(self, channel: str, text: str) -> None:
        """Counts a refused datagram; logs the first of its kind, the tenth, the hundredth and so on."""
        self.total += 1
        key = (channel, text.partition(";")[0].partition(":")[0][:60])
        if key not in self._counts and len(self._counts) >= 100:
            key = ("", "others")
        count = self._counts[key] = self._counts.get(key, 0) + 1
        if count == 1:
            self._log.warning(f"{channel}: {text}")
        elif str(count).strip("0") == "1":
            self._log.warning(f"{channel}: {text} ({count} times)")
