"""Writes logs together with their index."""

import zlib
from collections import defaultdict
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path

from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import LogWriter
from fwk.lcm.log_file import existing
from fwk.lcm.log_parts import LogBytes
from fwk.lcm.messages import Header
from fwk.lcm.stamped_log import stamp_in
from fwk.recording.log_contents import (
    LOG_LINES,
    ChannelInfo,
    LogInfo,
    Note,
    excerpt_in,
    note_in,
    type_names,
    whole_header,
)
from fwk.recording.log_index import BLOCK_BYTES, Block, LogIndex, index_path
from fwk.recording.ticks import tick_of
from fwk.recording.versions import EXCERPT, RECORD
from lcmtypes.core import header_t

_Messages = list[tuple[bytes, int]]
"""Messages of a channel with their time stamps in us."""


class IndexedLogWriter(LogWriter):
    """Writes a log, and its index when the log is closed; a log that lacks events gets no index.

    Raises:
        LogError: the file cannot be created.
    """

    def __init__(self, path: Path, report: Callable[[str], None]) -> None:
        super().__init__(path, report)
        with suppress(OSError):  # the index of a log that was here before; it does not fit the new one anyway
            index_path(path).unlink(missing_ok=True)
        self._appended: defaultdict[str, _Messages] = defaultdict(list)  # since the last flush
        self._channels: defaultdict[str, _Counted] = defaultdict(_Counted)
        self._stamps: dict[str, list[header_t]] = {}
        self._notes: list[Note] = []
        self._excerpt = ""
        self._record = b""
        self._time_us = 0
        self._blocks: list[Block] = []
        self._begin = self._end = self._crc32 = 0  # of the block that grows

    def append(self, channel: str, data: bytes, time_us: int) -> None:
        """Adds an event, which reaches the file when the buffer is full or at the next `flush`.

        Raises:
            ValueError: the channel's name is empty or too long, or the message larger than any LCM message.
        """
        self._appended[channel].append((data, time_us))
        super().append(channel, data, time_us)

    def flush(self) -> None:
        """Passes all appended events to the operating system."""
        for channel, messages in self._appended.items():
            self._channels[channel].add(messages)
            self._time_us = max(self._time_us, messages[-1][1])
            if channel == RECORD:
                self._record = messages[-1][0]
            elif channel == STAMP:
                self._take_stamps(messages)
            elif channel == EXCERPT:
                self._excerpt = excerpt_in(channel, messages[-1][0])
            elif channel == LOG_LINES:
                self._notes += filter(None, (note_in(channel, data) for data, _ in messages))
        self._appended.clear()
        super().flush()

    def written(self, data: bytearray) -> None:
        """Adds a piece of the file to the check sums."""
        self._crc32 = zlib.crc32(data, self._crc32)
        self._end += len(data)
        if self._end - self._begin >= BLOCK_BYTES:
            self._end_block()

    def close(self) -> None:
        """Writes the rest, closes the file and writes the index; further calls have no effect."""
        if self._file.closed:
            return
        super().close()
        first = existing(self.path)  # may have been compressed by now
        if self.dropped or self.cut_bytes or not self._end or not first or not first.is_file():
            return
        if self._end > self._begin:
            self._end_block()
        with LogBytes(self.path) as log:
            LogIndex(self._info(log.size_bytes), log.mtime_ns, self._blocks).write()

    def _take_stamps(self, messages: _Messages) -> None:
        """Keeps the first and the newest stamp of each channel."""
        for data, _ in messages:
            if stamp := stamp_in(data):
                self._stamps[stamp.channel] = [*self._stamps.get(stamp.channel, ())[:1], stamp.header]

    def _end_block(self) -> None:
        tick = tick_of(RECORD, self._record) or 0
        self._blocks.append(Block(self._end, self._crc32, tick, self._time_us))
        self._begin, self._crc32 = self._end, 0

    def _info(self, size_bytes: int) -> LogInfo:
        counted = self._channels.values()
        info = LogInfo(self.path, size_bytes, sum(each.messages for each in counted), notes=self._notes)
        info.excerpt = self._excerpt
        info.first_us = min(each.first_us for each in counted)
        info.last_us = max(each.last_us for each in counted)
        info.dropped = self.events - info.events
        info.channels = {name: self._channels[name].info(self._stamps.get(name)) for name in sorted(self._channels)}
        return info


class _Counted:
    """Figures of a channel."""

    def __init__(self) -> None:
        self.messages = self.bytes = self.first_us = self.last_us = 0
        self._first = self._last = b""
        self._kinds: dict[bytes, bytes] = {}  # fingerprint to a message with it

    def add(self, messages: _Messages) -> None:
        """Counts messages."""
        contents, times = zip(*messages, strict=True)
        if not self.messages:
            self._first, self.first_us, self.last_us = contents[0], times[0], times[0]
        self._last = contents[-1]
        self.messages += len(contents)
        self.bytes += sum(map(len, contents))
        self.first_us, self.last_us = min(self.first_us, *times), max(self.last_us, *times)
        self._kinds = {data[:8]: data for data in contents} | self._kinds

    def info(self, stamps: list[header_t] | None) -> ChannelInfo:
        """Returns the figures; `stamps` has the headers of messages whose type has none, of the first and the last."""
        types = [type_names(data) for data in self._kinds.values()]
        made = ChannelInfo(
            types, messages=self.messages, bytes=self.bytes, first_us=self.first_us, last_us=self.last_us
        )
        first: Header | header_t | None
        last: Header | header_t | None
        first, last = (stamps[0], stamps[-1]) if stamps else (whole_header(self._first), whole_header(self._last))
        if first and last:
            made.writers = list(dict.fromkeys((first.writer, last.writer)))
            made.first_tick, made.last_tick = first.tick, last.tick
            lacking = last.sequence - first.sequence + 1 - self.messages
            made.lost, made.repeated = max(0, lacking), max(0, -lacking)
        return made
