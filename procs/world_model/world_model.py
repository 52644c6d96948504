"""World model of a robot: itself, the ball, mates and opponents; and its messages to the team.

Sources: the ball from its own mouth, its own camera, then the team's cameras (`ball_tracker`); mates from their own
messages; opponents from obstacles that the robot and its mates see and that are not robots of the team. A mate that
does not know its place is left out. While the robot itself does not know its place, only its mates' sightings count.
"""

from collections.abc import Sequence

import numpy as np
from pydantic import Field as Setting

from fwk import Clock, Component, Config, Reads, Writes, channel
from lcmtypes.robot import battery_state_t, kicker_state_t, odometry_t
from lcmtypes.soccer import (
    ball_percept_t,
    drive_target_t,
    game_state_t,
    obstacle_percepts_t,
    pose_t,
    role_t,
    team_inbox_t,
    team_message_t,
    world_model_t,
)
from procs.model.ball import BALL, BallModel
from procs.model.field import Field
from procs.model.frames import Floats
from procs.model.geometry import plausible
from procs.model.robot import ABSENT, PLAYERS, ROBOT, TEAM_NUMBERS, Players, RobotModel, player_of
from procs.model.units import US_PER_S
from procs.world_model.ball_track import Sighting
from procs.world_model.ball_tracker import BallTracker
from procs.world_model.contact import Robots
from procs.world_model.kicks import Kicks
from procs.world_model.opponents import OpponentSettings, strangers
from procs.world_model.own_view import OwnView
from procs.world_model.placed_ball import PlacedBall
from procs.world_model.possession import holder_of
from procs.world_model.robot_tracks import RobotTracks
from procs.world_model.seen import Seen
from procs.world_model.team import Mate, PlaceRow, Places, Team
from procs.world_model.told import ball_of, held_by, mate_of, obstacles_of
from procs.world_model.walls import Walls
from procs.world_model.world_messages import fill_ball, fill_kick, fill_plan, fill_team_message, fill_world_model

_STALE_S = 0.5  # older sightings of mates are not used, and older words of the own kicker
_BEHIND_WALL_M = 1.0  # a mate that believes itself further outside is lost
_RESTART_S = 2.0  # an agent that is silent for longer does not play
_IN_MOUTH_M2 = np.eye(2) * 0.03**2
"""Covariance of a ball somewhere in the mouth."""


class WorldModelConfig(Config):
    """Settings of the world model."""

    field: Field = Field()
    """Measures of the field."""
    ball_timeout_s: float = Setting(default=2.0, gt=0.0)
    """The ball is unknown after that time without a sighting."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""
    ball: BallModel = BALL
    """Size and friction of the ball."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    opponent_timeout_s: float = Setting(default=0.6, gt=0.0)
    """An opponent is forgotten after that time without a sighting."""
    mate_timeout_s: float = Setting(default=5.0, gt=0.0)
    """A mate is forgotten after that time without a message."""
    mate_radius_m: float = Setting(default=0.5, gt=0.0)
    """An obstacle this near to a mate is that mate; further away only if it was seen so poorly."""
    obstacle_deviation_m: float = Setting(default=0.4, gt=0.0)
    """Obstacles seen with a larger standard deviation are not used."""
    border_m: float = Setting(default=0.7, ge=0.0)
    """Obstacles further outside the field than that are not robots of the match."""
    use_team_sight: bool = True
    """Use the sightings of mates."""
    use_capture_times: bool = True
    """Let a sighting count at the time of its exposure; otherwise, to see what that brings, when it arrives."""
    use_ball_velocity: bool = True
    """Tell the velocity of the ball; otherwise, to see what that brings, the ball always seems to rest."""
    message_period_s: float = Setting(default=0.1, gt=0.0)
    """Time from one message to the team to the next; messages go with the nearest frame of the camera."""
    sight_correlation: float = Setting(default=1.0, ge=1.0)
    """Frames that share one error of the camera; the filters widen sightings by it."""
    shake_s_m: float = Setting(default=0.7, ge=0.0)
    """Growth of the camera's deviation with speed, as a share of the percepts' deviation for each m/s."""
    pose_correlation: float = Setting(default=2.0, ge=1.0)
    """Frames that share one error of the own pose."""
    team_correlation: float = Setting(default=1.0, ge=1.0)
    """Messages of a mate that share one error."""


class WorldModel(Component):
    """Publishes the world model in each tick, and every `message_period_s` a message to the team."""

    stage = "worldstate"

    pose: Reads[pose_t]
    odometry: Reads[odometry_t]
    ball_percept: Reads[ball_percept_t]
    obstacle_percepts: Reads[obstacle_percepts_t]
    kicker_state: Reads[kicker_state_t]
    role: Reads[role_t]
    drive_target: Reads[drive_target_t]
    battery_state: Reads[battery_state_t]
    team_inbox: Reads[team_inbox_t]
    game_state: Reads[game_state_t] = channel("world/game_state")
    world_model: Writes[world_model_t]
    team_message: Writes[team_message_t]
    config: WorldModelConfig
    clock: Clock

    def init(self) -> None:
        self._robot = self.name.rpartition("/")[0]
        self._ball = BallTracker(self.config.ball)
        self._opponents = RobotTracks()
        self._silent = RobotTracks()  # mates that do not tell their places
        self._apply_settings()
        self._team = Team()
        self._view: OwnView | None = None
        self._held = self._holds = False
        self._kicker_us = self._role_us = self.clock.now_us
        """Time of the newest message of the own kicker, and of the own agent."""
        self._kicks = Kicks()
        self._placed = PlacedBall()
        self._last_us = 0
        self._sent_us = -US_PER_S  # the first message is due at once
        self._untold_ball = self._untold_obstacles = Seen.NOTHING  # own sightings since the last message

    def loop(self) -> None:
        config, now_s = self.config, self.clock.now_s
        passed_s = self.clock.since_s(self._last_us) if self._last_us else self.clock.iteration_s
        self._last_us = self.clock.now_us
        known = self.pose.refreshed
        if self.kicker_state.refreshed:
            self._kicker_us = self.clock.now_us
        if self.role.refreshed:
            self._role_us = self.clock.now_us
        # A kicker that has fallen silent does not know whether the ball is in the mouth.
        self._holds = bool(self.kicker_state.value.ball_held) and self.clock.since_s(self._kicker_us) <= _STALE_S
        view = OwnView(self.pose.value, self.odometry.value, known, config.shake_s_m, self._view, passed_s)
        self._view = view
        told = self._listen(now_s)
        mates = self._team.localized(now_s, config.mate_timeout_s)
        team = Places([*mates, view.as_mate(self._robot, now_s)] if view.localized else mates)
        places = team.rows_at(now_s)
        self._follow_ball(view, places, told, passed_s)
        self._follow_robots(view, team, places, len(mates), told, passed_s)
        robots = self._opponents, self._silent
        fill_world_model(self.world_model.value, view, self._ball, mates, places, *robots, now_s)
        holder = holder_of(self.world_model.value, self._robot, self._holds, mates, now_s, self._mouth_m)
        self.world_model.value.ball_holder = holder
        if not config.use_ball_velocity:
            self.world_model.value.ball.vx_m_s = self.world_model.value.ball.vy_m_s = 0.0
        self.world_model.write()
        if self._message_due():
            self._tell_team(view)

    def config_changed(self) -> None:
        self._apply_settings()

    def _apply_settings(self) -> None:
        if self._ball.ball != self.config.ball:
            self._ball = BallTracker(self.config.ball)  # another ball, which no robot has seen yet
        self._walls = Walls.of(self.config.field, self.config.ball)
        self._rules = self._opponent_settings()
        self._opponents.robot_width_m = self._silent.robot_width_m = 2 * self.config.robot.radius_m
        player = player_of(self._robot, self.config.players)
        self._own_team = TEAM_NUMBERS[player.team] if player else 0
        self._mouth_m = self.config.robot.held_ball_m(self.config.ball)  # from the robot's middle to a held ball's

    def _listen(self, now_s: float) -> list[tuple[team_message_t, Mate]]:
        """Returns the messages of mates that arrived in this tick and are not older than known ones."""
        told = []
        for message in (message for inbox in self.team_inbox.fresh for message in inbox.messages):
            mate = mate_of(message, now_s) if self._is_of_team(message.robot) else None
            if mate is None or mate.name == self._robot:
                continue
            is_wrong = mate.localized and not self._is_inside_walls(mate)  # and with it all that it sees
            mate.localized = mate.localized and not is_wrong
            if (mate := self._team.tell(mate)) and not is_wrong:
                told.append((message, mate))
        return told if self.config.use_team_sight else []

    def _is_of_team(self, robot: str) -> bool:
        """Returns whether a sender may be a mate: robots of the other team, whose radio is heard, are not."""
        player = player_of(robot, self.config.players)
        return not (player and self._own_team) or TEAM_NUMBERS[player.team] == self._own_team

    def _is_inside_walls(self, mate: Mate) -> bool:
        """Returns whether a mate can be where it believes to be: inside the walls, give or take a large error."""
        field, (x_m, y_m) = self.config.field, mate.position_m.tolist()
        return field.in_field(x_m, y_m, field.border_m + _BEHIND_WALL_M)

    def _follow_ball(
        self, view: OwnView, team: Sequence[PlaceRow], told: list[tuple[team_message_t, Mate]], passed_s: float
    ) -> None:
        config, kicker = self.config, self.kicker_state.value
        has_kicker = self.kicker_state.has_value
        kicked = self._kicks.own(kicker, view, self._mouth_m, passed_s) if has_kicker else None
        if kicked:
            fill_kick(self.team_message.value, kicked, kicker.kicks, self.clock.now_us)
        kicks = self._kicks.of_mates(told, self.clock.now_us, self._mouth_m)
        for kick in [kicked, *kicks] if kicked else kicks:
            self._ball.kick(kick.velocity_m_s, kick.age_s - passed_s, kick.mouth, kick.lift_m_s)
        robots = self._robots_near(team, passed_s)
        wall = float(self._ball.known and self._walls.near(self._ball.track, passed_s))
        self._ball.advance(passed_s, config.ball_timeout_s, contact=wall, robots=robots, walls=self._walls)
        if self.game_state.has_value:
            self._take_placed_ball()
        if self._holds and view.localized and not kicked:
            self._take_held_ball(view)
        self._held = self._holds
        if self.ball_percept.refreshed:
            self._look_for_ball(view, self.ball_percept.value)
        self._take_mates_ball(told)

    def _take_placed_ball(self) -> None:
        """Takes the ball that the crew has put down: it acts in the tick after the state of the game says so."""
        spot_m = self._placed.spot_m(self.game_state.value, self._ball.known)
        if spot_m is not None:
            self._ball.put_down(spot_m)

    def _take_mates_ball(self, told: list[tuple[team_message_t, Mate]]) -> None:
        """Takes the ball that mates see, and the one in the mouth of a mate."""
        config = self.config
        for message, mate in told:
            seen = ball_of(message).widened(config.team_correlation, 1.0)
            age_s = self._age_s(message.ball_capture_us or message.header.time_us)
            self._see(self._sightings(mate.name, seen, message.ball_z_m, mate.position_m, age_s))
            told_s = self.clock.since_s(message.header.time_us)
            kicked_just_now = 0.0 <= (message.header.time_us - message.kick_us) / US_PER_S < self.clock.iteration_s
            if mate.holds_ball and mate.localized and told_s <= _STALE_S and not kicked_just_now:
                self._ball.hold(mate.name, *held_by(mate, self._mouth_m), told_s)

    def _take_held_ball(self, view: OwnView) -> None:
        """Takes the ball that the light barrier sees: its place and, unless it is still rolling in, its velocity."""
        state, covariance = view.held_ball(self._mouth_m)
        if not self._held and self._ball.known and view.rolls_in(self._ball.track.state, state):
            self._ball.see(Sighting(self._robot, True, state[:2], covariance[:2, :2] + _IN_MOUTH_M2))
        else:
            self._ball.hold(self._robot, state, covariance)

    def _robots_near(self, team: Sequence[PlaceRow], passed_s: float) -> Robots | None:
        """Returns the robots that may touch the ball in a tick, as they are at its end."""
        if not self._ball.known:
            return None
        rows = [(*row[:4], (row[4] + row[7]) / 2) for row in team]
        for tracks in filter(len, (self._opponents, self._silent)):
            variances_m2 = (tracks.covariances[:, 0, 0] + tracks.covariances[:, 1, 1]) / 2
            for (x_m, y_m, vx_m_s, vy_m_s), place_m2 in zip(tracks.states.tolist(), variances_m2.tolist(), strict=True):
                rows.append((x_m + vx_m_s * passed_s, y_m + vy_m_s * passed_s, vx_m_s, vy_m_s, place_m2))
        return Robots.near(self._ball.track, rows, self._mouth_m, self.config.robot.height_m)

    def _look_for_ball(self, view: OwnView, percept: ball_percept_t) -> None:
        """Takes the newest percept of the ball, and keeps its likeliest place for the next message to the team."""
        config, message, age_s = self.config, self.team_message.value, self._age_s(percept.capture_us)
        seen = self._untold_ball = view.ball(percept, age_s)
        message.ball_capture_us, message.ball_z_m = percept.capture_us or self.clock.now_us, percept.z_m
        sightings = []
        for candidate, height_m in ((seen, percept.z_m), *view.other_balls(percept, age_s)):
            widened = candidate.widened(config.sight_correlation, config.pose_correlation)
            sightings += self._sightings(self._robot, widened, height_m, view.pose[:2], age_s)
        self._see(sightings)

    def _sightings(self, robot: str, seen: Seen, height_m: float, observer_m: Floats, age_s: float) -> list[Sighting]:
        """Returns a sighting of the ball (0 or 1), unless it is too old, from the future or impossible."""
        if not (0.0 <= age_s <= _STALE_S and plausible(height_m)):
            return []
        own = robot == self._robot
        return [
            Sighting(robot, own, position_m, covariance_m2, age_s, height_m, observer_m)
            for position_m, covariance_m2 in zip(seen.positions_m, seen.covariances_m2, strict=True)
        ]

    def _see(self, sightings: list[Sighting]) -> None:
        """Hands what may be the ball in one frame to the tracker, the likeliest first."""
        if sightings:
            self._ball.see(*sightings)

    def _follow_robots(
        self,
        view: OwnView,
        team: Places,
        places: Sequence[PlaceRow],
        mates: int,
        told: list[tuple[team_message_t, Mate]],
        passed_s: float,
    ) -> None:
        """Takes the obstacles of the own camera and of mates; the first `mates` robots of the team are the others.

        `places` are those of the team now.
        """
        config, rules, now_s = self.config, self._rules, self.clock.now_s
        for tracks in filter(len, (self._opponents, self._silent)):
            tracks.predict(passed_s, config.opponent_timeout_s)
        if self.obstacle_percepts.refreshed:
            percepts = self.obstacle_percepts.value
            age_s = self._age_s(percepts.capture_us)
            known, own = team.first(mates), self._own_team
            seen = strangers(view.obstacles(percepts, age_s, own), known, now_s - age_s, rules)
            self._untold_obstacles = seen
            silent = view.mates(percepts, age_s, own, places[:mates], config.mate_radius_m)
            silent = strangers(silent, known, now_s - age_s, rules)
            self._silent.see(silent.positions_m, silent.covariances_m2, age_s)
            self.team_message.value.obstacles_capture_us = percepts.capture_us or self.clock.now_us
            seen = seen.widened(config.sight_correlation, config.pose_correlation)
            self._opponents.see(seen.positions_m, seen.covariances_m2, age_s)
        for message, _ in told:
            age_s = self._age_s(message.obstacles_capture_us or message.header.time_us)
            if 0.0 <= age_s <= _STALE_S:
                seen = obstacles_of(message).widened(config.team_correlation, 1.0)
                seen = strangers(seen, team, now_s - age_s, rules)
                self._opponents.see(seen.positions_m, seen.covariances_m2, age_s)

    def _message_due(self) -> bool:
        """Returns whether to send now: about once a period, and rather in a tick with a new sighting.

        Half a tick early is nearer to the period than half a tick late. A tick without a frame of the camera waits one
        tick for it; from then on messages keep its pace, and mates hear of a sighting as soon as they can.
        """
        caught_or_lost = self.team_message.value.ball_held != self._holds
        if caught_or_lost or self._kicks.untold:
            return True  # mates have to know at once
        half_tick_s = self.clock.iteration_s / 2
        passed_s = self.clock.since_s(self._sent_us) + half_tick_s
        if not self.ball_percept.refreshed:
            passed_s -= self.clock.iteration_s
        return passed_s >= self.config.message_period_s

    def _tell_team(self, view: OwnView) -> None:
        """Sends the own state with the newest own sightings, each once."""
        player = player_of(self._robot, self.config.players)
        message = self.team_message.value
        message.robot, message.number = self._robot, player.number if player else 0
        plays = self.clock.since_s(self._role_us) <= _RESTART_S
        role = self.role.value if plays else role_t(role=ABSENT)
        message.role, message.intention, message.agreement = role.role, role.intention, role.agreement
        message.ball_held = self._holds
        fill_team_message(message, view, self._untold_ball, self._untold_obstacles)
        fill_ball(message, self.world_model.value.ball, self.ball_percept.value.confidence)
        drives = self.drive_target.has_value and self.clock.since_s(self.drive_target.header.time_us) <= _STALE_S
        fill_plan(
            message,
            self.drive_target.value if drives else None,
            self.battery_state.value if self.battery_state.has_value else None,
        )
        self._untold_ball = self._untold_obstacles = Seen.NOTHING
        self._sent_us = self.clock.now_us
        self._kicks.note_message()
        self.team_message.write()

    def _age_s(self, capture_us: int) -> float:
        """Returns the time since an exposure; 0 stands for an exposure in this tick."""
        return self.clock.since_s(capture_us) if capture_us and self.config.use_capture_times else 0.0

    def _opponent_settings(self) -> OpponentSettings:
        config = self.config
        return OpponentSettings(
            half_length_m=config.field.half_length_m + config.border_m,
            half_width_m=config.field.half_width_m + config.border_m,
            deviation_m=config.obstacle_deviation_m,
            mate_radius_m=config.mate_radius_m,
        )
