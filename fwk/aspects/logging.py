"""The logging aspect: lines of text that carry component, tick, times and place."""

import sys
from collections.abc import Callable

from fwk.clock import Clock, wall_us
from lcmtypes.core import log_t

LEVELS = {"debug": log_t.DEBUG, "info": log_t.INFO, "warning": log_t.WARNING, "error": log_t.ERROR}
LEVEL_NAMES = {number: name for name, number in LEVELS.items()}


class Logger:
    """Writes lines to wherever the system's log goes: console, file, bus."""

    def __init__(self, component: str, clock: Clock, sink: Callable[[log_t], None], level: int = log_t.INFO) -> None:
        self.component = component
        self.level = level
        self._clock = clock
        self._sink = sink

    def debug(self, text: str) -> None:
        """For whoever works on this component."""
        self._write(log_t.DEBUG, text)

    def info(self, text: str) -> None:
        """Worth knowing in normal operation, rare."""
        self._write(log_t.INFO, text)

    def warning(self, text: str) -> None:
        """Not as it should be; the component goes on."""
        self._write(log_t.WARNING, text)

    def error(self, text: str) -> None:
        """Something the component should do failed."""
        self._write(log_t.ERROR, text)

    def _write(self, level: int, text: str) -> None:
        if level < self.level:
            return
        caller = sys._getframe(2)
        line = log_t()
        line.level = level
        line.component = self.component
        line.tick = self._clock.tick
        line.time_us = self._clock.now_us
        line.wall_us = wall_us()
        line.file = caller.f_code.co_filename.rsplit("/", 1)[-1]
        line.line = caller.f_lineno
        line.text = text
        self._sink(line)
