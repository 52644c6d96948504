"""Carries out skills as commands: where to drive, when to handle the ball and when to kick."""

from difflib import get_close_matches
from functools import lru_cache, partial

from pydantic import ValidationInfo, field_validator

from fwk import Call, Calls, Clock, Component, Config, Logger, Reads, Request, RequestState, Serves, Writes, channel
from lcmtypes.robot import dribble_command_t, kick_command_t, kicker_state_t, motor_command_t
from lcmtypes.soccer import (
    drive_target_t,
    game_state_t,
    line_points_t,
    obstacle_percepts_t,
    skill_command_t,
    skill_status_t,
    world_model_t,
)
from procs.behaviour.bodies import Bodies
from procs.behaviour.commands import mistake
from procs.behaviour.game import Whose, frame_of, game_of
from procs.behaviour.own_player import with_own_robot
from procs.behaviour.permitted import Permitted, is_field_player
from procs.behaviour.skills.book import SKILLS, SkillRunner
from procs.behaviour.skills.skill import Blind, Drive, Obstacle, Scene, Sight, Status, Step
from procs.behaviour.view import view_of
from procs.model.ball import BALL, BallModel
from procs.model.field import Field, MatchField, Point
from procs.model.geometry import plausible
from procs.model.kicker import tells_held
from procs.model.robot import PLAYERS, ROBOT, Players, RobotModel
from procs.model.teams import Team, team_number_of_player

_KICK_TIMEOUT_S = 0.15
"""A kick without an answer by then has failed."""
_SEEN_S = 0.5
"""Older percepts do not count."""
_TOLD_MAX = 100
"""Number of skills whose mistakes are told in the log, each once for a sender; made-up names do not fill it."""


class SkillerConfig(Config):
    """Settings of the skills."""

    field: MatchField = Field()
    """Measures of the field."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    ball: BallModel = BALL
    """Size and friction of the ball."""

    @field_validator("players")
    @classmethod
    def _own_robot_plays(cls, players: Players, info: ValidationInfo) -> Players:
        return with_own_robot(players, info, "skill_status")


class Skiller(Component):
    """Carries out the newest command; thinks in the attack frame, writes in the world frame.

    A command is done when its skill has reached its end, and fails when the skill fails or a newer command replaces
    it.
    """

    stage = "skill"

    config: SkillerConfig
    clock: Clock
    log: Logger
    skill: Serves[skill_command_t]
    world_model: Reads[world_model_t]
    kicker_state: Reads[kicker_state_t]
    game_state: Reads[game_state_t] = channel("world/game_state")
    obstacle_percepts: Reads[obstacle_percepts_t]
    line_points: Reads[line_points_t]
    skill_status: Writes[skill_status_t]
    drive_target: Writes[drive_target_t]
    blind_drive: Writes[motor_command_t]
    kick: Calls[kick_command_t]
    dribble_command: Writes[dribble_command_t]

    def init(self) -> None:
        self._robot = self.name.rpartition("/")[0]
        self._frame = frame_of(self.game_state.value, self._team)
        self._runner = SkillRunner()
        self._request: Request[skill_command_t] | None = None
        self._kick: Call | None = None
        self._told: set[tuple[str, str]] = set()  # senders with the skills whose mistakes the log tells
        self.config_changed()

    def config_changed(self) -> None:
        self._bodies = Bodies.of(self.config.robot, self.config.ball)
        self._permitted = Permitted(self.config.field, self._bodies)

    @property
    def _team(self) -> Team:
        return team_number_of_player(self._robot, self.config.players)

    def loop(self) -> None:
        self._frame = frame_of(self.game_state.value, self._team)
        for request in self.skill:
            self._begin(request)
        step = self._runner.step(self._scene())
        self._answer(step)
        self._report(step)
        self._drive(step.drive)
        self._drive_blind(step.blind)
        self._handle(step.dribble)
        if step.kick_m_s > 0:
            self.kick.value.speed_m_s, self.kick.value.elevation_rad = step.kick_m_s, step.elevation_rad
            self._kick = self.kick.call(timeout_s=_KICK_TIMEOUT_S, expires_s=0.0)  # aimed for this tick alone

    def finalize(self) -> None:
        """Leaves the robot without a target and the ball handling off."""
        self._drive(None)
        self._drive_blind(None)
        self._handle(on=False)

    def _begin(self, request: Request[skill_command_t]) -> None:
        command = request.value
        known = command.skill in SKILLS
        reason = mistake(command, self.config.field, self._bodies) if known else _unknown(command.skill)
        if reason:
            self._tell(request, f"{command.skill}: {reason}" if known else reason)
            request.reject(reason)
        else:
            if self._request and not self._request.finished:
                self._request.fail(f"replaced by command {request.sequence} of {request.sender}")
            self._request = request
            self._runner.begin(command.skill)

    def _tell(self, request: Request[skill_command_t], reason: str) -> None:
        """Logs why a command is refused: agents send it anew in every tick, so once for its sender and its skill."""
        asked = (request.sender, request.value.skill)
        if asked not in self._told and len(self._told) < _TOLD_MAX:
            self._told.add(asked)
            self.log.warning(f"command {request.sequence} of {request.sender}: {reason}")

    def _scene(self) -> Scene:
        command = self._request.value if self._request else skill_command_t()
        kicker = self.kicker_state.value
        game = game_of(self.game_state.value, self._team, self._frame)
        model, players = self.world_model.value, self.config.players
        view = view_of(model, self._robot, "", self._frame, players=players, bodies=self._bodies)
        return Scene(
            view,
            self._frame.point(command.x_m, command.y_m),
            self._frame.heading_rad(command.heading_rad),
            command.speed_m_s,
            tells_held(kicker, self.clock.since_s(self.kicker_state.header.time_us)),
            kicker.charged,
            self._kick.done if self._kick and self._kick.finished else None,
            set_piece=game.whose is Whose.OURS and not game.free_play,
            duration_s=self.clock.iteration_s,
            field=self.config.field,
            game=game,
            sight=None if view.localized else self._sight(),
            permitted=partial(self._permitted.nearest, field_player=is_field_player(model, self._robot, players)),
        )

    def _sight(self) -> Sight | None:
        """Returns what a robot that does not know its place sees."""
        for percept in (self.obstacle_percepts, self.line_points):
            if not percept.has_value or self.clock.since_s(percept.header.time_us) > _SEEN_S:
                return None
        obstacles, lines = self.obstacle_percepts.value.obstacles, self.line_points.value
        return Sight(
            tuple(
                Obstacle(Point(each.x_m, each.y_m), each.radius_m)
                for each in obstacles
                if plausible(each.x_m, each.y_m, each.radius_m)
            ),
            tuple(Point(x_m, y_m) for x_m, y_m in zip(lines.x_m, lines.y_m, strict=True) if plausible(x_m, y_m)),
        )

    def _answer(self, step: Step) -> None:
        if self._request is None or self._request.finished:
            return
        if step.status is Status.FINAL:
            self._request.done()
        elif step.status is Status.FAILED:
            self.log.debug(f"{self._request.value.skill} failed: {step.reason}")
            self._request.fail(step.reason)
        elif self._request.state is RequestState.SENT:
            self._request.accept()

    def _report(self, step: Step) -> None:
        status = self.skill_status.value
        status.status, status.reason = step.status, step.reason
        if self._request:
            status.command_id, status.skill = self._request.sequence, self._request.value.skill
        self.skill_status.write()

    def _drive(self, drive: Drive | None) -> None:
        target = self.drive_target.value
        before = (target.stop, target.x_m, target.y_m, target.heading_rad)
        target.stop = drive is None
        if drive is not None:
            target.x_m, target.y_m = self._frame.point(*drive.place)
            target.heading_rad = self._frame.heading_rad(drive.heading_rad)
            target.speed_m_s, target.end_speed_m_s = drive.speed_m_s, drive.end_speed_m_s
            target.avoid_ball, target.avoid_robots = drive.avoid_ball, drive.avoid_robots
        if (target.stop, target.x_m, target.y_m, target.heading_rad) != before:
            target.target_id += 1
        self.drive_target.write()

    def _drive_blind(self, blind: Blind | None) -> None:
        """Sends the velocity of a robot that does not know its place, and its end once."""
        command = self.blind_drive.value
        if blind is None and not command.enabled:
            return
        command.enabled = blind is not None
        command.vx_m_s, command.omega_rad_s = blind or (0.0, 0.0)
        self.blind_drive.write()

    def _handle(self, on: bool) -> None:
        self.dribble_command.value.on = on
        self.dribble_command.write()


@lru_cache(maxsize=_TOLD_MAX)
def _unknown(skill: str) -> str:
    """Returns that no skill has this name, and the names that exist, the nearest first."""
    return f"no skill '{skill}'; there are {', '.join(get_close_matches(skill, SKILLS, len(SKILLS), cutoff=0.0))}"
