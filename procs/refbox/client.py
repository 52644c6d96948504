"""Base station of a team: hands the commands of a RefBox on to the referee, and reports the team's world state."""

from typing import Literal

from pydantic import Field, PositiveFloat

from fwk import Call as Sent
from fwk import Calls, Clock, Component, Config, Each, Logger, Reads, channel
from lcmtypes.soccer import game_state_t, referee_command_t, team_message_t, world_model_t
from procs.model.game_states import State, state_of
from procs.model.robot import PLAYERS, ROBOT, Players, RobotModel, team_of_player
from procs.model.teams import Ends, team_number
from procs.model.units import US_PER_S
from procs.refbox.connection import Connection
from procs.refbox.protocol import PORT, Addresses, Command, Host, ProtocolError, decode
from procs.refbox.world_state import best_belief, encode, intention_of, world_state
from procs.referee.orders import OF_ROBOT

_IGNORED = frozenset({"WELCOME", "IS_ALIVE", "REPAIR_END", "TESTMODE_ON", "TESTMODE_OFF"})
_OTHER_NAMES = {"GAMEOVER": "END_GAME", "GAME_OVER": "END_GAME"}
_TIMEOUT_S = 1.0  # within which the referee answers a command
_OPEN_MAX = 64  # commands that may wait for the referee; it refuses more
_SILENT_S = 2.0  # a robot that has told nothing for so long is left out of the report


class ClientConfig(Config):
    """Address of the RefBox, and what is reported to it."""

    host: Host = "127.0.0.1"
    """Name or address of the RefBox."""
    port: int = Field(default=PORT, ge=1, le=65_535)
    """TCP port of the RefBox."""
    retry_s: PositiveFloat = 1.0
    """A RefBox that cannot be reached is tried again after this time; only a new reason is logged again."""
    connect_s: PositiveFloat = 1.0
    """A RefBox that does not answer for so long is not there. The game goes on meanwhile."""
    addresses: Addresses = Addresses()
    """Multicast address that names each team."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""
    robot: RobotModel = ROBOT
    """Size of the robots, also of opponents."""
    obeys: bool = True
    """False: the commands of the RefBox are left to another base station of the run."""
    team: Literal["cyan", "magenta"] = "cyan"
    """Team whose world state is reported."""
    team_name: str = ""
    """Name of the team in its reports; empty: `team`."""
    report_s: float = Field(0.1, ge=0.0, le=60.0)
    """Time from one report to the next; 0: no reports."""


class RefBoxClient(Component):
    """Leads the match as an official RefBox wants; the referee's setting `automatic` should be false.

    The RefBox is told where the robots of the team are, what they are about to do, and what they know of ball and
    opponents.
    """

    stage = "sensor_acquire"
    reaches_outside = True

    config: ClientConfig
    clock: Clock
    log: Logger
    referee_command: Calls[referee_command_t] = channel("world/referee_command")
    game_state: Reads[game_state_t] = channel("world/game_state")
    messages: Each[Reads[team_message_t]] = channel("*/team_message")
    beliefs: Each[Reads[world_model_t]] = channel("*/world_model")

    def init(self) -> None:
        self._connection = Connection(self.clock, self.log)
        self._commands: list[Command] = []  # not handed on yet
        self._sent: list[tuple[Command, Sent]] = []
        self._asked: set[str] = set()  # robots of the team that are to show that they are alive
        self._reported_us = 0  # when the newest report was due

    def loop(self) -> None:
        failed = [(command, call) for command, call in self._sent if call.finished and not call.done]
        self._sent = [(command, call) for command, call in self._sent if not call.finished]
        self._warn([f"the referee does not obey {command.words}: {call.reason}" for command, call in failed])
        config, connection = self.config, self._connection
        connection.attend(config.host, config.port, config.retry_s, config.connect_s)
        messages = connection.messages() if len(self._commands) < _OPEN_MAX else []
        self._warn([f"RefBox: {mistake}" for message in messages if (mistake := self._take(message))])
        self._hand_on()
        if self._asked:
            self.log.info(f"the RefBox asks for signs of life: {', '.join(map(self._sign_of, sorted(self._asked)))}")
            self._asked = set()
        if config.report_s and connection.ready and self.clock.since_s(self._reported_us) >= config.report_s:
            self._report()

    def finalize(self) -> None:
        """Leaves the RefBox."""
        self._connection.close()

    def _warn(self, sentences: list[str]) -> None:
        """Logs one line, however many commands a RefBox sends in a tick."""
        if sentences:
            more = f" (and {len(sentences) - 1} more)" if len(sentences) > 1 else ""
            self.log.warning(f"{sentences[0]}{more}")

    def _take(self, message: bytes) -> str:
        """Takes a command; returns why the message is no command, or an empty text."""
        try:
            command = decode(message, self.config.addresses.model_dump())
        except ProtocolError as error:
            return str(error)
        if command.name == "IS_ALIVE" and command.team == self.config.team and command.robot:
            self._asked.add(self._named(command))
        if self.config.obeys and command.name not in _IGNORED:
            self._commands.append(command)
        return ""

    def _sign_of(self, robot: str) -> str:
        """Returns when a robot told something last, for the log; the protocol has no answer to `IS_ALIVE`."""
        if robot not in self.messages or not self.messages[robot].has_value:
            return f"{robot} has told nothing"
        return f"{robot} told something {self.clock.since_s(self.messages[robot].header.time_us):.1f} s ago"

    def _hand_on(self) -> None:
        """Hands on as many commands as may wait for the referee; the others follow in the next ticks."""
        free = _OPEN_MAX - len(self._sent)
        for command in self._commands[:free]:
            self._call(command)
        del self._commands[:free]

    def _call(self, command: Command) -> None:
        asked = self.referee_command.value
        asked.name = _OTHER_NAMES.get(command.name, command.name).lower()
        asked.team = command.team
        asked.robot = self._named(command) if command.robot and asked.name in OF_ROBOT else ""
        self._sent.append((command, self.referee_command.call(timeout_s=_TIMEOUT_S)))

    def _named(self, command: Command) -> str:
        """Returns the namespace of the robot that a command names by team and number."""
        meant = (command.team, command.robot)
        found = (name for name, player in self.config.players.items() if (player.team, player.number) == meant)
        return next(found, f"{command.team}{command.robot}")

    def _report(self) -> None:
        """Sends the team's world state, if a robot has told something lately."""
        ages_s = {
            robot: self.clock.since_s(port.header.time_us)
            for robot, port in self.messages.items()
            if port.has_value and self._plays(robot)
        }
        heard = [robot for robot, age_s in ages_s.items() if age_s <= _SILENT_S]
        if not heard:
            return
        now_us, period_us = self.clock.now_us, round(self.config.report_s * US_PER_S)
        due_us = self._reported_us + period_us  # a report that waited for its tick does not delay the next
        self._reported_us = due_us if now_us < due_us + period_us else now_us
        beliefs = [self.beliefs[robot].value for robot in heard if robot in self.beliefs]
        belief, game = best_belief(beliefs), self.game_state.value
        report = world_state(
            self.config.team_name or self.config.team,
            intention_of(belief, heard) if game.state == State.PLAY else state_of(game.state).words,
            [self.messages[robot].value for robot in heard],
            belief,
            -Ends.told(game.cyan_side).side_of(team_number(self.config.team)),
            self.config.robot.radius_m,
            min(ages_s[robot] for robot in heard),
        )
        self._connection.send(encode(report))

    def _plays(self, robot: str) -> bool:
        """Returns whether a robot belongs to the team."""
        return team_of_player(robot, self.config.players) == self.config.team
