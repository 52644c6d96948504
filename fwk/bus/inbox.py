"""One channel as its reading process holds it: what has arrived, what is missing, and who may send."""

from collections.abc import Callable, Sequence

from fwk import envelope, messages
from fwk.bus import wire
from fwk.bus.sockets import multicast_receiver, port_of, told
from fwk.messages import Header, MessageError
from fwk.plan.model import ChannelPlan

Complain = Callable[[str, str], None]
"""Takes a channel and what was refused; says it once and counts."""


class Box:
    """Messages of one channel, in order of their sequence numbers, up to and beyond what is visible."""

    def __init__(self, plan: ChannelPlan) -> None:
        self.plan = plan
        self.mark = 0  # highest sequence number that is visible
        self.floor = 0  # everything up to here was taken or is not wanted any more
        self.missed: list[int] = []
        """Sequence numbers of messages that were visible and never came."""
        self._held: dict[int, bytes] = {}
        self._newest = 0

    def put(self, sequence: int, data: bytes) -> None:
        """Takes a message, once."""
        if sequence <= self.floor:
            return
        if sequence > self._newest:
            self._held[sequence] = data
            self._newest = sequence
        else:
            held = self._held.get(sequence)
            if held is None or _age(held) < _age(data):
                self._held[sequence] = data

    def collect(self) -> bool:
        """Whether everything up to the mark is here."""
        wanted = self.mark - self.floor
        if self._newest == self.mark:  # none beyond it, so that counting is enough
            return len(self._held) == wanted
        return len(self._held) >= wanted and not self.missing()

    def missing(self) -> list[int]:
        """Sequence numbers up to the mark that are not here."""
        return Box.lacks(self, self.mark)

    def lacks(self, sequence: int) -> list[int]:
        """Sequence numbers up to this one, visible or not, that are not here."""
        return [number for number in range(self.floor + 1, sequence + 1) if number not in self._held]

    def take(self) -> list[bytes]:
        """The messages that became visible since the last time, oldest first."""
        held, floor = self._held, self.floor
        self.floor = self.mark
        taken = [held.pop(number, b"") for number in range(floor + 1, self.mark + 1)]
        if not all(taken):
            self.missed += [number for number, data in enumerate(taken, floor + 1) if not data]
            taken = [data for data in taken if data]
        return taken

    def skip_to(self, sequence: int) -> None:
        """Does not want anything up to `sequence`: a late joiner takes the newest only."""
        self.floor = max(self.floor, sequence)
        for number in [number for number in self._held if number <= self.floor]:
            del self._held[number]

    def give_up(self, first: int, last: int) -> int:
        """The writer no longer has these: lost for good. Returns how many were still missing."""
        lost = [number for number in self.missing() if first <= number <= last]
        for number in lost:
            self._held[number] = b""
        if lost:
            self._newest = max(self._newest, lost[-1])  # nothing up to there is waited for any more
        return len(lost)

    def held(self, first: int, last: int) -> list[tuple[int, bytes]]:
        """What is here and was not taken yet, of these numbers, oldest first."""
        return sorted((number, data) for number, data in self._held.items() if first <= number <= last and data)

    def void(self, above: int, up_to_tick: int, before_incarnation: int) -> None:
        """Forgets what a writer that died in a tick had sent beyond the marks.

        What its next start, or another component that may write the channel later on, has sent is younger.
        """
        for number in [number for number in self._held if number > above]:
            tick, incarnation = _age(self._held[number])
            if tick <= up_to_tick and incarnation < before_incarnation:
                del self._held[number]
        self._newest = max(self._held, default=self.floor)


class Inbox(Box):
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
        if Box.collect(self):
            return True
        self._drain()
        return Box.collect(self)

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


def _age(data: bytes) -> tuple[int, int]:
    """Tick of a message, and which start of its writer sent it: 1, or the number after '#' in the header's writer.

    Of two with the same number the older one was sent by somebody who died before its done.
    """
    try:
        header = Header.of(data)
    except MessageError:
        return -1, 0
    writer = header.writer
    return header.tick, int(writer.rpartition("#")[2]) if "#" in writer else 1
