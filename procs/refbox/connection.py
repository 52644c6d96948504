"""Connection of a base station with a RefBox: dials again when it is lost, and never waits."""

import errno
import os
import socket

from fwk import Clock, Logger
from procs.refbox.inbox import Inbox
from procs.refbox.liveness import notice_absence
from procs.refbox.lookup import Lookup
from procs.refbox.protocol import ProtocolError

_UNDER_WAY = frozenset({errno.EINPROGRESS, errno.EALREADY, errno.EWOULDBLOCK, errno.EINTR})


class Connection:
    """A TCP connection that is there or is being made."""

    def __init__(self, clock: Clock, log: Logger) -> None:
        self._clock = clock
        self._log = log
        self._socket: socket.socket | None = None
        self._dialling: socket.socket | None = None
        self._lookup: Lookup | None = None  # of a connection that is being made
        self._address = ("", 0)
        self._dialled_us = 0
        self._inbox: Inbox | None = None
        self._again_us = 0
        self._tries = 0  # without an answer; `localhost` may have two addresses, of which a RefBox listens at one
        self._retry_s = 0.0
        self._reason = ""  # why the RefBox cannot be reached
        self._unsent = b""

    @property
    def ready(self) -> bool:
        """True if the RefBox is there and has taken all that was sent so far."""
        return self._socket is not None and not self._unsent

    def attend(self, host: str, port: int, retry_s: float, connect_s: float) -> None:
        """Dials if there is no connection, or sends what is left of a message; leaves a RefBox at another address.

        Args:
            host: name or address of the RefBox.
            port: its TCP port.
            retry_s: time after which a RefBox that cannot be reached is tried again.
            connect_s: time after which a RefBox that does not answer is not there.
        """
        self._retry_s = retry_s
        if (host, port) != self._address:
            self.close()
            self._socket = self._inbox = self._dialling = self._lookup = None
            self._address, self._again_us, self._reason = (host, port), 0, ""
        if self._socket is not None:
            self._send_rest()
        elif self._clock.now_us >= self._again_us:
            self._dial(host, port, connect_s)

    def messages(self) -> list[bytes]:
        """Returns messages that have arrived, without their NUL; of very many, the rest in the next ticks."""
        if self._inbox is None:
            return []
        try:
            return self._inbox.take()
        except ProtocolError as error:
            self._log.warning(f"RefBox: {error}; dropped")
        except (EOFError, OSError) as error:
            self._lose(str(error))
        return []

    def send(self, data: bytes) -> None:
        """Sends a message as fast as the RefBox reads; it has to be `ready`."""
        self._unsent = data
        self._send_rest()

    def close(self) -> None:
        """Leaves the RefBox."""
        for each in filter(None, (self._socket, self._dialling)):
            each.close()

    def _dial(self, host: str, port: int, connect_s: float) -> None:
        """Begins to connect, or goes on, without waiting for the RefBox or the address of its name."""
        if self._lookup is None:
            self._lookup, self._dialled_us = Lookup(host, port, self._tries), self._clock.now_us
        if not self._lookup.done:  # the next try waits for it, too
            if self._clock.since_s(self._dialled_us) >= connect_s:
                self._fail(f"no address of that name for {connect_s:g} s")
            return
        code, reason = self._reach(self._lookup)
        if code in _UNDER_WAY and self._clock.since_s(self._dialled_us) < connect_s:
            return
        dialled, self._dialling, self._lookup = self._dialling, None, None
        if dialled is not None and code in (0, errno.EISCONN):
            self._socket, self._inbox, self._reason, self._unsent = dialled, Inbox(dialled), "", b""
            self._log.info(f"connected with the RefBox at {host}:{port}")
            return
        if dialled is not None:
            dialled.close()
        self._tries += 1
        self._fail(f"no answer for {connect_s:g} s" if code in _UNDER_WAY else reason)

    def _reach(self, found: Lookup) -> tuple[int, str]:
        """Begins or goes on to connect; returns the system's code and its text."""
        if found.reason:
            return errno.EHOSTUNREACH, found.reason
        if self._dialling is None:
            try:
                self._dialling = socket.socket(found.family)
            except OSError as error:  # this machine does not know IPv6, or the process has no descriptor left
                return errno.EHOSTUNREACH, str(error.strerror)
            self._dialling.setblocking(False)
            notice_absence(self._dialling)
            self._dialled_us = self._clock.now_us
        code = self._dialling.connect_ex(found.address)
        return code, os.strerror(code)

    def _fail(self, reason: str) -> None:
        """Tries again later; a new reason is logged."""
        self._try_later()
        if reason != self._reason:
            host, port = self._address
            self._log.warning(f"no RefBox at {host}:{port}: {reason}; it is tried again every {self._retry_s:g} s")
        self._reason = reason

    def _send_rest(self) -> None:
        if self._socket is None or not self._unsent:
            return
        try:
            self._unsent = self._unsent[self._socket.send(self._unsent) :]
        except BlockingIOError:
            pass
        except OSError as error:
            self._lose(str(error))

    def _lose(self, reason: str) -> None:
        self._log.warning(f"lost the RefBox: {reason}")
        if self._socket is not None:
            self._socket.close()
        self._socket = self._inbox = None
        self._try_later()

    def _try_later(self) -> None:
        self._again_us = self._clock.now_us + round(self._retry_s * 1e6)
