"""The messages of one channel in a reading process: visible, missing, void or lost."""

from fwk.lcm.messages import Header, MessageError
from fwk.model.plan import ChannelPlan


class ChannelBuffer:
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
        return ChannelBuffer.lacks(self, self.mark)

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
