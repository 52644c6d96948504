"""Writes logs together with their index."""

import zlib
from collections.abc import Callable
from pathlib import Path

from fwk.lcm.envelope import STAMP
from fwk.lcm.event_log import LogWriter
from fwk.lcm.messages import Header
from fwk.lcm.stamped_log import stamp_in
from fwk.recording.log_contents import ChannelInfo, LogInfo, Note, note_in, type_names, whole_header
from fwk.recording.log_index import BLOCK_BYTES, Block, LogIndex, index_path
from fwk.recording.ticks import tick_of
from fwk.recording.versions import RECORD
from lcmtypes.core import header_t


class IndexedLogWriter(LogWriter):
    """Writes a log, and its index when the log is closed; a log that lacks events gets no index.

    Raises:
        LogError: the file cannot be created.
    """

    def __init__(self, path: Path, report: Callable[[str], None]) -> None:
        super().__init__(path, report)
        index_path(path).unlink(missing_ok=True)
        self._channels: dict[str, _Counted] = {}
        self._notes: list[Note] = []
        self._stamp = self._record = b""
        self._time_us = 0
        self._blocks: list[Block] = []
        self._begin = self._end = self._crc32 = 0  # of the block that grows

    def append(self, channel: str, data: bytes, time_us: int) -> None:
        """Adds an event, which reaches the file when the buffer is full or at the next `flush`.

        Raises:
            ValueError: the channel's name is empty or too long, or the message larger than any LCM message.
        """
        counted = self._channels.get(channel)
        if counted is None:
            counted = self._channels[channel] = _Counted(data, self._stamp, time_us)
        counted.messages += 1
        counted.bytes += len(data)
        counted.last, counted.last_stamp = data, self._stamp
        if time_us > counted.last_us:
            counted.last_us = time_us
        elif time_us < counted.first_us:
            counted.first_us = time_us
        if data[:8] != counted.mark:
            counted.mark = data[:8]
            counted.kinds.setdefault(counted.mark, data)
        self._time_us, self._stamp = time_us, b""
        if channel == RECORD:
            self._record = data
        elif channel == STAMP:
            self._stamp = data
        elif note := note_in(channel, data):
            self._notes.append(note)
        super().append(channel, data, time_us)

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
        if self.dropped or not self._end:
            return
        if self._end > self._begin:
            self._end_block()
        found = self.path.stat()
        LogIndex(self._info(found.st_size), found.st_mtime_ns, self._blocks).write()

    def _end_block(self) -> None:
        tick = tick_of(RECORD, self._record) or 0
        self._blocks.append(Block(self._end, self._crc32, tick, self._time_us))
        self._begin, self._crc32 = self._end, 0

    def _info(self, size_bytes: int) -> LogInfo:
        counted = self._channels.values()
        info = LogInfo(self.path, size_bytes, sum(each.messages for each in counted), notes=self._notes)
        info.first_us = min(each.first_us for each in counted)
        info.last_us = max(each.last_us for each in counted)
        info.dropped = self.events - info.events
        info.channels = {name: self._channels[name].info() for name in sorted(self._channels)}
        return info


class _Counted:
    """Figures of a channel."""

    __slots__ = (
        "bytes",
        "first",
        "first_stamp",
        "first_us",
        "kinds",
        "last",
        "last_stamp",
        "last_us",
        "mark",
        "messages",
    )

    def __init__(self, data: bytes, stamp: bytes, time_us: int) -> None:
        self.messages = self.bytes = 0
        self.first = self.last = data
        self.first_stamp = self.last_stamp = stamp
        self.first_us = self.last_us = time_us
        self.mark = data[:8]
        self.kinds = {self.mark: data}  # fingerprint to the first message with it

    def info(self) -> ChannelInfo:
        types = [type_names(data) for data in self.kinds.values()]
        made = ChannelInfo(
            types, messages=self.messages, bytes=self.bytes, first_us=self.first_us, last_us=self.last_us
        )
        heads = _header(self.first, self.first_stamp), _header(self.last, self.last_stamp)
        if heads[0] and heads[1]:
            made.writers = list(dict.fromkeys(head.writer for head in heads if head))
            made.first_tick, made.last_tick = heads[0].tick, heads[1].tick
            lacking = heads[1].sequence - heads[0].sequence + 1 - self.messages
            made.lost, made.repeated = max(0, lacking), max(0, -lacking)
        return made


def _header(data: bytes, stamp: bytes) -> Header | header_t | None:
    """Returns the header of a message, or of the stamp before it."""
    found = stamp_in(stamp) if stamp else None
    return found.header if found else whole_header(data)
