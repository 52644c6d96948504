"""Compares recorded messages with those that the replayed components write."""

from collections.abc import Iterable, Sequence

from fwk.engine.component_group import Written
from fwk.lcm.messages import sequence_of
from fwk.recording.difference import Difference, changed, missing


class OutputComparison:
    """Compares messages byte for byte from a tick on, and keeps track of messages that the recording lacks."""

    def __init__(self, from_tick: int) -> None:
        self._from_tick = from_tick
        self.compared = 0
        self.differences: list[Difference] = []
        self.lost: dict[str, set[int]] = {}
        """Sequence numbers by channel that are not in the recording, and that no chosen component wrote again."""

    def with_lost(self, channel: str, tick: int, recorded: list[bytes], written: Iterable[Written]) -> list[bytes]:
        """Returns the recorded messages of a done with those that the recording lost and that were written again."""
        lost = self.lost.get(channel)
        if not lost:
            return recorded
        again = [data for each in written for name, data in each if name == channel and sequence_of(data) in lost]
        lost.difference_update(map(sequence_of, again))
        if tick >= self._from_tick:
            self.compared -= len(again)
        return sorted([*recorded, *again], key=sequence_of)

    def compare(self, channel: str, tick: int, recorded: Sequence[bytes], written: Sequence[bytes]) -> None:
        """Compares the messages of a channel that belong to one iteration."""
        if tick < self._from_tick:
            return
        for place in range(max(len(recorded), len(written))):
            self.compared += 1
            if place >= len(written):
                self.differences.append(missing(channel, recorded[place], place + 1, 1))
            elif place >= len(recorded):
                self.differences.append(missing(channel, written[place], place + 1, 0))
            elif recorded[place] != written[place]:
                self.differences.append(changed(channel, recorded[place], written[place], place + 1))
