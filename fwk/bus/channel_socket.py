"""One channel as its reading process holds it: what has arrived, what is missing, and who may send."""

from collections.abc import Callable, Sequence

from fwk.bus.sockets import multicast_receiver, port_of, told
from fwk.engine.channel_buffer import ChannelBuffer
from fwk.lcm import envelope, messages, wire
from fwk.lcm.messages import MessageError
from fwk.model.plan import ChannelPlan

Complain = Callable[[str, str], None]
"""Takes a channel and what was refused; says it once and counts."""


class ChannelSocket(ChannelBuffer):
    """A channel that comes from another process, or has messages of a predecessor of this process.

    Its messages wait in the socket until `collect` is asked for them, so their arrival wakes nobody.
    """

    def __init__(self, plan: ChannelPlan, port: int, senders: Sequence[int], complain: Complain) -> None:
        super().__init__(plan)
        self._socket = multicast_receiver(port)
        self._senders = senders  # ports that its messages may come from
        self._name = plan.name.encode()
        self._start = len(self._name) + 9  # of the data in a short message
        self._fingerprint = envelope.fingerprint(messages.type_named(plan.type_name))
        self._usual = self._name + b"\0" + self._fingerprint  # what follows the number of a short message
        self._least = self._start + messages.HEADER_SIZE
        self._complain = complain
        self._assembler = wire.Assembler()

    def fileno(self) -> int:
        """For waiting until something arrives."""
        return self._socket.fileno()

    def close(self) -> None:
        """Gives the socket back; from then on only what is put here is here."""
        self._socket.close()

    @property
    def closed(self) -> bool:
        """Whether nothing comes from other processes any more."""
        return self.fileno() < 0

    def collect(self) -> bool:
        """Takes from the socket what is needed up to the mark; says whether all of it is here."""
        while self._newest < self.mark:
            if not self._receive():
                return False
        if ChannelBuffer.collect(self):
            return True
        self._drain()
        return ChannelBuffer.collect(self)

    def held(self, first: int, last: int) -> list[tuple[int, bytes]]:
        """What is here and was not taken yet, of these numbers, oldest first; also what waits in the socket."""
        self._drain()
        return super().held(first, last)

    def lacks(self, sequence: int) -> list[int]:
        """Sequence numbers up to this one, visible or not, that are not here; what waits in the socket is."""
        self._drain()
        return super().lacks(sequence)

    def give_up(self, first: int, last: int) -> int:
        """The writer no longer has these; what waits in the socket is not lost."""
        self._drain()
        return super().give_up(first, last)

    def void(self, above: int, up_to_tick: int, before_incarnation: int) -> None:
        """Forgets what a writer that died had sent beyond the marks, also what still waits in the socket."""
        self._drain()
        super().void(above, up_to_tick, before_incarnation)

    def _drain(self) -> None:
        while self._receive():
            pass

    def _receive(self) -> bool:
        try:
            datagram, address = self._socket.recvfrom(wire.DATAGRAM_MAX)
        except OSError:  # nothing there, or closed
            return False
        if port_of(address) not in self._senders:
            self._complain(self.plan.name, f"datagram from {told(address)}, which is not the writer's; refused")
            return True
        if wire.is_short(datagram) and datagram.startswith(self._usual, 8) and len(datagram) >= self._least:
            data = datagram[self._start :]
            self.put(messages.sequence_of(data), data)
        else:
            try:
                self._take_unusual(datagram, address[1])
            except MessageError as error:
                self._complain(self.plan.name, f"{error}; refused")
        return True

    def _take_unusual(self, datagram: bytes, port: int) -> None:
        """A fragment, or what should not be here."""
        message = self._assembler.feed(datagram, port)
        if message is None:
            return
        channel, data = message
        if channel != self._name:
            raise MessageError(f"message of channel {channel.decode(errors='replace')!r} here")
        if len(data) < messages.HEADER_SIZE or data[:8] != self._fingerprint:
            found, expected = data[:8].hex(), self._fingerprint.hex()
            raise MessageError(f"{len(data)} bytes with fingerprint {found} are no {self.plan.type_name} ({expected})")
        self.put(messages.sequence_of(data), data)
