"""Sends lines of text to a syslog daemon, of this machine or of another one."""

import os
import socket
import time
from collections.abc import Callable

from fwk.clock import US_PER_S
from lcmtypes.core import log_t

_USER_LEVEL = 1 << 3  # facility of programs that users start
_SEVERITIES = {log_t.DEBUG: 7, log_t.INFO: 6, log_t.WARNING: 4, log_t.ERROR: 3}
_BYTES_MAX = 8192  # size that all daemons accept; the rest of a line is left out


class Syslog:
    """Sink of the gateway that sends one datagram (RFC 3164) for each line.

    A line that the daemon does not take at once is missing there and counted; the run neither waits nor fails for it.

    Args:
        to: path of a unix socket, or `ADDRESS:PORT` for UDP, as numbers, because a name may take long to look up.
        run: name of the run.
        report: takes a text when the first line is missing, and at the end.
    """

    def __init__(self, to: str, run: str, report: Callable[[str], None]) -> None:
        self._to = to
        self._run = run
        self._report = report
        self._socket: socket.socket | None = None
        self._missing = 0

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Sends a line of text; ignores all other messages."""
        if channel != "fwk/log":
            return
        sent = self._formatted(log_t.decode(data))
        for _ in range(2):  # the daemon may have been restarted since the last line
            try:
                self._socket = self._socket or _connected(self._to)
                self._socket.send(sent)
            except BlockingIOError:
                self._missing += 1
                return
            except OSError as error:
                reason = error.strerror or str(error)
                self._disconnect()
            else:
                return
        self._missing += 1
        if self._missing == 1:
            self._report(f"no syslog at {self._to}: {reason}; its lines are in the other targets")

    def tick(self) -> None:
        """Does nothing."""

    def close(self) -> None:
        """Disconnects, and reports how many lines are missing."""
        self._disconnect()
        if self._missing:
            self._report(f"{self._missing} lines are missing in syslog at {self._to}")

    def _formatted(self, line: log_t) -> bytes:
        priority = _USER_LEVEL | _SEVERITIES.get(line.level, 3)
        when = time.strftime("%b %e %H:%M:%S", time.localtime(line.wall_us / US_PER_S))
        sender = "" if self._to.startswith("/") else f"{socket.gethostname()} "
        text = f"{self._run} {line.component} tick {line.tick}: {line.text} ({line.file}:{line.line})"
        made = f"<{priority}>{when} {sender}fwk[{os.getpid()}]: {text}".encode()
        return made[:_BYTES_MAX].decode(errors="ignore").encode()

    def _disconnect(self) -> None:
        if self._socket:
            self._socket.close()
            self._socket = None


def _connected(to: str) -> socket.socket:
    host, _, port = to.rpartition(":")
    remote = not to.startswith("/")
    made = socket.socket(socket.AF_INET if remote else socket.AF_UNIX, socket.SOCK_DGRAM)
    made.setblocking(False)
    try:
        made.connect((host, int(port)) if remote else to)
    except OSError:
        made.close()
        raise
    return made
