"""Serves the referee's decisions to base stations, and hears their reports, as the RefBox of the league does."""

import selectors
import socket
from itertools import groupby

from pydantic import Field

from fwk import Component, Config, Logger, Reads, channel
from lcmtypes.soccer import game_event_t, game_state_t, match_history_t
from procs.model.robot import PLAYERS, Players
from procs.refbox.liveness import notice_absence
from procs.refbox.news import news
from procs.refbox.protocol import PORT, Addresses, Command, Host, encode
from procs.refbox.station import Station

_BACKLOG = 16  # base stations that may wait to be let in


class ServerConfig(Config):
    """Address at which base stations find the server."""

    host: Host = Field("127.0.0.1", frozen=True)
    """Address on which it listens; 0.0.0.0 lets other machines in."""
    port: int = Field(default=PORT, ge=0, le=65_535, frozen=True)
    """TCP port; 0: a free port, which the log names."""
    stations: int = Field(default=32, ge=1, le=500)
    """Most base stations at a time; further ones are turned away."""
    addresses: Addresses = Addresses()
    """Multicast address that names each team."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""


class RefBoxServer(Component):
    """Sends each base station what led to the state of the game, then every decision in the tick after it.

    First come a reset, so that a base station that comes back counts no goal twice, the half, the goals, the cards, the
    robots off the field, and the break or the set piece at hand.

    The reports of base stations are checked and counted. A base station that leaves, or does not read what it is sent,
    is cut off: no base station can hold the game up. One that has ended its side of the connection may still listen: it
    is told all decisions, until it does not take them any more or another one needs its place.
    """

    stage = "post_loop"
    reaches_outside = True

    config: ServerConfig
    log: Logger
    game_state: Reads[game_state_t] = channel("world/game_state")
    match_history: Reads[match_history_t] = channel("world/match_history")

    def init(self) -> None:
        """Begins to listen.

        Raises:
            OSError: the address cannot be used.
        """
        self._before: game_state_t | None = None
        self._events: list[game_event_t] = []
        self._stations: list[Station] = []
        family = socket.AF_INET6 if ":" in self.config.host else socket.AF_INET
        self._listening = socket.create_server((self.config.host, self.config.port), family=family, backlog=_BACKLOG)
        self._listening.setblocking(False)
        self._arrivals = selectors.DefaultSelector()
        self._arrivals.register(self._listening, selectors.EVENT_READ)
        self.port = self._listening.getsockname()[1]
        self.log.info(f"RefBox at {self.config.host}:{self.port}")

    def loop(self) -> None:
        if not self.game_state.has_value:
            return
        self._hear()
        for now, events in self._told():
            self._send(news(self._before, now, events, self.config.players), list(self._stations))
            self._before, self._events = now, events
        newcomers = self._admit()
        if self._before is not None:
            led_here = news(None, self._before, self._events, self.config.players)
            self._send([Command("WELCOME"), Command("RESET"), *led_here], newcomers)

    def _told(self) -> list[tuple[game_state_t, list[game_event_t]]]:
        """Returns the states since the last iteration with their histories: one of each tick, and of each command."""
        states, histories = self.game_state.fresh, self.match_history.fresh
        if self._before is None:
            return [(self.game_state.value, self.match_history.value.events)]
        told, events = [], self._events
        for tick, of_tick in groupby(states, lambda state: state.header.tick):
            several = list(of_tick)
            written = [history.events for history in histories if history.header.tick == tick][-len(several) :]
            for number, state in enumerate(several, len(written) - len(several)):
                events = written[number] if number >= 0 else events  # the first state of a tick may add nothing
                told.append((state, events))
        return told

    def finalize(self) -> None:
        """Closes all connections."""
        self._arrivals.close()
        for station in self._stations:
            station.close()
        self._listening.close()

    def _hear(self) -> None:
        """Takes the reports of base stations, and cuts off those that have left."""
        for station in list(self._stations):
            if not station.hear():
                self._cut_off(station, "left")

    def _admit(self) -> list[Station]:
        newcomers: list[Station] = []
        for _ in range(_BACKLOG):
            if not self._arrivals.select(0):
                break
            try:
                connection, address = self._listening.accept()
            except OSError:  # it has left before it was let in, or the process has no descriptor left
                break
            silent = next((station for station in self._stations if station.silent), None)
            full = len(self._stations) + len(newcomers) >= self.config.stations
            if full and silent is not None:
                self._cut_off(silent, "reports no more, and another one takes its place")
            elif full:
                self.log.warning(f"base station {address[0]} is turned away: {self.config.stations} are connected")
                connection.close()
                continue
            connection.setblocking(False)
            notice_absence(connection)
            station = Station(connection, f"{address[0]}:{address[1]}", self.log)
            self.log.info(f"base station {station.name} is connected")
            newcomers.append(station)
        self._stations += newcomers
        return newcomers

    def _cut_off(self, station: Station, why: str) -> None:
        said = f"{station.reports} world states reported, {station.refused} messages refused"
        self.log.info(f"base station {station.name} {why}; {said}")
        self._stations.remove(station)
        station.close()

    def _send(self, commands: list[Command], stations: list[Station]) -> None:
        addresses = self.config.addresses.model_dump()
        data = b"".join(encode(command, addresses) for command in commands)
        for station in stations if data else []:
            if not station.send(data):
                self._cut_off(station, "left, or did not read what it was sent")
