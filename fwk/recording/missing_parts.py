"""Names the parts that a log of several files lacks, with the ticks around them."""

from collections.abc import Iterable
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

from fwk.lcm.event_log import Event, LogReader
from fwk.lcm.log_parts import LogBytes, MissingFiles
from fwk.recording.ticks import tick_of

_TAIL_BYTES = 1 << 20


@dataclass(frozen=True)
class MissingParts:
    """Files of a log that are missing between others."""

    files: list[str]
    events: int
    """Number of the missing events, by the numbers of the others."""
    after_tick: int | None
    """Newest tick that the log names before them; None: it names none."""
    before_tick: int | None
    """First tick that the log names after them."""

    def __str__(self) -> str:
        names = self.files[0] if len(self.files) == 1 else f"{self.files[0]} to {self.files[-1]}"
        verb = "is" if len(self.files) == 1 else "are"
        ticks = "" if self.after_tick is None else f" between tick {self.after_tick} and tick {self.before_tick}"
        return f"{names} {verb} missing: {self.events} events{ticks}"


def missing_parts(log: Path) -> list[MissingParts]:
    """Returns the parts that a log lacks; reads only the surroundings of each.

    Raises:
        LogError: the log cannot be read.
    """
    with LogBytes(log) as data:
        found = data.missing
    return [_described(LogReader(log), each) for each in found]


def _described(reader: LogReader, missing: MissingFiles) -> MissingParts:
    before = _before(reader, max(0, missing.position - _TAIL_BYTES), missing.position)
    if not before and missing.position > _TAIL_BYTES:  # a part of one large event
        before = _before(reader, 0, missing.position)
    last = before[-1].number if before else -1
    after = reader.events_from(missing.position)
    following = next(after, None)
    events = following.number - last - 1 if following else 0
    before_tick = _first_tick(chain([following], after)) if following else None
    return MissingParts([str(file) for file in missing.files], events, _first_tick(reversed(before)), before_tick)


def _before(reader: LogReader, begin: int, end: int) -> list[Event]:
    found = []
    for event in reader.events_from(begin):
        if reader.position > end:
            break
        found.append(event)
    return found


def _first_tick(events: Iterable[Event]) -> int | None:
    return next(filter(None, (tick_of(event.channel, event.data) for event in events)), None)
