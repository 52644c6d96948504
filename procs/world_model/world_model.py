"""World model of a robot: itself, the ball, mates and opponents; and its messages to the team.

Sources:

- the ball (`ball_follower`): the robot's own mouth, its own camera, then the cameras of mates;
- mates: their own messages, and the own camera when these are late; a mate that does not know its place is left out;
- opponents: obstacles that the robot and its mates see and that are not robots of the team.

While the robot itself does not know its place, only the sightings of its mates count. A place far outside the walls is
none.
"""

from collections.abc import Sequence

from fwk import Clock, Component, Reads, Writes, channel
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
from procs.model.geometry import plausible
from procs.model.kicker import tells_held
from procs.model.robot import ABSENT, TEAM_NUMBERS, player_of
from procs.model.units import US_PER_S
from procs.world_model.ball_follower import BallFollower, BallNews
from procs.world_model.frame_pace import FramePace, NewFrames
from procs.world_model.opponents import strangers
from procs.world_model.own_view import OwnView
from procs.world_model.possession import holder_of
from procs.world_model.quiet_mates import QuietMates, in_time
from procs.world_model.robot_tracks import RobotTracks
from procs.world_model.seen import Seen
from procs.world_model.settings import RESTART_S, STALE_S, WorldModelConfig, counts
from procs.world_model.team import Mate, PlaceRow, Places, Team
from procs.world_model.told import mate_of, obstacles_of
from procs.world_model.world_messages import fill_ball, fill_kick, fill_plan, fill_team_message, fill_world_model

_BEHIND_WALL_M = 1.0  # a robot that believes it is further outside the walls is lost


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
        self._ball = BallFollower(self._robot, self.config)
        self._opponents = RobotTracks()
        self._silent = RobotTracks()  # mates that do not state their places, or not at present
        self._quiet = QuietMates(self._silent)
        self._frames = FramePace()  # of the camera that sees the obstacles
        self._percepts = FramePace()  # of percepts of the ball, in the ticks in which they come
        self._new_balls, self._new_obstacles = NewFrames(), NewFrames()
        self._apply_settings()
        self._team = Team()
        self._view: OwnView | None = None
        self._holds = False
        self._role_us = self._odometry_us = self.clock.now_us  # time of the newest message of the own agent and base
        self._last_us = 0
        self._sent_us = -US_PER_S  # the first message is due at once
        self._untold_obstacles = Seen.NOTHING  # own sightings since the last message

    def loop(self) -> None:
        config, now_s = self.config, self.clock.now_s
        passed_s = self.clock.since_s(self._last_us) if self._last_us else self.clock.iteration_s
        self._last_us = self.clock.now_us
        known = self.pose.refreshed and self._is_inside_walls(self.pose.value.x_m, self.pose.value.y_m)
        if self.role.refreshed:
            self._role_us = self.clock.now_us
        self._holds = tells_held(self.kicker_state.value, self.clock.since_s(self.kicker_state.header.time_us))
        if self.odometry.refreshed:
            self._odometry_us = self.clock.now_us
        odometry = self.odometry.value if self.clock.since_s(self._odometry_us) <= STALE_S else odometry_t()
        view = OwnView(self.pose.value, odometry, known, self._shaking, self._view, passed_s)
        self._view = view
        told = self._listen(now_s)
        mates = self._team.localized(now_s, config.mate_timeout_s)
        seen = self._quiet.as_seen(mates, passed_s, now_s)
        team = Places([*seen, view.as_mate(self._robot, now_s)] if view.localized else seen)
        places = team.rows_at(now_s)
        self._follow_ball(view, places, told, passed_s)
        self._follow_robots(view, team, mates, told, passed_s)
        self._quiet.find(mates, now_s, config.mate_radius_m)
        if self._quiet.ids:
            places = Places(self._quiet.as_seen(mates, 0.0, now_s)).rows_at(now_s)
        robots = self._opponents, self._silent, self._quiet.ids
        fill_world_model(self.world_model.value, view, self._ball.tracker, mates, places, *robots, now_s)
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
        self._ball.apply(self.config)
        self._rules = self.config.opponent_settings
        self._shaking = self.config.shaking
        self._opponents.robot_width_m = self._silent.robot_width_m = 2 * self.config.robot.radius_m
        player = player_of(self._robot, self.config.players)
        self._own_team = TEAM_NUMBERS[player.team] if player else 0
        self._mouth_m = self.config.mouth_m

    def _listen(self, now_s: float) -> list[tuple[team_message_t, Mate]]:
        """Returns the messages of mates that arrived in this tick, without those that arrived before."""
        told = []
        for message in (message for inbox in self.team_inbox.fresh for message in inbox.messages):
            mate = mate_of(message, now_s) if self._is_of_team(message.robot) else None
            if mate is None or mate.name == self._robot:
                continue
            x_m, y_m = mate.position_m.tolist()
            is_wrong = mate.localized and not self._is_inside_walls(x_m, y_m)  # its sightings are wrong, too
            mate.localized = mate.localized and not is_wrong
            if (mate := self._team.note(mate)) and not is_wrong:
                told.append((message, mate))
        return told if self.config.use_team_sight else []

    def _is_of_team(self, robot: str) -> bool:
        """Returns whether a sender may be a mate: the radio also receives robots of the other team."""
        player = player_of(robot, self.config.players)
        return not (player and self._own_team) or TEAM_NUMBERS[player.team] == self._own_team

    def _is_inside_walls(self, x_m: float, y_m: float) -> bool:
        """Returns whether a robot can be where it believes it is: inside the walls, allowing for a large error."""
        field = self.config.field
        return field.in_field(x_m, y_m, field.border_m + _BEHIND_WALL_M)

    def _follow_ball(
        self, view: OwnView, team: Sequence[PlaceRow], told: list[tuple[team_message_t, Mate]], passed_s: float
    ) -> None:
        """Tracks the ball, and notes a kick and the newest percept for the next message to the team."""
        percept = self.ball_percept.value if self.ball_percept.refreshed else None
        if percept and not self._new_balls.takes(percept.capture_us):
            percept = None
        if percept:
            self._percepts.note(self.clock.now_us)
        news = BallNews(
            now_us=self.clock.now_us,
            passed_s=passed_s,
            iteration_s=self.clock.iteration_s,
            holds=self._holds,
            kicker=self.kicker_state.value if self.kicker_state.has_value else None,
            game=self.game_state.value if self.game_state.has_value else None,
            percept=percept,
            told=told,
        )
        others = (*self._opponents.rows_after(passed_s), *self._silent.rows_after(passed_s))
        robots = [*[(*row[:4], (row[4] + row[7]) / 2) for row in team], *others]
        kicked = self._ball.follow(news, view, robots)
        message = self.team_message.value
        if kicked:
            fill_kick(message, kicked, self.kicker_state.value.kicks, self.clock.now_us)
        if percept and plausible(percept.z_m):
            message.ball_capture_us, message.ball_z_m = percept.capture_us or self.clock.now_us, percept.z_m

    def _follow_robots(
        self,
        view: OwnView,
        team: Places,
        mates: Sequence[Mate],
        told: list[tuple[team_message_t, Mate]],
        passed_s: float,
    ) -> None:
        """Tracks opponents and silent mates by the obstacles of the own camera and of mates.

        The robots of the `team` are the `mates`, late ones as they are seen, and the robot itself.
        """
        config, rules, now_s = self.config, self._rules, self.clock.now_s
        for tracks in filter(len, (self._opponents, self._silent)):
            tracks.predict(passed_s, config.opponent_timeout_s)
        percepts = self.obstacle_percepts.value
        age_s = config.age_s(percepts.capture_us, self.clock.now_us)
        if self.obstacle_percepts.refreshed and self._new_obstacles.takes(percepts.capture_us) and counts(age_s):
            self._frames.note(percepts.capture_us or self.clock.now_us)
            next_s = self._frames.next_s
            own, known, in_touch = self._own_team, team.first(len(mates)), in_time(mates, now_s)
            heard = known if len(in_touch) == len(mates) else Places(in_touch)
            seen = strangers(view.obstacles(percepts, age_s, own), known, now_s - age_s, rules)
            self._untold_obstacles = seen
            silent = view.mates(percepts, age_s, own, heard.rows_at(now_s), config.mate_radius_m)
            silent = strangers(silent, heard, now_s - age_s, rules)
            self._silent.see(silent.positions_m, silent.covariances_m2, age_s, next_s)
            self.team_message.value.obstacles_capture_us = percepts.capture_us or self.clock.now_us
            seen = seen.widened(config.sight_correlation, config.pose_correlation)
            self._opponents.see(seen.positions_m, seen.covariances_m2, age_s, next_s)
        for message, mate in told:
            exposed_us = message.obstacles_capture_us or message.header.time_us
            age_s = config.age_s(exposed_us, self.clock.now_us)
            if counts(age_s):
                next_s = self._team.next_s(mate, exposed_us, config.message_period_s)
                seen = obstacles_of(message).widened(config.team_correlation, 1.0)
                seen = strangers(seen, team, now_s - age_s, rules)
                self._opponents.see(seen.positions_m, seen.covariances_m2, age_s, next_s)

    def _message_due(self) -> bool:
        """Returns whether to send a message now: once a period, preferably in a tick with a new frame of the camera.

        Messages go with the frame of the camera that is nearest to the period: up to half of the time between frames
        early. If the tick has no new frame, the message waits one tick for it. From then on messages keep the pace of
        the camera, and mates get sightings as early as possible.
        """
        caught_or_lost = self.team_message.value.ball_held != self._holds
        if caught_or_lost or self._ball.kicks.untold:
            return True  # mates need to know at once
        iteration_s, passed_s = self.clock.iteration_s, self.clock.since_s(self._sent_us)
        if not self.ball_percept.refreshed:
            return passed_s - iteration_s / 2 >= self.config.message_period_s
        return passed_s + max(iteration_s, self._percepts.interval_s) / 2 >= self.config.message_period_s

    def _tell_team(self, view: OwnView) -> None:
        """Sends the own state with the newest own sightings, each once."""
        player = player_of(self._robot, self.config.players)
        message = self.team_message.value
        message.robot, message.number = self._robot, player.number if player else 0
        plays = self.clock.since_s(self._role_us) <= RESTART_S
        role = self.role.value if plays else role_t(role=ABSENT)
        message.role, message.intention, message.agreement = role.role, role.intention, role.agreement
        message.ball_held = self._holds
        message.kicks = min(message.kicks, self.kicker_state.value.kicks)  # of a driver that began anew
        fill_team_message(message, view, self._ball.untold, self._untold_obstacles)
        fill_ball(message, self.world_model.value.ball, self.ball_percept.value.confidence)
        drives = self.drive_target.has_value and self.clock.since_s(self.drive_target.header.time_us) <= STALE_S
        fill_plan(
            message,
            self.drive_target.value if drives else None,
            self.battery_state.value if self.battery_state.has_value else None,
        )
        self._ball.untold = self._untold_obstacles = Seen.NOTHING
        self._sent_us = self.clock.now_us
        self._ball.kicks.note_message()
        self.team_message.write()
