"""Places of the ticks in the log of a recording, found without reading all of it; the run may go on."""

from pathlib import Path

from fwk.lcm.event_log import Event, LogError, LogReader
from fwk.logs.json_lines import FILE
from fwk.logs.reader import read_lines
from fwk.model.names import NOTE
from fwk.recording.log_contents import ChannelInfo, LogInfo, Note, whole_header
from fwk.recording.log_index import LogIndex
from fwk.recording.log_info import log_info
from fwk.recording.ticks import tick_of
from fwk.recording.versions import PLAN, RECORD

_SMALL_BYTES = 4 << 20
"""Up to this size a log is read as a whole: a fraction of a second."""
_END_BYTES = 1 << 20
"""Size of the parts at the beginning and at the end that tell the channels of a larger log."""
_NEAR_BYTES = 1 << 18
"""Up to this distance the end of a tick is looked for event by event."""


class RecordedTicks:
    """Where ticks begin: after the record of the tick before. Each search reads a few parts of the log.

    Raises:
        LogError: the log cannot be read, or has no message.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._reader = LogReader(path)
        first = next(self._reader.events_from(0), None)
        if first is None:
            raise LogError(f"{path}: no message in it")
        self.plan: bytes | None = first.data if first.channel == PLAN else None
        """The encoded plan; None: the log does not begin with one."""
        self.begin = self._reader.position if self.plan else 0
        """Position of the first tick in the log."""
        self._found: dict[int, int] = {1: self.begin}

    def position(self, tick: int) -> int | None:
        """Returns where a tick, or the first one after it, begins, in bytes; None: its tick before has not ended."""
        if tick not in self._found:
            found = self._end_of(tick - 1)
            if found is None:
                return None
            self._found[tick] = found
        return self._found[tick]

    def tail(self) -> list[Event]:
        """Returns the last events of the log; a whole tick is among them if the log has any."""
        size_bytes, span_bytes = self._reader.size_bytes, _END_BYTES
        while True:
            start = max(0, size_bytes - span_bytes)
            events = list(self._reader.events_from(start))
            if not start or sum(event.channel == RECORD for event in events) > 1:
                return events
            span_bytes *= 4

    def _end_of(self, tick: int) -> int | None:
        """Returns the position of the end of the first record of at least this tick, by bisection."""
        low, high = self.begin, self._reader.size_bytes
        while high - low > _NEAR_BYTES:
            middle = (low + high) // 2
            found = self._record_from(middle)
            if found and found[0] < tick:
                low = found[1]
            elif found and found[0] == tick:
                return found[1]
            else:
                high = middle
        return (self._record_from(low, tick) or (0, None))[1]

    def _record_from(self, position: int, least: int = 0) -> tuple[int, int] | None:
        """Returns tick and end of the first record of at least a tick that begins after a position."""
        for event in self._reader.events_from(position):
            tick = tick_of(event.channel, event.data) if event.channel == RECORD else None
            if tick is not None and tick >= least:
                return tick, self._reader.position
        return None


def contents(path: Path) -> LogInfo:
    """Returns the contents of a log: of a large one without an index, such as that of a run that goes on, only the
    ticks, and the channels of its beginning and its end; numbers of messages are then the sequence numbers.

    Raises:
        LogError: the file cannot be read or is not a log.
    """
    reader = LogReader(path)
    index = LogIndex.of(path)
    ticks = RecordedTicks(path)
    if (index and index.is_current()) or reader.size_bytes <= _SMALL_BYTES or ticks.plan is None:
        return log_info(path)
    info = LogInfo(path, size_bytes=reader.size_bytes, notes=_notes(path.parent))
    for event in reader.events_from(0):
        _take(info, event)
        if reader.position > _END_BYTES and event.channel == RECORD:
            break
    for event in ticks.tail():
        _take(info, event)
        info.events = event.number + 1
    info.channels = dict(sorted(info.channels.items()))
    return info


def _take(info: LogInfo, event: Event) -> None:
    channel = info.channels.setdefault(event.channel, ChannelInfo())
    channel.add(event)
    header = whole_header(event.data)
    channel.messages = max(channel.messages, header.sequence if header else 0)
    channel.bytes = channel.lost = 0
    info.last_us = max(info.last_us, event.time_us)


def _notes(folder: Path) -> list[Note]:
    """Returns the bookmarks in the log lines of a run."""
    try:
        lines = list(read_lines(folder / FILE))
    except OSError:
        return []
    return [Note(line["tick"], line["time_us"], line["text"]) for line in lines if line["file"] == NOTE]
