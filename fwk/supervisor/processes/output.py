"""Standard output and error of host processes, line by line into the log."""

import os

from fwk.component.log import Logger
from fwk.component.rate_limit import RateLimit
from fwk.supervisor.event_loop import EventLoop
from lcmtypes.core import log_t

_LINE_MAX = 4096
_CHUNK = 65536


class CapturedStream:
    """Reads one stream of a process and logs its lines under the process's name, with the stream and line as place.

    Lines above the limit are read, counted and dropped, so that a process that prints too much is not held up.
    """

    def __init__(self, descriptor: int, events: EventLoop, log: Logger, limit: RateLimit, stream: str, level: int):
        self._descriptor = descriptor
        self._events = events
        self._log = log
        self._limit = limit
        self._stream = stream
        self._level = level
        self._lines = 0
        self._rest = b""
        self._waits = b""  # part of it that was there at the last call
        self.open = True
        os.set_blocking(descriptor, False)
        events.watch(descriptor, self._read)

    def look(self) -> None:
        """Called repeatedly: logs an incomplete line that is older than one call, and reports dropped lines."""
        if self._rest and self._rest == self._waits:
            self._write(self._rest, self._lines + 1)
            self._rest = b""
        self._waits = self._rest
        self._tell_dropped()

    def _tell_dropped(self) -> None:
        """Reports how many lines were dropped, once that second is over or the stream has ended."""
        dropped = self._limit.dropped() if self.open else self._limit.rest()
        if dropped:
            text = f"{dropped} lines dropped in the last second: more than {self._limit.per_s}"
            self._log.write(self._level, text, self._stream, self._lines)

    def _read(self) -> None:
        try:
            data = os.read(self._descriptor, _CHUNK)
        except BlockingIOError:
            return
        lines = (self._rest + data).split(b"\n")
        self._rest = lines.pop()
        if len(self._rest) > _LINE_MAX or not data:
            lines.append(self._rest)
            self._rest = b""
        for number, line in enumerate(lines, 1):
            if not line:
                continue
            if not self._limit.passes():
                self._limit.drop(sum(map(bool, lines[number - 1 :])))
                break
            self._write(line, self._lines + number)
        self._lines += len(lines)
        if not data:
            self.open = False
            self._events.unwatch(self._descriptor)
            os.close(self._descriptor)
        self._tell_dropped()

    def _write(self, line: bytes, number: int) -> None:
        self._log.write(self._level, _text(line), self._stream, number)


class CapturedOutput:
    """Standard output and error of all host processes."""

    def __init__(self, events: EventLoop, log: Logger, lines_per_s: int) -> None:
        self._events = events
        self._log = log
        self._lines_per_s = lines_per_s
        self._streams: list[CapturedStream] = []

    def listen(self, name: str, output: int, errors: int) -> None:
        """Logs what the process `name` writes to its standard output and error."""
        log = self._log.named(name)
        for descriptor, stream, level in ((output, "stdout", log_t.INFO), (errors, "stderr", log_t.WARNING)):
            self._streams.append(
                CapturedStream(descriptor, self._events, log, RateLimit(self._lines_per_s), stream, level)
            )

    def look(self) -> None:
        """Called repeatedly: logs incomplete lines and reports dropped ones."""
        for each in self._streams:
            each.look()
        self._streams = [each for each in self._streams if each.open]


def _text(line: bytes) -> str:
    text = line[:_LINE_MAX].decode(errors="backslashreplace")
    return text if len(line) <= _LINE_MAX else f"{text} ... {len(line) - _LINE_MAX} bytes left out"
