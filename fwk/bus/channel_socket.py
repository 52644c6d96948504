"""A channel buffer that takes its messages from a socket."""

from collections.abc import Callable, Container

from fwk.bus.network import DatagramSocket
from fwk.bus.sockets import LOOPBACK, told
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.lcm import envelope, messages, wire
from fwk.lcm.messages import MessageError
from fwk.model.plan import ChannelPlan

Complain = Callable[[str, str], None]
"""Takes a channel and the reason why a datagram was refused; names and counts it."""


class ChannelSocket(ChannelBuffer):
    """The messages of a channel that another process, or a predecessor of this one, writes.

    They wait in the socket until `collect` takes them, so their arrival wakes no process.

    Args:
        plan: the channel.
        source: the socket on which its messages arrive.
        senders: ports from which its messages are accepted.
        complain: takes each refused datagram.
    """

    def __init__(self, plan: ChannelPlan, source: DatagramSocket, senders: Container[int], complain: Complain) -> None:
        super().__init__(plan)
        self._socket = source
        self._senders = senders
        self._name = plan.name.encode()
        self._start = len(self._name) + 9  # position of the data in a short message
        self._fingerprint = envelope.fingerprint(messages.type_named(plan.type_name))
        self._usual = self._name + b"\0" + self._fingerprint  # follows the number in a short message
        self._least = self._start + messages.HEADER_SIZE
        self._complain = complain
        self._assembler = wire.Assembler()

    def fileno(self) -> int:
        """Returns the descriptor of the socket; -1 once it is closed."""
        return self._socket.fileno()

    def close(self) -> None:
        """Closes the socket; from then on messages come by `put` alone."""
        self._socket.close()

    @property
    def closed(self) -> bool:
        """Whether no messages of other processes come any more."""
        return self.fileno() < 0

    def collect(self) -> bool:
        """Takes messages from the socket up to the mark; returns whether all of them are here."""
        while self._newest < self.mark:
            if not self._receive():
                return False
        if ChannelBuffer.collect(self):
            return True
        self._drain()
        return ChannelBuffer.collect(self)

    def held(self, first: int, last: int) -> list[tuple[int, bytes]]:
        """Returns the messages `first` to `last` that are here and not taken yet, oldest first."""
        self._drain()
        return super().held(first, last)

    def lacks(self, sequence: int) -> list[int]:
        """Returns the sequence numbers up to `sequence`, visible or not, that have not arrived."""
        self._drain()
        return super().lacks(sequence)

    def give_up(self, first: int, last: int) -> int:
        """Counts messages that the writer no longer has as lost, unless they wait in the socket."""
        self._drain()
        return super().give_up(first, last)

    def void(self, above: int, up_to_tick: int, before_incarnation: int) -> None:
        """Drops messages that a writer sent beyond the marks before it died, also those in the socket."""
        self._drain()
        super().void(above, up_to_tick, before_incarnation)

    def _drain(self) -> None:
        while self._receive():
            pass

    def _receive(self) -> bool:
        try:
            datagram, address = self._socket.recvfrom(wire.DATAGRAM_MAX)
        except OSError:  # no datagram, or closed
            return False
        host, port = address
        if port not in self._senders or host != LOOPBACK:
            self._complain(self.plan.name, f"datagram from {told(address)}, which is not the writer's; refused")
            return True
        if wire.is_short(datagram) and datagram.startswith(self._usual, 8) and len(datagram) >= self._least:
            data = datagram[self._start :]
            self.put(messages.sequence_of(data), data)
        else:
            try:
                self._take_unusual(datagram, port)
            except MessageError as error:
                self._complain(self.plan.name, f"{error}; refused")
        return True

    def _take_unusual(self, datagram: bytes, port: int) -> None:
        """Takes a fragment, or refuses a message that does not belong on this channel."""
        message = self._assembler.feed(datagram, port)
        if message is None:
            return
        channel, data = message
        if channel != self._name:
            raise MessageError(f"message of channel {channel.decode(errors='replace')!r} here")
        if len(data) < messages.HEADER_SIZE or data[:8] != self._fingerprint:
            found, expected = data[:8].hex(), self._fingerprint.hex()
            raise MessageError(
                f"{len(data)} bytes with fingerprint {found} are not a {self.plan.type_name} ({expected})"
            )
        self.put(messages.sequence_of(data), data)
