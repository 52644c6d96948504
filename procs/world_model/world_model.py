"""What the robot believes of the world: itself, ball, mates, opponents; and what it tells its team.

Where each comes from: the ball from its own mouth, its own camera, then the team's cameras (`ball_tracker`);
mates from their own messages; opponents from obstacles that the robot and its mates see and that are none of the team.
A mate that does not know where it is appears nowhere. While the robot itself does not know, only the sight of its mates
counts.
"""

from pydantic import Field as Setting

from fwk import Clock, Component, Config, Reads, Writes
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
from procs.model.field import Field
from procs.world_model.ball_tracker import BallTracker, Sighting
from procs.world_model.opponents import Opponents, OpponentSettings, strangers
from procs.world_model.own_view import OwnView
from procs.world_model.seen import Seen
from procs.world_model.team import Team
from procs.world_model.told import ball_of, mate_of, obstacles_of
from procs.world_model.world_messages import fill_team_message, fill_world_model

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
    opponent_timeout_s: float = Setting(default=0.6, gt=0.0)
    """An opponent is forgotten when nobody has seen it for longer."""
    mate_timeout_s: float = Setting(default=5.0, gt=0.0)
    """A mate is forgotten when it has said nothing for longer."""
    mate_radius_m: float = Setting(default=0.5, gt=0.0)
    """An obstacle this near to a mate is that mate; further away only if it was seen so poorly."""
    obstacle_deviation_m: float = Setting(default=0.4, gt=0.0)
    """Obstacles seen with a larger standard deviation are not used."""
    border_m: float = Setting(default=0.7, ge=0.0)
    """Obstacles further outside the field than that are no robots of the match."""
    use_team_sight: bool = True
    """Whether what mates see counts."""
    message_period: int = Setting(default=2, ge=1)
    """Ticks from one message to the team to the next."""
    sight_correlation: float = Setting(default=1.5, ge=1.0)
    """Frames that share one error of the camera; the filters widen sightings by it."""
    shake_s_m: float = Setting(default=0.7, ge=0.0)
    """How much more the camera shakes with each m/s that the robot drives, as a part of the percepts' deviation."""
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
        self._opponents = Opponents()
        self._team = Team()
        self._kicks = 0
        self._last_us = 0

    def loop(self) -> None:
        config, now_s = self.config, self.clock.now_s
        passed_s = self.clock.since_s(self._last_us) if self._last_us else self.clock.period_s
        self._last_us = self.clock.now_us
        view = OwnView(self.pose.value, self.odometry.value, self.pose.refreshed, config.shake_s_m)
        told = self._listen(now_s)
        mates = self._team.localized(now_s, config.mate_timeout_s)
        ball = view.ball(self.ball_percept.value) if self.ball_percept.refreshed else Seen.NOTHING
        self._follow_ball(view, ball, told, passed_s)
        obstacles = view.obstacles(self.obstacle_percepts.value) if self.obstacle_percepts.refreshed else Seen.NOTHING
        rules = self._opponent_settings()
        obstacles = strangers(obstacles, mates, now_s, rules)
        self._opponents.advance(passed_s, rules)
        self._opponents.see(obstacles.widened(config.sight_correlation, config.pose_correlation))
        team = [*mates, view.as_mate(self._robot, now_s)] if view.localized else mates
        for message in told if config.use_team_sight else []:
            seen = obstacles_of(message).widened(config.team_correlation, 1.0, _ROBOT_SPEED_M_S * self._age_s(message))
            self._opponents.see(strangers(seen, team, now_s, rules))
        fill_world_model(self.world_model.value, view, self._ball, mates, self._opponents.tracks, now_s)
        self.world_model.write()
        if self.clock.tick % config.message_period == 0:
            self._tell_team(view, ball, obstacles)

    def _listen(self, now_s: float) -> list[team_message_t]:
        """This tick's messages from mates, without those that are too old to tell where something is."""
        heard = [message for inbox in self.team_inbox.fresh for message in inbox.messages]
        told = []
        for message in heard:
            mate = mate_of(message, now_s)
            if mate is not None and mate.name != self._robot and self._team.tell(mate):
                told.append(message)
        return [message for message in told if self._age_s(message) <= _STALE_S]

    def _follow_ball(self, view: OwnView, own: Seen, told: list[team_message_t], passed_s: float) -> None:
        config, kicker = self.config, self.kicker_state.value
        if kicker.kicks != self._kicks:
            self._kicks = kicker.kicks
            self._ball.kick(float(view.pose[2]))
        self._ball.advance(passed_s, config.ball_timeout_s, config.ball_rolling_m_s2)
        if kicker.ball_held and view.localized:
            self._ball.hold(self._robot, view.held_ball(config.mouth_m))
        sightings = [(self._robot, own.widened(config.sight_correlation, config.pose_correlation), 0.0)]
        for message in told if config.use_team_sight else []:
            sightings.append(
                (message.robot, ball_of(message).widened(config.team_correlation, 1.0), self._age_s(message))
            )
        for robot, seen, age_s in sightings:
            for position_m, covariance_m2 in zip(seen.positions_m, seen.covariances_m2, strict=True):
                self._ball.see(Sighting(robot, robot == self._robot, position_m, covariance_m2, age_s))

    def _tell_team(self, view: OwnView, ball: Seen, obstacles: Seen) -> None:
        message = self.team_message.value
        message.robot = self._robot
        message.role, message.intention = self.role.value.role, self.role.value.intention
        message.ball_held = self.kicker_state.value.ball_held
        fill_team_message(message, view, ball, obstacles)
        self.team_message.write()

    def _age_s(self, message: team_message_t) -> float:
        return self.clock.since_s(message.header.time_us)

    def _opponent_settings(self) -> OpponentSettings:
        config = self.config
        return OpponentSettings(
            half_length_m=config.field.half_length_m + config.border_m,
            half_width_m=config.field.half_width_m + config.border_m,
            deviation_m=config.obstacle_deviation_m,
            mate_radius_m=config.mate_radius_m,
            timeout_s=config.opponent_timeout_s,
        )
