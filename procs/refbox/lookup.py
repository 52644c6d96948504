"""Looks up the address of a machine without waiting for it."""

import socket
import threading
from typing import Any


class Lookup:
    """Address of a host: at once if `host` is an address, and otherwise by a thread.

    A name server that does not answer holds its caller up for many seconds, and cannot be asked without waiting.
    """

    def __init__(self, host: str, port: int, turn: int = 0) -> None:
        """Begins; of several addresses of the machine each one has its `turn`, from 0."""
        self.family = socket.AF_INET
        self.address: Any = None
        """Address for `socket.connect`; None until the host is found."""
        self.reason = ""
        """Why the host was not found."""
        self._host, self._port, self._turn = host, port, turn
        try:
            self._find(socket.AI_NUMERICHOST)
        except OSError:
            threading.Thread(target=self._look_up, daemon=True).start()

    @property
    def done(self) -> bool:
        """Whether the host was found, or does not exist."""
        return self.address is not None or bool(self.reason)

    def _look_up(self) -> None:
        try:
            self._find(0)
        except OSError as error:
            self.reason = str(error)

    def _find(self, flags: int) -> None:
        found = socket.getaddrinfo(self._host, self._port, type=socket.SOCK_STREAM, flags=flags)
        family, *_, address = found[self._turn % len(found)]
        self.family, self.address = family, address
