"""LCM event logs, the files of lcm-logger and lcm-logplayer; damaged files stay readable."""

import fcntl
import os
import struct
from collections.abc import Callable, Iterator
from io import FileIO
from pathlib import Path
from types import TracebackType
from typing import NamedTuple, Self

from fwk.lcm.disk import has_room
from fwk.lcm.log_file import LogError, locked
from fwk.lcm.log_parts import SYNC, LogBytes, part_path, remove_parts

__all__ = ["SYNC", "Event", "LogError", "LogReader", "LogWriter"]

_HEAD = struct.Struct(">IqqII")  # sync word, event number, time in µs, length of the channel, length of the data
_CHANNEL_MAX = 999  # the limit of LCM's own reader; on the wire it is 63
_DATA_MAX = 256 << 20  # LCM's largest message
_WINDOW_BYTES = 1 << 20


class Event(NamedTuple):
    """A message of a log."""

    number: int
    """Number of the event, from 0; a gap means that the writer dropped events."""
    time_us: int
    """Logical time in recordings of this framework, time of receipt in logs of lcm-logger, in us."""
    channel: str
    data: bytes
    in_envelope: bool = False
    """Whether `data` is a message of a type without the header, joined with its stamp."""


class LogWriter:
    """Writes a log that lcm-logplayer plays; an existing log is replaced, with all its parts.

    While the disk is full, events are dropped and counted in `dropped`; `report` gets a message when this begins and
    when writing continues, so a recording never stops the run. If another program shortens the file, `report` gets a
    message, and the log goes on at the new end. However the writer ends, the file is readable up to the last `flush`.

    Raises:
        LogError: the file cannot be created.
    """

    def __init__(self, path: Path, report: Callable[[str], None], buffer_bytes: int = 256 << 10) -> None:
        self.path = path
        self.dropped = 0
        self.cut_bytes = 0
        """Size of what another program has cut off the newest part."""
        self.events = 0
        """Number of appended events, including dropped ones."""
        self._report = report
        self._full = False
        self._buffer = bytearray()
        self._buffered = 0
        self._buffer_bytes = buffer_bytes
        self._good_bytes = 0  # length of the newest part up to its last whole event
        self._earlier_bytes = 0  # of the parts before
        self._parts = 1
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            if path.is_fifo():  # opening it would block until a program reads
                raise LogError(f"{path}: cannot write a log there: a pipe cannot be read again; use a file")
            remove_parts(path)
            self._file = _opened(path)
        except OSError as error:
            raise LogError(f"{path}: cannot write a log there: {error.strerror}") from error

    def append(self, channel: str, data: bytes, time_us: int) -> None:
        """Adds an event, which reaches the file when the buffer is full or at the next `flush`.

        Raises:
            ValueError: the channel's name is empty or too long, or the message larger than any LCM message.
        """
        name = channel.encode()
        if not 1 <= len(name) <= _CHANNEL_MAX or len(data) > _DATA_MAX:
            raise ValueError(f"{self.path}: not an LCM event: channel {channel[:80]!r}, {len(data)} bytes")
        self._buffer += _HEAD.pack(0xEDA1DA01, self.events, time_us, len(name), len(data))
        self._buffer += name
        self._buffer += data
        self._buffered += 1
        self.events += 1
        if len(self._buffer) >= self._buffer_bytes:
            self.flush()

    def flush(self) -> None:
        """Passes all appended events to the operating system."""
        self._check_size()
        if not self._buffered:
            return
        data, events = self._buffer, self._buffered
        self._buffer, self._buffered = bytearray(), 0  # first, because the report may be recorded itself
        if self._full and not has_room(self.path):
            self.dropped += events
        else:
            self._write(data, events)

    def split(self) -> Path | None:
        """Ends the newest part and begins the next one; returns the finished file.

        Without room for a further file, the newest goes on, and None is returned.
        """
        self.flush()
        try:
            following = _opened(part_path(self.path, self._parts))
        except OSError:
            return None
        self._file.close()
        self._file = following
        self._earlier_bytes += self._good_bytes
        self._good_bytes = 0
        self._parts += 1
        return part_path(self.path, self._parts - 2)

    @property
    def newest_part(self) -> Path:
        """The file that is written."""
        return part_path(self.path, self._parts - 1)

    @property
    def size_bytes(self) -> int:
        """Size of the log with the events that have not reached the file yet, without dropped ones."""
        return self._earlier_bytes + self.part_bytes

    @property
    def part_bytes(self) -> int:
        """Size of the newest part, likewise."""
        return self._good_bytes + len(self._buffer)

    def written(self, data: bytearray) -> None:
        """Is called with each piece of whole events that has reached the file; for subclasses."""

    def close(self) -> None:
        """Writes the rest and closes the file; further calls have no effect."""
        if not self._file.closed:
            self.flush()
            self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def _check_size(self) -> None:
        size_bytes = os.fstat(self._file.fileno()).st_size
        if size_bytes < self._good_bytes:
            cut_bytes, self._good_bytes = self._good_bytes - size_bytes, size_bytes
            self._file.seek(size_bytes)
            self.cut_bytes += cut_bytes
            self._report(f"{self.newest_part}: another program has cut {cut_bytes} bytes off the recording")

    def _write(self, data: bytearray, events: int) -> None:
        rest = memoryview(data)
        try:
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError as error:
            self._drop(error, events)
            return
        self._good_bytes += len(data)
        self.written(data)
        if self._full:
            self._full = False
            self._report(f"{self.path}: the disk has room again; {self.dropped} messages are missing in the recording")

    def _drop(self, error: OSError, events: int) -> None:
        self.dropped += events
        try:  # remove the torn event, so that later events follow whole ones
            self._file.truncate(self._good_bytes)
            self._file.seek(self._good_bytes)
        except OSError:
            self._good_bytes = self._file.tell()  # readers find the next whole event
        if not self._full:
            self._full = True
            self._report(
                f"{self.path}: cannot record: {error.strerror}; the run goes on; messages are missing in "
                "the recording until the disk has room again"
            )


def _opened(path: Path) -> FileIO:
    """Opens a file of a log for writing, with a lock that tells other programs so."""
    file = open(path, "wb", buffering=0)  # noqa: SIM115 - closed by the writer
    locked(file.fileno(), fcntl.LOCK_SH)
    return file


class LogReader:
    """Iterates over the events of any LCM log and all its parts, any number of times.

    Damage costs only the events that it touches: an event counts if another event or the end of the file follows it.
    Reading continues at the next whole event, and `skipped_bytes` counts the bytes that the newest iteration skipped.

    Raises:
        LogError: the log does not exist, is not an ordinary file, or cannot be read.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self.skipped_bytes = 0
        self.position = 0
        """End of the newest event of the newest iteration, in bytes from the beginning of the log; before the first
        event the begin of the iteration.
        """
        LogBytes(path).close()  # raises if it cannot be read

    @property
    def size_bytes(self) -> int:
        """Size of all parts of the log together, as it is now."""
        with LogBytes(self.path) as log:
            return log.size_bytes

    def check_any(self) -> None:
        """Checks after a whole iteration that the file is a log at all, and whole in its first event.

        Raises:
            LogError: the iteration found no event, but bytes.
        """
        if self.position or not self.skipped_bytes:
            return
        with LogBytes(self.path) as log:
            begun = log.read(0, len(SYNC)) == SYNC
        reason = "cut off within its first event" if begun else "not an LCM log: no event in it"
        raise LogError(f"{self.path}: {reason}; it has {self.skipped_bytes} bytes")

    def __iter__(self) -> Iterator[Event]:
        return self.events_from(0)

    def events_from(self, position: int) -> Iterator[Event]:
        """Yields the events from a byte of the log on, such as a former `position`."""
        self.skipped_bytes, self.position = 0, position
        with LogBytes(self.path) as log:
            window = _Window(log)
            while position < window.file_bytes:
                found = self._event(window, position)
                if found:
                    event, position = found
                    self.position = position
                    yield event
                else:
                    following = window.find_sync(position + 1)
                    self.skipped_bytes += following - position
                    position = following

    def _event(self, window: "_Window", position: int) -> tuple[Event, int] | None:
        head = window.read(position, _HEAD.size)
        if len(head) < _HEAD.size or not head.startswith(SYNC):
            return None
        _, number, time_us, channel_bytes, data_bytes = _HEAD.unpack(head)
        body = position + _HEAD.size
        end = body + channel_bytes + data_bytes
        if not 1 <= channel_bytes <= _CHANNEL_MAX or data_bytes > _DATA_MAX or end > window.file_bytes:
            return None
        if not SYNC.startswith(window.peek(end)):
            return None
        content = window.read(body, channel_bytes + data_bytes)
        if len(content) < channel_bytes + data_bytes:  # the file shrank while it was read
            return None
        channel = content[:channel_bytes].decode("utf-8", "backslashreplace")
        return Event(number, time_us, channel, content[channel_bytes:]), end


class _Window:
    """Reads a log through a buffer that moves forward; looking far ahead does not move it."""

    def __init__(self, log: LogBytes) -> None:
        self.file_bytes = log.size_bytes
        self._log = log
        self._start = 0
        self._bytes = b""

    def read(self, offset: int, size: int) -> bytes:
        begin = offset - self._start
        if begin < 0 or begin + size > len(self._bytes):
            self._start, begin = offset, 0
            self._bytes = self._log.read(offset, max(size, _WINDOW_BYTES))
        return self._bytes[begin : begin + size]

    def peek(self, offset: int) -> bytes:
        """Returns the next four bytes, fewer at the end of the log."""
        begin = offset - self._start
        if begin + 4 <= len(self._bytes):
            return self._bytes[begin : begin + 4]
        return self._log.read(offset, 4)

    def find_sync(self, offset: int) -> int:
        """Returns the position of the next sync word, or the end of the log."""
        while offset < self.file_bytes:
            if len(self.read(offset, 4)) < 4:
                break
            found = self._bytes.find(SYNC, offset - self._start)
            if found >= 0:
                return self._start + found
            offset = self._start + len(self._bytes) - 3
        return self.file_bytes
