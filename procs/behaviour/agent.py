"""Chooses the role of the robot in its team, and the skill for the moment."""

import math
from collections.abc import Mapping
from typing import Literal

import numpy as np
from pydantic import ValidationInfo, field_validator

from fwk import Call, Calls, Clock, Component, Config, Logger, Reads, Writes, channel
from lcmtypes.robot import kicker_state_t
from lcmtypes.soccer import game_state_t, pass_agreement_t, role_t, skill_command_t, world_model_t
from procs.behaviour import greedy, roles
from procs.behaviour.bodies import Bodies
from procs.behaviour.commands import accepted_place
from procs.behaviour.company import Company, job_among_silent, rank_of
from procs.behaviour.game import Game, frame_of, game_of
from procs.behaviour.order import Order
from procs.behaviour.own_player import with_own_robot
from procs.behaviour.skills.book import SKILLS
from procs.behaviour.stalls import NO_JOBS, Stalls
from procs.behaviour.steady_role import SteadyRole
from procs.behaviour.tactics import Tactics, leave_field
from procs.behaviour.view import View, view_of
from procs.model.ball import BALL, BallModel
from procs.model.field import Field, MatchField, Point
from procs.model.geometry import plausible, wrap_rad
from procs.model.kicker import tells_held
from procs.model.robot import ABSENT, PLAYERS, ROBOT, Players, RobotModel
from procs.model.teams import Team, team_number_of_player

_EXPIRES_S = 1.0
"""Logical time within which the skiller has to begin a command."""


class AgentConfig(Config):
    """Settings of the decisions."""

    field: MatchField = Field()
    """Measures of the field."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    ball: BallModel = BALL
    """Size and friction of the ball."""
    strategy: Literal["team", "greedy"] = "team"
    """`team`: roles, passes and formations; `greedy`: the simple opponent, which chases the ball."""
    use_pressing: bool = True
    """In play a second robot goes for the ball while an opponent is at it sooner."""
    use_roles: bool = True
    """False: in play every field player goes for the ball, to show what roles are worth."""
    new_target_m: float = 0.05
    """A target that moved further than this makes a new command."""
    new_heading_rad: float = 0.05
    """A heading that turned further than this makes a new command."""

    @field_validator("players")
    @classmethod
    def _own_robot_plays(cls, players: Players, info: ValidationInfo) -> Players:
        return with_own_robot(players, info, "role")


class Agent(Component):
    """Decides in the attack frame, sends commands in the world frame."""

    stage = "think"

    config: AgentConfig
    clock: Clock
    log: Logger
    rng: np.random.Generator
    world_model: Reads[world_model_t]
    game_state: Reads[game_state_t] = channel("world/game_state")
    kicker_state: Reads[kicker_state_t]
    role: Writes[role_t]
    skill: Calls[skill_command_t]

    def init(self) -> None:
        self._robot = self.name.rpartition("/")[0]
        self._frame = frame_of(self.game_state.value, self._team)
        self._tactics = Tactics(self.config.field, self.rng)
        self._company = Company()
        self._stalls = Stalls()
        self._steady = SteadyRole()
        self._jobs: Mapping[str, roles.Job] = NO_JOBS
        self._begun = Game()  # as it was when the set piece at hand was last stopped
        self._call: Call | None = None
        self.config_changed()

    def config_changed(self) -> None:
        self._bodies = Bodies.of(self.config.robot, self.config.ball)
        if self._tactics.field != self.config.field:
            self._tactics = Tactics(self.config.field, self.rng)

    @property
    def _team(self) -> Team:
        return team_number_of_player(self._robot, self.config.players)

    def loop(self) -> None:
        role, frame = self.role.value, frame_of(self.game_state.value, self._team)
        if frame != self._frame:
            self._frame, self._tactics = frame, Tactics(self.config.field, self.rng)
        game = self._as_begun(game_of(self.game_state.value, self._team, frame))
        if role.role == ABSENT and self._robot not in game.sent_off:
            role.role = roles.DEFENDER
        model, said, players = self.world_model.value, self._tactics.passing.said, self.config.players
        view = view_of(
            model, self._robot, role.role, frame, agreement=said, players=players, bodies=self._bodies
        ).without(game.sent_off)
        role.role, order = self._decide(view, game)
        self._tell_pass(role.agreement)
        role.intention = order.intention or order.skill
        self.role.write()
        self._command(order)

    def _as_begun(self, game: Game) -> Game:
        """Returns the game with the number before its start: a card after that changes no plan and no place."""
        same = self._begun._replace(stopped=game.stopped, sent_off=game.sent_off, number=game.number) == game
        if game.stopped or not same:
            self._begun = game
        return game._replace(number=self._begun.number)

    def _decide(self, view: View, game: Game) -> tuple[str, Order]:
        """Returns the role of the robot and its order."""
        kicker, field = self.kicker_state, self.config.field
        held = tells_held(kicker.value, self.clock.since_s(kicker.header.time_us))
        if self._robot in game.sent_off and view.localized:
            self._tactics = Tactics(field, self.rng)  # a robot that comes back begins anew
            return ABSENT, leave_field(view, game, field)
        if self.config.strategy == "greedy":
            return greedy.decide(view, game, held, field)
        idle = roles.Job(self.role.value.role or roles.DEFENDER, view.own.place)
        company, players, duration_s = self._company, self.config.players, self.clock.iteration_s
        kept = company.goal_is_kept(view, field, players, game.sent_off, duration_s)
        stalled = self._stalls.watch(view, game, field, duration_s, self._jobs)
        self._tactics.passing.stalled = stalled
        self._jobs = NO_JOBS
        if company.watch(view, duration_s, game.sent_off) and view.localized:
            job = job_among_silent(view, rank_of(self._robot, players, game.sent_off), field, game)
        else:
            self._jobs = roles.assign(view, field, self.config.use_pressing, game, kept, stalled)
            job = self._steady.job(self._jobs.get(self._robot, idle), view, game.free_play, duration_s)
        if not self.config.use_roles and game.free_play and job.role != roles.GOALKEEPER:
            job = roles.Job(roles.ATTACKER, view.ball.place)
        order = self._tactics.decide(view, game, job, held, duration_s)
        return roles.PASSER if self._tactics.barred else job.role, order

    def _tell_pass(self, told: pass_agreement_t) -> None:
        said = self._tactics.passing.said
        told.receiver, told.passer = said.receiver, said.passer
        told.x_m, told.y_m = self._frame.point(*said.place)

    def _command(self, order: Order) -> None:
        place, heading_rad = self._frame.point(*order.place), self._frame.heading_rad(order.heading_rad)
        place = accepted_place(order.skill, place, self.config.field, self._bodies)
        if self._is_new(order.skill, place, heading_rad, order.speed_m_s):
            command = self.skill.value
            command.skill = order.skill
            command.x_m, command.y_m, command.heading_rad = *place, heading_rad
            command.speed_m_s = order.speed_m_s
            self._call = self.skill.call(expires_s=_EXPIRES_S)

    def _is_new(self, skill: str, place: Point, heading_rad: float, speed_m_s: float) -> bool:
        command = self.skill.value
        if (
            self._call is None
            or skill != command.skill
            or speed_m_s != command.speed_m_s
            or not plausible(*place, heading_rad)  # NaN differs from nothing
            or math.dist(place, (command.x_m, command.y_m)) > self.config.new_target_m
        ):
            return True
        if abs(wrap_rad(heading_rad - command.heading_rad)) > self.config.new_heading_rad:
            return True
        # The skill has ended and is wanted again; a lasting skill that is done continues.
        return self._call.finished and not (self._call.done and SKILLS[skill].lasting)
