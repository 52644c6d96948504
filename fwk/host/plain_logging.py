"""Forwards lines of Python's `logging` to the log of the component that is being executed."""

import logging
from collections.abc import Callable

from fwk.component.log import Logger, short_path
from lcmtypes.core import log_t

_LEVELS = ((logging.ERROR, log_t.ERROR), (logging.WARNING, log_t.WARNING), (logging.INFO, log_t.INFO))


def forward_logging(current_log: Callable[[], Logger]) -> None:
    """Forwards lines from now on, as far as the `log_level` of the component allows."""
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
