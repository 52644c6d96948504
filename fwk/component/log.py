"""The logging aspect: lines of text with component, tick, times and source line."""

import sys
import sysconfig
import traceback
from collections.abc import Callable
from functools import cache
from pathlib import Path

from fwk.clock import US_PER_S, Clock, sleep_s, wall_us
from fwk.component.rate_limit import RateLimit
from lcmtypes.core import log_t

LEVELS = {"debug": log_t.DEBUG, "info": log_t.INFO, "warning": log_t.WARNING, "error": log_t.ERROR}
LEVEL_NAMES = {number: name for name, number in LEVELS.items()}

Text = str | Callable[[], str]
"""Text to log, or a function that makes it if the level is on: `log.debug(lambda: f"{len(found)} points")`."""

TIME_MAX_US = 250_000_000_000 * US_PER_S
"""Latest wall time of a log line, in the last year that calendars can express."""
_BEGIN, _END = 12_000, 4_000  # characters kept of a text that is too long for one datagram (64 kB in UTF-8)
_BREATH_S = 0.001
_LIBRARIES = [sysconfig.get_path(name) + "/" for name in ("stdlib", "purelib", "platlib")]
_NOT_OWN = ("<", str(Path(__file__).parent.parent) + "/", *_LIBRARIES)
"""Path prefixes of code that belongs to no component: generated code, the framework, libraries."""


def is_plausible(line: log_t) -> bool:
    """Returns whether a line from elsewhere has a level that exists, and times that can be shown."""
    return line.level in LEVEL_NAMES and 0 <= line.wall_us < TIME_MAX_US and abs(line.time_us) < TIME_MAX_US


def own_frame(error: BaseException) -> traceback.FrameSummary | None:
    """Returns the innermost frame of an error outside the framework and the libraries, else the innermost one.

    None if there was no memory for the traceback.
    """
    frames = traceback.extract_tb(error.__traceback__)
    own = [frame for frame in frames if not frame.filename.startswith(_NOT_OWN)] or frames
    return own[-1] if own else None


class Logger:
    """Writes lines to the targets of the run's log: console, files, buses.

    Lines below `level` cost next to nothing. Lines above the `limit` are dropped; at the end of that second a line
    gives their number. Errors are never dropped: too many of them slow the component down to a thousand a second.
    """

    def __init__(
        self,
        component: str,
        clock: Clock,
        sink: Callable[[log_t], None],
        level: int = log_t.INFO,
        limit: RateLimit | None = None,
    ) -> None:
        self.component = component
        self.level = level
        self._clock = clock
        self._sink = sink
        self._limit = limit or RateLimit(0)
        self._dropped_at = ("", 0)

    def debug(self, text: Text) -> None:
        """Logs a detail that helps to develop the component."""
        if self.level <= log_t.DEBUG:
            self._write(log_t.DEBUG, text)

    def info(self, text: Text) -> None:
        """Logs a rare event of normal operation."""
        if self.level <= log_t.INFO:
            self._write(log_t.INFO, text)

    def warning(self, text: Text) -> None:
        """Logs an abnormal condition that the component can handle."""
        if self.level <= log_t.WARNING:
            self._write(log_t.WARNING, text)

    def error(self, text: Text) -> None:
        """Logs the failure of something that the component should do."""
        self._write(log_t.ERROR, text)

    def exception(self, text: str, error: BaseException) -> None:
        """Logs an error with its traceback.

        The source line is the innermost one outside the framework and the libraries, such as the component's `write()`
        of a value that the message cannot hold.
        """
        frame = own_frame(error)
        place = (short_path(frame.filename), frame.lineno or 0) if frame else ("", 0)
        self.write(log_t.ERROR, f"{text}\n{''.join(traceback.format_exception(error)).rstrip()}", *place)

    def write(self, level: int, text: str, file: str, line_number: int) -> None:
        """Logs a line with a given source line, such as `stdout:7`."""
        passes = self._limit.passes()
        self._report_dropped()
        if not passes:
            if level < log_t.ERROR:
                self._dropped_at = (file, line_number)
                self._limit.drop()
                return
            sleep_s(_BREATH_S)
        self._emit(level, text, file, line_number)

    def named(self, component: str) -> "Logger":
        """Returns a logger without a limit for another component that has no logger."""
        return Logger(component, self._clock, self._sink)

    def _report_dropped(self, at_the_end: bool = False) -> None:
        """Logs how many lines were dropped, once that second is over or `at_the_end`."""
        dropped = self._limit.rest() if at_the_end else self._limit.dropped()
        if dropped:
            text = f"{dropped} lines dropped in the last second, the newest from here: more than {self._limit.per_s}"
            self._emit(log_t.WARNING, text, *self._dropped_at)

    def _write(self, level: int, text: Text) -> None:
        caller = sys._getframe(2)
        self.write(level, text() if callable(text) else text, short_path(caller.f_code.co_filename), caller.f_lineno)

    def _emit(self, level: int, text: str, file: str, line_number: int) -> None:
        line = log_t()
        line.level = level
        line.component = self.component
        line.tick = self._clock.tick
        line.time_us = self._clock.now_us
        line.wall_us = wall_us()
        line.file = file
        line.line = line_number
        line.text = _sendable(text)
        self._sink(line)


def _sendable(text: object) -> str:
    """Returns the text as it is sent: small enough for one datagram, without zero bytes and lone surrogates."""
    made = str(text)
    if len(made) > _BEGIN + _END:
        left_out = len(made) - _BEGIN - _END
        made = f"{made[:_BEGIN]} ... {left_out} characters left out ... {made[-_END:]}"
    return made.encode(errors="backslashreplace").decode().replace("\0", "\\0")


@cache
def short_path(path: str) -> str:
    """Returns the path of a source file below the folder it is imported from: `drivers/camera.py`."""
    folders = [folder for folder in sys.path if folder and path.startswith(f"{folder.rstrip('/')}/")]
    return path[len(max(folders, key=len).rstrip("/")) + 1 :] if folders else path.rpartition("/")[2]
