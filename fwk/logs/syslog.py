"""Lines of text to the system's log: the daemon of this machine, or one elsewhere."""

import os
import socket
import time
from collections.abc import Callable

from fwk.clock import US_PER_S
from lcmtypes.core import log_t

_USER_LEVEL = 1 << 3  # the facility of programs that people start
_SEVERITIES = {log_t.DEBUG: 7, log_t.INFO: 6, log_t.WARNING: 4, log_t.ERROR: 3}
_BYTES_MAX = 8192  # what daemons take at least; more of a line is left out


class Syslog:
    """A sink of the gateway: one datagram (RFC 3164) for each line.

    `to` is a unix socket's path, or `ADDRESS:PORT` for UDP, as numbers, because a name may take long to look up. What
    the daemon does not take at once is missing there and counted; the run neither waits nor fails for it.
    """

    def __init__(self, to: str, run: str, report: Callable[[str], None]) -> None:
        self._to = to
        self._run = run
        self._report = report
        self._socket: socket.socket | None = None
        self._missing = 0

    def message(self, channel: str, data: bytes, _time_us: int) -> None:
        """Sends a line of text; anything else is not its business."""
        if channel != "fwk/log":
            return
        sent = self._formatted(log_t.decode(data))
        for _ in range(2):  # the daemon may have been started again since the last line
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
        """Nothing to do."""

    def close(self) -> None:
        """Says how many lines it lacks."""
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
