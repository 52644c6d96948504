"""What the robot believes of the world: itself, ball, mates, opponents; and what it tells its team.

Where each comes from: the ball from its own mouth, its own camera, then the team's cameras (`estimation/ball_tracker`);
mates from their own messages; opponents from obstacles that the robot and its mates see and that are none of the team.
A mate that does not know where it is appears nowhere. While the robot itself does not know, only the sight of its mates
counts.
"""

import numpy as np
from pydantic import Field as Setting

from fwk.aspects.blackboard import Reads, Writes
from fwk.clock import Clock
from fwk.component import Component
from fwk.config import Config
from lcmtypes.robot import kicker_state_t, odometry_t
from lcmtypes.soccer import (
    ball_percept_t,
    obstacle_percepts_t,
    pose_t,
    role_t,
    team_inbox_t,
    team_message_t,
    world_model_t,
)
from procs.estimation.ball_tracker import BallTracker, Sighting
from procs.estimation.frames import Flags, Floats
from procs.estimation.own_view import OwnView, Seen
from procs.estimation.robot_tracks import RobotTracks, without_known
from procs.estimation.team import Mate, Team
from procs.estimation.world_messages import fill_team_message, fill_world_model, mate_of
from procs.field import Field

_STALE_S = 0.5  # older sightings of mates are not used
_ROBOT_SPEED_M_S = 1.0  # how far an obstacle may have moved since a mate saw it


class WorldModelConfig(Config):
    """Settings of the world model."""

    field: Field = Field()
    """Measures of the field."""
    ball_timeout_s: float = Setting(default=2.0, gt=0.0)
    """The ball is unknown when nobody has seen it for longer."""
    ball_rolling_m_s2: float = Setting(default=0.4, ge=0.0)
    """Deceleration of the rolling ball."""
    mouth_m: float = Setting(default=0.33, gt=0.0)
    """From the robot's middle to the middle of a ball that it holds."""
    opponent_timeout_s: float = Setting(default=1.0, gt=0.0)
    """An opponent is forgotten when nobody has seen it for longer."""
    mate_timeout_s: float = Setting(default=5.0, gt=0.0)
    """A mate is forgotten when it has said nothing for longer."""
    mate_radius_m: float = Setting(default=0.5, gt=0.0)
    """An obstacle this near to a mate is that mate; further away only if it was seen so poorly."""
    obstacle_deviation_m: float = Setting(default=0.6, gt=0.0)
    """Obstacles seen with a larger standard deviation are not used."""
    border_m: float = Setting(default=0.7, ge=0.0)
    """Obstacles further outside the field than that are no robots of the match."""
    use_team_sight: bool = True
    """Whether what mates see counts."""
    message_period: int = Setting(default=2, ge=1)
    """Ticks from one message to the team to the next."""
    sight_correlation: float = Setting(default=1.5, ge=1.0)
    """Frames that share one error of the camera; the filters widen sightings by it."""
    pose_correlation: float = Setting(default=6.0, ge=1.0)
    """Frames that share one error of the own pose."""
    team_correlation: float = Setting(default=2.0, ge=1.0)
    """Messages of a mate that share one error."""


class WorldModel(Component):
    """Publishes the world model in each tick, and ten times a second the robot's word to its team."""

    stage = "worldstate"

    pose: Reads[pose_t]
    odometry: Reads[odometry_t]
    ball_percept: Reads[ball_percept_t]
    obstacle_percepts: Reads[obstacle_percepts_t]
    kicker_state: Reads[kicker_state_t]
    role: Reads[role_t]
    team_inbox: Reads[team_inbox_t]
    world_model: Writes[world_model_t]
    team_message: Writes[team_message_t]
    config: WorldModelConfig
    clock: Clock

    def init(self) -> None:
        self._robot = self.name.rpartition("/")[0]
        self._ball = BallTracker()
        self._opponents = RobotTracks()
        self._team = Team()
        self._kicks = 0
        self._last_us = 0

    def loop(self) -> None:
        now_s = self.clock.now_s
        passed_s = self.clock.since_s(self._last_us) if self._last_us else self.clock.period_s
        self._last_us = self.clock.now_us
        view = OwnView(self.pose.value, self.odometry.value, known=self.pose.refreshed)
        told = [message for inbox in self.team_inbox.fresh for message in inbox.messages]
        told = [message for message in told if self._team.tell(mate_of(message))]
        mates = self._team.localized(now_s, self.config.mate_timeout_s)

        ball = view.ball(self.ball_percept.value if self.ball_percept.refreshed else ball_percept_t())
        if self.kicker_state.value.kicks != self._kicks:
            self._kicks = self.kicker_state.value.kicks
            self._ball.kick(float(view.pose[2]))
        self._ball.advance(passed_s, self.config.ball_timeout_s, self.config.ball_rolling_m_s2)
        self._follow_ball(view, ball, told, now_s)

        obstacles = view.obstacles(
            self.obstacle_percepts.value if self.obstacle_percepts.refreshed else obstacle_percepts_t()
        )
        obstacles = obstacles.only(self._strangers(obstacles.positions_m, obstacles.covariances_m2, mates, now_s))
        self._opponents.predict(passed_s, self.config.opponent_timeout_s)
        self._follow_opponents(view, obstacles, told, mates, now_s)

        fill_world_model(self.world_model.value, view, self._ball, mates, self._opponents, now_s)
        self.world_model.write()
        if self.clock.tick % self.config.message_period == 0:
            self._tell_team(view, ball, obstacles)

    def _follow_ball(self, view: OwnView, own: Seen, told: list[team_message_t], now_s: float) -> None:
        config = self.config
        if self.kicker_state.value.ball_held and view.localized:
            self._ball.hold(self._robot, view.held_ball(config.mouth_m))
        spread_m2 = own.spread_m2(config.sight_correlation, config.pose_correlation)
        for position_m, covariance_m2 in zip(own.positions_m, spread_m2, strict=True):
            self._ball.see(Sighting(self._robot, True, position_m, covariance_m2))
        for message in told:
            age_s = now_s - message.header.time_us / 1e6
            if config.use_team_sight and message.ball_visible and age_s <= _STALE_S:
                covariance_m2 = np.array(message.ball_covariance_m2) * config.team_correlation
                position_m = np.array((message.ball_x_m, message.ball_y_m))
                self._ball.see(Sighting(message.robot, False, position_m, covariance_m2, age_s))

    def _follow_opponents(
        self, view: OwnView, own: Seen, told: list[team_message_t], mates: list[Mate], now_s: float
    ) -> None:
        config = self.config
        team = [*mates, view.as_mate(self._robot, now_s)] if view.localized else mates
        self._opponents.see(own.positions_m, own.spread_m2(config.sight_correlation, config.pose_correlation))
        for message in told:
            age_s = now_s - message.header.time_us / 1e6
            if not (config.use_team_sight and message.obstacles and age_s <= _STALE_S):
                continue
            positions_m = np.array([(one.x_m, one.y_m) for one in message.obstacles])
            covariances_m2 = np.array([one.covariance_m2 for one in message.obstacles]) * config.team_correlation
            covariances_m2 += np.eye(2) * (_ROBOT_SPEED_M_S * age_s) ** 2
            others = self._strangers(positions_m, covariances_m2, team, now_s)
            self._opponents.see(positions_m[others], covariances_m2[others])

    def _strangers(self, positions_m: Floats, covariances_m2: Floats, team: list[Mate], now_s: float) -> Flags:
        """Which obstacles (n, 2) are on the field, seen well enough, and none of the team."""
        config = self.config
        half_m = np.array((config.field.half_length_m, config.field.half_width_m)) + config.border_m
        use: Flags = (np.abs(positions_m) <= half_m).all(axis=1)
        use &= np.trace(covariances_m2, axis1=1, axis2=2) <= config.obstacle_deviation_m**2
        team_m = np.array([mate.position_at(now_s) for mate in team])
        team_m2 = np.array([mate.covariance_at(now_s) for mate in team])
        use &= without_known(positions_m, covariances_m2, team_m, team_m2, config.mate_radius_m)
        return use

    def _tell_team(self, view: OwnView, ball: Seen, obstacles: Seen) -> None:
        message = self.team_message.value
        message.robot = self._robot
        message.role, message.intention = self.role.value.role, self.role.value.intention
        message.ball_held = self.kicker_state.value.ball_held
        fill_team_message(message, view, ball, obstacles)
        self.team_message.write()
