"""Obeys a RefBox: hands its commands on to the referee."""

import errno
import os
import socket

from pydantic import Field, PositiveFloat

from fwk import Call as Sent
from fwk import Calls, Clock, Component, Config, Logger, channel
from lcmtypes.soccer import referee_command_t
from procs.model.robot import PLAYERS, Players
from procs.refbox.protocol import PORT, Command, Host, ProtocolError, Stream, decode

_IGNORED = frozenset({"WELCOME", "IS_ALIVE", "REPAIR_END", "TESTMODE_ON", "TESTMODE_OFF"})
_OTHER_NAMES = {"GAMEOVER": "END_GAME", "GAME_OVER": "END_GAME"}
_TIMEOUT_S = 1.0  # within which the referee answers a command
_HEARD = 65_536  # bytes taken from the RefBox in a tick
_UNDER_WAY = frozenset({errno.EINPROGRESS, errno.EALREADY, errno.EWOULDBLOCK, errno.EINTR})


class ClientConfig(Config):
    """Address of the RefBox."""

    host: Host = "127.0.0.1"
    """Name or address of the RefBox."""
    port: int = Field(default=PORT, ge=1, le=65_535)
    """TCP port of the RefBox."""
    retry_s: PositiveFloat = 1.0
    """A RefBox that cannot be reached is tried again after this time; only a new reason is logged again."""
    connect_s: PositiveFloat = 1.0
    """A RefBox that does not answer for so long is not there. The game goes on meanwhile."""
    addresses: dict[str, str] = {"cyan": "224.16.32.1", "magenta": "224.16.32.2"}
    """Multicast address that names each team."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""


class RefBoxClient(Component):
    """Leads the match as an official RefBox wants; the referee's setting `automatic` should be false."""

    stage = "sensor_acquire"
    reaches_outside = True

    config: ClientConfig
    clock: Clock
    log: Logger
    referee_command: Calls[referee_command_t] = channel("world/referee_command")

    def init(self) -> None:
        self._connection: socket.socket | None = None
        self._dialling: socket.socket | None = None
        self._dialled_us = 0
        self._stream = Stream()
        self._again_us = 0
        self._reason = ""  # why the RefBox cannot be reached
        self._sent: list[Sent] = []

    def loop(self) -> None:
        finished = [call for call in self._sent if call.finished]
        self._sent = [call for call in self._sent if not call.finished]
        self._warn("the referee does not obey", [call.reason for call in finished if not call.done])
        if self._connection is None and self.clock.now_us >= self._again_us:
            self._connect()
        self._warn("RefBox", [mistake for message in self._messages() if (mistake := self._hand_on(message))])

    def finalize(self) -> None:
        """Leaves the RefBox."""
        for each in filter(None, (self._connection, self._dialling)):
            each.close()

    def _warn(self, what: str, reasons: list[str]) -> None:
        """Logs one line, however many commands a RefBox sends in a tick."""
        if reasons:
            more = f" (and {len(reasons) - 1} more)" if len(reasons) > 1 else ""
            self.log.warning(f"{what}: {reasons[0]}{more}")

    def _connect(self) -> None:
        """Begins to connect, or goes on, without waiting for the RefBox."""
        place = (self.config.host, self.config.port)
        if self._dialling is None:
            self._dialling = socket.socket(socket.AF_INET6 if ":" in place[0] else socket.AF_INET)
            self._dialling.setblocking(False)
            self._dialled_us = self.clock.now_us
        try:
            code = self._dialling.connect_ex(place)
            reason = os.strerror(code)
        except OSError as error:  # no such host
            code, reason = errno.EHOSTUNREACH, str(error)
        if code in _UNDER_WAY:
            if self.clock.since_s(self._dialled_us) < self.config.connect_s:
                return
            reason = f"no answer for {self.config.connect_s:g} s"
        dialled, self._dialling = self._dialling, None
        if code not in (0, errno.EISCONN):
            dialled.close()
            self._again_us = self.clock.now_us + round(self.config.retry_s * 1e6)
            if reason != self._reason:
                again = f"it is tried again every {self.config.retry_s:g} s"
                self.log.warning(f"no RefBox at {place[0]}:{place[1]}: {reason}; {again}")
            self._reason = reason
            return
        self._connection, self._stream, self._reason = dialled, Stream(), ""
        self.log.info(f"connected with the RefBox at {place[0]}:{place[1]}")

    def _messages(self) -> list[bytes]:
        if self._connection is None:
            return []
        try:
            data = self._connection.recv(_HEARD)
            if data:
                return list(self._stream.feed(data))
            reason = "it closed the connection"
        except BlockingIOError:
            return []
        except (OSError, ProtocolError) as error:
            reason = str(error)
        self.log.warning(f"lost the RefBox: {reason}")
        self._connection.close()
        self._connection, self._again_us = None, self.clock.now_us + round(self.config.retry_s * 1e6)
        return []

    def _hand_on(self, message: bytes) -> str:
        """Hands a command on; returns why the message is no command, or an empty text."""
        try:
            command = decode(message, self.config.addresses)
        except ProtocolError as error:
            return str(error)
        if command.name not in _IGNORED:
            self._call(command)
        return ""

    def _call(self, command: Command) -> None:
        asked = self.referee_command.value
        asked.name = _OTHER_NAMES.get(command.name, command.name).lower()
        asked.team = command.team
        asked.robot = self._named(command) if command.robot else ""
        self._sent.append(self.referee_command.call(timeout_s=_TIMEOUT_S))

    def _named(self, command: Command) -> str:
        """Returns the namespace of the robot that a command names by team and number."""
        meant = (command.team, command.robot)
        found = (name for name, player in self.config.players.items() if (player.team, player.number) == meant)
        return next(found, f"{command.team}{command.robot}")
