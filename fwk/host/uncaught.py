"""Logs uncaught exceptions of a process with traceback and tick."""

import sys
import threading
from types import TracebackType
from typing import TYPE_CHECKING

from fwk.component.log import Logger

if TYPE_CHECKING:
    from sys import UnraisableHookArgs


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
