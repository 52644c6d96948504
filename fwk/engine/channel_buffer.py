"""The messages of one channel in a reading host: visible, missing, void or lost."""

from fwk.lcm.messages import Header, MessageError
from fwk.model.plan import ChannelPlan


class ChannelBuffer:
    """Messages of one channel, in order of their sequence numbers, visible and not yet visible."""

    def __init__(self, plan: ChannelPlan) -> None:
        self.plan = plan
        self.mark = 0
        """Highest visible sequence number."""
        self.floor = 0
        """Messages up to this number were taken or are no longer wanted."""
        self.lost: list[int] = []
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

    def forget(self, sequence: int) -> None:
        """Drops a message that has arrived and was not taken yet, as if it had never come."""
        self._held.pop(sequence, None)

    def collect(self) -> bool:
        """Returns whether all messages up to the mark are here."""
        wanted = self.mark - self.floor
        if self._newest == self.mark:  # no message beyond the mark: counting is enough
            return len(self._held) == wanted
        return len(self._held) >= wanted and not self.missing()

    def missing(self) -> list[int]:
        """Returns the sequence numbers up to the mark that are not here."""
        return ChannelBuffer.lacks(self, self.mark)

    def lacks(self, sequence: int) -> list[int]:
        """Returns the sequence numbers up to `sequence`, visible or not, that are not here."""
        return [number for number in range(self.floor + 1, sequence + 1) if number not in self._held]

    def take(self) -> list[bytes]:
        """Returns the messages that became visible since the last call, oldest first."""
        held, floor = self._held, self.floor
        self.floor = self.mark
        if self.mark == floor + 1 and (data := held.pop(self.mark, b"")):  # mostly
            return [data]
        taken = [held.pop(number, b"") for number in range(floor + 1, self.mark + 1)]
        if not all(taken):
            self.lost += [number for number, data in enumerate(taken, floor + 1) if not data]
            taken = [data for data in taken if data]
        return taken

    def keep_newest(self) -> None:
        """Drops every visible message but the newest, as the catch-up rule demands."""
        self.floor = max(self.floor, self.mark - 1)
        for number in [number for number in self._held if number <= self.floor]:
            del self._held[number]

    def give_up(self, first: int, last: int) -> int:
        """Counts messages that the writer no longer has as lost; returns how many were still missing."""
        lost = [number for number in self.missing() if first <= number <= last]
        for number in lost:
            self._held[number] = b""
        if lost:
            self._newest = max(self._newest, lost[-1])  # no message up to there is waited for any more
        return len(lost)

    def held(self, first: int, last: int) -> list[tuple[int, bytes]]:
        """Returns the messages `first` to `last` that are here and not taken yet, oldest first."""
        return sorted((number, data) for number, data in self._held.items() if first <= number <= last and data)

    def void(self, above: int, up_to_tick: int, before_incarnation: int) -> None:
        """Drops messages that a writer sent beyond the marks before it died.

        Messages of its next incarnation, or of another component that writes the channel later, are younger.
        """
        for number in [number for number in self._held if number > above]:
            tick, incarnation = _age(self._held[number])
            if tick <= up_to_tick and incarnation < before_incarnation:
                del self._held[number]
        self._newest = max(self._held, default=self.floor)


def _age(data: bytes) -> tuple[int, int]:
    """Returns tick and incarnation of a message; the incarnation follows '#' in the header's writer.

    Of two messages with the same sequence number the older one was sent by a writer that died before its done.
    """
    try:
        header = Header.of(data)
    except MessageError:
        return -1, 0
    return header.tick, header.incarnation
