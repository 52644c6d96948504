"""Serves the referee's decisions to base stations, as the RefBox of the middle size league does."""

import selectors
import socket

from pydantic import Field

from fwk import Component, Config, Logger, Reads, channel
from lcmtypes.soccer import game_state_t
from procs.refbox.news import news
from procs.refbox.protocol import PORT, Command, encode

_BACKLOG = 16


class ServerConfig(Config):
    """Address at which base stations find the server."""

    host: str = "127.0.0.1"
    """Address on which it listens; 0.0.0.0 lets other machines in."""
    port: int = Field(default=PORT, ge=0, le=65_535)
    """TCP port; 0: one that is free, named in the log."""
    addresses: dict[str, str] = {"cyan": "224.16.32.1", "magenta": "224.16.32.2"}
    """Multicast address that names each team."""


class RefBoxServer(Component):
    """Sends each base station what led to the state of the game, then every decision in the tick in which it is made.

    A base station that does not read what it is sent is cut off; no base station can hold the game up.
    """

    stage = "post_loop"
    reaches_outside = True

    config: ServerConfig
    log: Logger
    game_state: Reads[game_state_t] = channel("world/game_state")

    def init(self) -> None:
        """Listens.

        Raises:
            OSError: the address cannot be used.
        """
        self._before: game_state_t | None = None
        self._stations: list[socket.socket] = []
        self._listening = socket.create_server((self.config.host, self.config.port), backlog=_BACKLOG)
        self._listening.setblocking(False)
        self._arrivals = selectors.DefaultSelector()
        self._arrivals.register(self._listening, selectors.EVENT_READ)
        self.port = self._listening.getsockname()[1]
        self.log.info(f"RefBox at {self.config.host}:{self.port}")

    def loop(self) -> None:
        if not self.game_state.has_value:
            return
        now = self.game_state.value
        self._send(news(self._before, now), list(self._stations))
        self._before = now
        newcomers = self._admit()
        self._send([Command("WELCOME"), *news(None, now)], newcomers)

    def finalize(self) -> None:
        """Closes all connections."""
        self._arrivals.close()
        for each in (*self._stations, self._listening):
            each.close()

    def _admit(self) -> list[socket.socket]:
        newcomers = []
        while self._arrivals.select(0):
            station, address = self._listening.accept()
            station.setblocking(False)
            self.log.info(f"base station {address[0]}:{address[1]} is connected")
            newcomers.append(station)
        self._stations += newcomers
        return newcomers

    def _send(self, commands: list[Command], stations: list[socket.socket]) -> None:
        data = b"".join(encode(command, self.config.addresses) for command in commands)
        for station in stations if data else []:
            try:
                whole = station.send(data) == len(data)
            except OSError:
                whole = False
            if not whole:
                self.log.info("base station left, or did not read what it was sent")
                self._stations.remove(station)
                station.close()
