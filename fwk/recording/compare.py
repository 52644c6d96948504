"""Compares two logs message by message, on every channel of the application, however their channels interleave."""

from collections import OrderedDict, deque
from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from itertools import islice, zip_longest
from pathlib import Path

from fwk.lcm.event_log import Event, LogError
from fwk.lcm.messages import HEADER_SIZE, sequence_of
from fwk.lcm.stamped_log import StampedLog
from fwk.lcm.type_registry import header_of, is_interface
from fwk.model.plan import Plan
from fwk.recording.difference import Difference, changed, missing
from fwk.recording.versions import BROKEN, PLAN, read_plan

FRAMEWORK = "fwk/"
_SELF_TEST = "LCM_SELF_TEST"  # liblcm's self test when a process subscribes
_PLAN_WITHIN = 1000  # events at the beginning of a log among which its plan is
_RECENT = 1024  # messages of a channel among which a repeated one is recognized; writers keep fewer to send again


def compare(a: Path, b: Path, common: bool = False) -> Difference | None:
    """Returns the first difference of two logs by tick, stage, channel and sequence; None: they are equal.

    Equal logs have the same bytes in the same order on each channel. A message that a logger received twice, because
    it was sent again to a reader, counts once.

    Args:
        a: one log.
        b: the other log.
        common: compares only sequence numbers within the ranges of both logs, for logs of different length.

    Raises:
        LogError: a file cannot be read, is not a log, or there is nothing to compare.
    """
    return Comparison(a, b, common).difference


def plan_in(log: Path) -> Plan | None:
    """Returns the plan that a recording begins with; None if the log has no plan that can be read.

    Raises:
        LogError: the file cannot be read, or is not a log.
    """
    reader = StampedLog(log)
    for event in islice(reader, _PLAN_WITHIN):
        if event.channel == PLAN:
            try:
                return read_plan(event.data)[0]
            except BROKEN:
                return None
    reader.check_any()
    return None


class Comparison:
    """Comparison of two logs with its figures."""

    def __init__(self, a: Path, b: Path, common: bool = False) -> None:
        self.messages = 0
        """Equal messages outside `fwk/`."""
        self.repeated = 0
        """Messages that a log held twice."""
        self.channels = 0
        """Channels on which there was something to compare."""
        self._channels: dict[str, _Channel] = {}
        readers = StampedLog(a), StampedLog(b)
        self._ranges = _common_ranges(readers) if common else None
        for pair in zip_longest(*readers):
            for side, event in enumerate(pair):
                if event is not None and _counts(event.channel):
                    self._take(side, event, other_ended=pair[1 - side] is None)
        self.skipped_bytes = readers[0].skipped_bytes, readers[1].skipped_bytes
        """Damaged bytes in each log."""
        for reader in readers:
            reader.check_any()
        found = [difference for name, channel in self._channels.items() if (difference := channel.end(name))]
        found.sort(key=lambda difference: difference.key)
        self.differences = [replace(difference, names=_names(a, b)) for difference in found]
        """The first difference of each channel, by tick."""
        if not found and not self.messages:
            where = "no common sequence numbers" if common else f"no messages outside '{FRAMEWORK}'"
            raise LogError(f"{a}, {b}: nothing to compare: {where}")
        self.channels = len(self._channels)

    @property
    def difference(self) -> Difference | None:
        """The first difference; None: the logs are equal."""
        return self.differences[0] if self.differences else None

    def _take(self, side: int, event: Event, other_ended: bool) -> None:
        name, data = event.channel, event.data
        sequence = sequence_of(data) if len(data) >= HEADER_SIZE and is_interface(data) else None
        if self._ranges is not None:
            first, last = self._ranges.get(name, (1, 0))
            if sequence is None or not first <= sequence <= last:
                return
        channel = self._channels.get(name)
        if channel is None:
            channel = self._channels[name] = _Channel()
        if sequence is not None and channel.sides[side].is_repeated(sequence, data):
            self.repeated += 1
        elif channel.difference:
            channel.look_for(side, sequence)
        else:
            channel.sides[side].waiting.append(data)
            self.messages += channel.advance(name)
            if other_ended and channel.sides[side].waiting:
                channel.end(name)


class _Side:
    """Messages of a channel in one log that the other log has not matched yet."""

    def __init__(self) -> None:
        self.waiting: deque[bytes] = deque()
        self._newest = -1
        self._recent: OrderedDict[int, int] = OrderedDict()

    def is_repeated(self, sequence: int, data: bytes) -> bool:
        if sequence <= self._newest and self._recent.get(sequence) == hash(data):
            return True
        self._newest = max(self._newest, sequence)
        self._recent[sequence] = hash(data)
        if len(self._recent) > _RECENT:
            self._recent.popitem(last=False)
        return False


@dataclass
class _Channel:
    sides: tuple[_Side, _Side] = field(default_factory=lambda: (_Side(), _Side()))
    place: int = 0
    difference: Difference | None = None
    sought: tuple[int, int] | None = None
    """Side and sequence number of the message found missing: it may turn up later."""

    def advance(self, name: str) -> int:
        """Matches the next message of both sides, if both have one; returns how many were equal."""
        a, b = self.sides[0].waiting, self.sides[1].waiting
        if not a or not b:
            return 0
        self.place += 1
        if a[0] == b[0]:
            a.popleft()
            b.popleft()
            return 1
        self._differ(name, a[0], b[0])
        return 0

    def look_for(self, side: int, sequence: int | None) -> None:
        if self.difference and (side, sequence) == self.sought:
            self.difference, self.sought = self.difference.found_later(), None

    def end(self, name: str) -> Difference | None:
        """Returns the first difference of the channel once a log has ended: waiting messages have no match."""
        for lacking, side in ((1, self.sides[0]), (0, self.sides[1])):
            if not self.difference and side.waiting:
                reason = "missing" if self.place else "missing, as is the whole channel"
                self._settle(missing(name, side.waiting[0], self.place + 1, lacking, reason))
        return self.difference

    def _differ(self, name: str, a: bytes, b: bytes) -> None:
        heads = header_of(a), header_of(b)
        if heads[0] is None or heads[1] is None or heads[0].sequence == heads[1].sequence:
            self._settle(changed(name, a, b, self.place))
            return
        lacking = int(heads[0].sequence < heads[1].sequence)
        data, sequence = (a, heads[0].sequence) if lacking else (b, heads[1].sequence)
        there_later = any(sequence_of(waiting) == sequence for waiting in self.sides[lacking].waiting)
        self.sought = lacking, sequence
        self._settle(missing(name, data, self.place, lacking))
        if there_later:
            self.look_for(lacking, sequence)

    def _settle(self, difference: Difference) -> None:
        self.difference = difference
        for side in self.sides:
            side.waiting.clear()


def _counts(channel: str) -> bool:
    return channel != _SELF_TEST and not channel.startswith(FRAMEWORK)


def _common_ranges(readers: Iterable[StampedLog]) -> dict[str, tuple[int, int]]:
    """Returns the first and last sequence number that both logs contain, by channel."""
    ranges: list[dict[str, tuple[int, int]]] = []
    for reader in readers:
        found: dict[str, tuple[int, int]] = {}
        for event in reader:
            head = header_of(event.data)
            if head and _counts(event.channel):
                first, last = found.get(event.channel, (head.sequence, head.sequence))
                found[event.channel] = min(first, head.sequence), max(last, head.sequence)
        ranges.append(found)
    a, b = ranges
    both = {name: (max(a[name][0], b[name][0]), min(a[name][1], b[name][1])) for name in a if name in b}
    return {name: (first, last) for name, (first, last) in both.items() if first <= last}


def _names(a: Path, b: Path) -> tuple[str, str]:
    return (a.name, b.name) if a.name != b.name else (str(a), str(b))
