"""A base station that is connected to the RefBox of this run: what it is sent, and the world states that it reports."""

import select
import socket

from fwk import Logger
from procs.refbox.inbox import Inbox
from procs.refbox.protocol import ProtocolError
from procs.refbox.world_state import check


class Station:
    """One base station; no call waits for it."""

    def __init__(self, connection: socket.socket, name: str, log: Logger) -> None:
        """`name` is its address."""
        self.name = name
        self.reports = 0
        """Number of world states that it has reported."""
        self.refused = 0
        """Number of its messages that were no world states."""
        self.silent = False
        """The base station has ended its side of the connection: it reports no more, and may have left."""
        self._connection = connection
        self._log = log
        self._inbox = Inbox(connection)

    def hear(self) -> bool:
        """Takes what has arrived; returns False if the base station has certainly left."""
        try:
            arrived = self._inbox.take()
        except ProtocolError as error:
            self._refuse(error)
            return True
        except EOFError:
            self.silent = True
            return not self._is_broken()
        except OSError:
            return False
        for message in arrived:
            self._take(message)
        return True

    def send(self, data: bytes) -> bool:
        """Sends bytes; returns False if the base station has left or does not read what it is sent."""
        try:
            return self._connection.send(data) == len(data)
        except OSError:
            return False

    def close(self) -> None:
        """Cuts the base station off."""
        self._connection.close()

    def _is_broken(self) -> bool:
        """Returns whether the connection is closed in both directions; of a peer that may still read only one is."""
        poll = select.poll()
        poll.register(self._connection, 0)  # errors and hang-ups are reported without being asked for
        return bool(poll.poll(0))

    def _take(self, message: bytes) -> None:
        try:
            report = check(message)
        except ProtocolError as error:
            self._refuse(error)
            return
        self.reports += 1
        if self.reports == 1:
            seen = ", ".join(f"{len(report[each])} {each}" for each in ("robots", "balls", "obstacles"))
            self._log.info(f"base station {self.name} reports the world state of {report['teamName'][:40]!r}: {seen}")

    def _refuse(self, error: ProtocolError) -> None:
        """Counts a message; logs the first."""
        self.refused += 1
        if self.refused == 1:
            self._log.warning(f"base station {self.name}: {error}; refused, as further messages of this kind will be")
