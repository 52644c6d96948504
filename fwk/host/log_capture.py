"""Captures for the log what a component writes to Python's `logging`, and exceptions that it does not catch."""

import logging
import sys
import threading
from collections.abc import Callable
from types import TracebackType
from typing import TYPE_CHECKING

from fwk.component.log import Logger, short_path
from lcmtypes.core import log_t

if TYPE_CHECKING:
    from sys import UnraisableHookArgs

_LEVELS = ((logging.ERROR, log_t.ERROR), (logging.WARNING, log_t.WARNING), (logging.INFO, log_t.INFO))


def log_uncaught(log: Logger) -> None:
    """Logs uncaught exceptions of threads, destructors and the process itself from now on."""

    def in_process(_kind: type[BaseException], error: BaseException, _trace: TracebackType | None) -> None:
        log.exception("ends with an uncaught exception", error)

    def in_thread(hooked: threading.ExceptHookArgs) -> None:
        if hooked.exc_value and not isinstance(hooked.exc_value, SystemExit):
            name = hooked.thread.name if hooked.thread else "?"
            log.exception(f"thread {name} ends with an uncaught exception", hooked.exc_value)

    def nowhere(hooked: "UnraisableHookArgs") -> None:
        if hooked.exc_value:
            log.exception(f"{hooked.err_msg or 'exception ignored in'} {hooked.object!r}", hooked.exc_value)

    sys.excepthook = in_process
    threading.excepthook = in_thread
    sys.unraisablehook = nowhere


def forward_logging(current_log: Callable[[], Logger]) -> None:
    """Forwards lines of `logging` to the log of the component that is being executed from now on.

    The component's `log_level` decides which lines are written.
    """
    root = logging.getLogger()
    root.addHandler(_Forward(current_log))
    root.setLevel(logging.DEBUG)  # the component's setting decides which lines are written


class _Forward(logging.Handler):
    def __init__(self, current_log: Callable[[], Logger]) -> None:
        super().__init__()
        self._current_log = current_log

    def emit(self, record: logging.LogRecord) -> None:
        try:
            log = self._current_log()
            level = next((ours for theirs, ours in _LEVELS if record.levelno >= theirs), log_t.DEBUG)
            if log.level <= level:
                log.write(level, self.format(record), short_path(record.pathname), record.lineno)
        except Exception:  # an invalid log call does not end a component
            self.handleError(record)
