"""One channel as its reading process holds it: what has arrived, what is missing, and who may send."""

import socket
from collections.abc import Callable

from fwk import messages
from fwk.bus import wire
from fwk.bus.sockets import multicast_receiver
from fwk.messages import Header, MessageError
from fwk.plan.model import ChannelPlan

Complain = Callable[[str, str], None]
"""Takes a channel and what was refused; says it once and counts."""


class Inbox:
    """Messages of one channel, in order of their sequence numbers.

    They wait in the socket until `collect` is asked for them, so their arrival wakes nobody.
    """

    def __init__(self, plan: ChannelPlan, port: int, writer_port: int, complain: Complain) -> None:
        self.plan = plan
        self.mark = 0  # highest sequence number that is visible
        self.floor = 0  # everything up to here was taken or is not wanted any more
        self._held: dict[int, bytes] = {}
        self._newest = 0
        self._socket = multicast_receiver(port)
        self._writer_port = writer_port
        self._name = plan.name.encode()
        self._start = len(self._name) + 9  # of the data in a short message
        self._fingerprint = messages.fingerprint(messages.type_named(plan.type_name))
        self._complain = complain
        self._assembler = wire.Assembler()

    def fileno(self) -> int:
        """For waiting until something arrives."""
        return self._socket.fileno()

    def close(self) -> None:
        """Gives the socket back."""
        self._socket.close()

    def collect(self) -> bool:
        """Takes from the socket what is needed up to the mark; says whether all of it is here."""
        while self._newest < self.mark:
            if not self._receive():
                return False
        if len(self._held) >= self.mark - self.floor and not self.missing():
            return True
        while self._receive():
            pass
        return not self.missing()

    def missing(self) -> list[int]:
        """Sequence numbers up to the mark that are not here."""
        held = self._held
        return [number for number in range(self.floor + 1, self.mark + 1) if number not in held]

    def take(self) -> list[bytes]:
        """The messages that became visible since the last time, oldest first."""
        held, floor = self._held, self.floor
        self.floor = self.mark
        if self.mark == floor + 1:
            return [held.pop(self.mark)] if self.mark in held else []
        return [held.pop(number) for number in range(floor + 1, self.mark + 1) if number in held]

    def skip_to(self, sequence: int) -> None:
        """Gives up what is missing up to `sequence`, or does not want it: a late joiner takes the newest only."""
        self.floor = max(self.floor, sequence)
        for number in [number for number in self._held if number <= self.floor]:
            del self._held[number]

    def give_up(self, first: int, last: int) -> int:
        """The writer no longer has these: lost for good. Returns how many were still missing."""
        lost = [number for number in self.missing() if first <= number <= last]
        for number in lost:
            self._held[number] = b""
        return len(lost)

    def void(self, above: int, before_incarnation: int) -> None:
        """Forgets what a writer that died had sent beyond the marks."""
        while self._receive():
            pass
        for number in [number for number in self._held if number > above]:
            if _incarnation(self._held[number]) < before_incarnation:
                del self._held[number]
        self._newest = max(self._held, default=self.floor)

    def _receive(self) -> bool:
        try:
            datagram, address = self._socket.recvfrom(wire.DATAGRAM_MAX)
        except BlockingIOError:
            return False
        if address[1] != self._writer_port:
            self._complain(self.plan.name, f"datagram from port {address[1]}, which is not the writer's; refused")
            return True
        start = self._start
        if datagram[:4] == b"LC02" and datagram[8:start] == self._name + b"\0":
            data = datagram[start:]
        else:
            try:
                message = self._assembler.feed(datagram, address[1])
            except MessageError as error:
                self._complain(self.plan.name, f"{error}; refused")
                return True
            if message is None:
                return True
            if message[0] != self._name:
                self._complain(self.plan.name, f"message of channel {message[0].decode(errors='replace')!r} here; refused")
                return True
            data = message[1]
        if len(data) < messages.HEADER_SIZE or data[:8] != self._fingerprint:
            found, size = data[:8].hex(), len(data)
            self._complain(
                self.plan.name,
                f"{size} bytes with fingerprint {found} are no {self.plan.type_name} ({self._fingerprint.hex()}); refused",
            )
            return True
        number = messages.sequence_of(data)
        if number > self.floor:
            held = self._held.get(number)
            if held is None or _incarnation(held) < _incarnation(data):
                self._held[number] = data
            if number > self._newest:
                self._newest = number
        return True


def _incarnation(data: bytes) -> int:
    """Which start of its writer sent a message: 1, or the number after '#' in the header's writer."""
    try:
        writer = Header.of(data).writer
    except MessageError:
        return 0
    return int(writer.rpartition("#")[2]) if "#" in writer else 1
