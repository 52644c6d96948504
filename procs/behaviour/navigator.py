"""Drives the robot to its target, around obstacles and within its limits."""

import math
from collections.abc import Callable, Sequence
from functools import partial

from fwk import Clock, Component, Config, Reads, Writes, channel
from lcmtypes.robot import kicker_state_t, motor_command_t, odometry_t
from lcmtypes.soccer import drive_target_t, game_state_t, navigator_state_t, world_model_t
from procs.behaviour import formation, motion, obstacles
from procs.behaviour.bodies import Bodies
from procs.behaviour.game import game_of
from procs.behaviour.motion import Limits, Pose
from procs.behaviour.path import Disc, Way, find_way
from procs.behaviour.permitted import Permitted, is_field_player
from procs.behaviour.velocity_obstacles import safe_velocity
from procs.behaviour.view import Frame
from procs.model.ball import BALL, BallModel
from procs.model.field import Field, MatchField, Point
from procs.model.geometry import clamp, plausible, wrap_rad
from procs.model.kicker import tells_held
from procs.model.kinematics import STANDSTILL, Velocity
from procs.model.robot import PLAYERS, ROBOT, Players, RobotModel, number_of_player
from procs.model.teams import team_number_of_player

_BALL_M = 0.15  # between a robot and a ball that it avoids
_FORWARD = 0.8  # cosine of the largest angle between a change of velocity towards the ball and the heading


class NavigatorConfig(Config):
    """Settings of the way-finding."""

    limits: Limits = Limits()
    """Limits of the robot's motion."""
    field: MatchField = Field()
    """Measures of the field."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""
    robot: RobotModel = ROBOT
    """Geometry of all robots."""
    ball: BallModel = BALL
    """Size and friction of the ball."""
    target_timeout_s: float = 0.5
    """The robot stops when its target or its world model is older."""
    near_m: float = 0.08
    """Distance within which the target counts as reached."""
    near_rad: float = 0.1
    """Angle within which the heading counts as reached."""


class Navigator(Component):
    """Turns a target in the world frame into a velocity in the robot frame.

    A robot that does not know its place obeys `blind_drive`, a velocity in the robot frame, and else stands.
    """

    stage = "act"

    config: NavigatorConfig
    clock: Clock
    drive_target: Reads[drive_target_t]
    blind_drive: Reads[motor_command_t]
    world_model: Reads[world_model_t]
    game_state: Reads[game_state_t] = channel("world/game_state")
    odometry: Reads[odometry_t]
    kicker_state: Reads[kicker_state_t]
    motor_command: Writes[motor_command_t]
    navigator_state: Writes[navigator_state_t]

    def init(self) -> None:
        self._robot = self.name.rpartition("/")[0]
        self._before = STANDSTILL  # commanded, world frame
        self._direction_rad: float | None = None
        self._blind = False  # the commanded velocity is in the robot frame
        self.config_changed()

    def config_changed(self) -> None:
        self._bodies = Bodies.of(self.config.robot, self.config.ball)
        self._permitted = Permitted(self.config.field, self._bodies)
        self._goals = self._permitted.goals

    def loop(self) -> None:
        target, model, state = self.drive_target.value, self.world_model.value, self.navigator_state.value
        state.target_id = target.target_id
        state.error = navigator_state_t.OK
        here = plausible(model.x_m, model.y_m, model.heading_rad)
        if self._blind and model.localized and here:
            vx_m_s, vy_m_s = motion.turned(self._before.vx_m_s, self._before.vy_m_s, model.heading_rad)
            self._before, self._blind = Velocity(vx_m_s, vy_m_s, self._before.omega_rad_s), False
        if not here or not model.localized or not self._fresh(self.world_model):
            state.error, state.arrived, state.distance_m = navigator_state_t.LOST, False, 0.0
            if not self._drive_blind():
                self._stop(model.heading_rad if here and not self._blind else 0.0)
        elif target.stop or not self._fresh(self.drive_target) or not _makes_sense(target):
            state.arrived, state.distance_m = target.stop, 0.0
            self._stop(model.heading_rad)
        else:
            self._drive(target, model)
        self.navigator_state.write()

    def finalize(self) -> None:
        """Leaves the motors off."""
        self.motor_command.value = motor_command_t()
        self.motor_command.write()

    def _fresh(self, reader: Reads[drive_target_t] | Reads[world_model_t] | Reads[motor_command_t]) -> bool:
        return reader.has_value and self.clock.since_s(reader.header.time_us) <= self.config.target_timeout_s

    @property
    def _holds_ball(self) -> bool:
        return tells_held(self.kicker_state.value, self.clock.since_s(self.kicker_state.header.time_us))

    def _stop(self, heading_rad: float) -> None:
        self._direction_rad = None
        self._command(STANDSTILL, heading_rad)

    def _drive_blind(self) -> bool:
        """Drives as commanded in the robot frame; returns whether there is such a command."""
        blind, limits = self.blind_drive.value, self.config.limits
        sound = plausible(blind.vx_m_s, blind.vy_m_s, blind.omega_rad_s)
        if not (blind.enabled and sound and self._fresh(self.blind_drive)):
            return False
        self._direction_rad, self._blind = None, True
        speed_m_s = math.hypot(blind.vx_m_s, blind.vy_m_s)
        share = min(1.0, limits.speed_m_s / speed_m_s) if speed_m_s else 1.0
        omega_rad_s = clamp(blind.omega_rad_s, -limits.omega_rad_s, limits.omega_rad_s)
        self._command(Velocity(share * blind.vx_m_s, share * blind.vy_m_s, omega_rad_s), 0.0)
        return True

    def _drive(self, target: drive_target_t, model: world_model_t) -> None:
        config, state = self.config, self.navigator_state.value
        pose = self._pose(model)
        barred = is_field_player(model, self._robot, config.players)
        place = self._permitted.nearest(Point(target.x_m, target.y_m), barred)
        around = obstacles.discs(model, config.field, self._bodies, target.avoid_robots, target.avoid_ball)
        turn = self._goals.turning_place(pose.place, place, barred, around)
        possible = partial(self._possible, pose.place, barred)
        circle = self._circle(place)
        way = find_way(pose.place, turn, [*around, *circle], self._direction_rad, possible)
        if turn != place:
            way = way._replace(length_m=way.length_m + math.dist(turn, place))
        self._direction_rad = way.direction_rad
        turn_rad = wrap_rad(target.heading_rad - pose.heading_rad)
        state.distance_m = math.dist(pose.place, place)
        state.arrived = state.distance_m < config.near_m and abs(turn_rad) < config.near_rad
        if way.blocked:
            state.error = navigator_state_t.OBSTRUCTED
        # Where the wall keeps a robot from turning, its wheels report a turn all the same, and the robot loses its way.
        at_wall = obstacles.touches_wall(Point(model.x_m, model.y_m), config.field, self._bodies)
        wanted = self._velocity(target, way, 0.0 if at_wall else turn_rad)
        allowed = partial(self._outside, [*circle, *self._ball(target, model)], pose.place)
        wanted = Velocity(*allowed(Point(wanted.vx_m_s, wanted.vy_m_s)), wanted.omega_rad_s)
        if target.avoid_robots:
            wanted = self._give_way(wanted, pose.place, model, allowed)
        self._before = self._within_walls(self._before, pose.place)
        wanted = self._within_walls(wanted, pose.place)
        self._command(wanted, pose.heading_rad, allowed)

    def _possible(self, start: Point, barred: bool, end: Point) -> bool:
        """Returns whether a detour may turn at its end."""
        return obstacles.inside_walls(end, self.config.field, self._bodies) and self._goals.is_open(start, end, barred)

    def _circle(self, place: Point) -> list[Disc]:
        """Returns the circle of a set piece; none for a robot that is sent into it, or has its ball: the taker."""
        team = team_number_of_player(self._robot, self.config.players)
        circle = formation.circle(game_of(self.game_state.value, team, Frame(1.0)))
        sent_in = circle is not None and math.dist(place, circle.middle) <= circle.radius_m
        return [] if circle is None or sent_in or self._holds_ball else [circle]

    def _ball(self, target: drive_target_t, model: world_model_t) -> list[Disc]:
        """Returns the room that a robot leaves to a ball that it avoids."""
        ball = model.ball
        if not (target.avoid_ball and ball.known and plausible(ball.x_m, ball.y_m)):
            return []
        return [Disc(Point(ball.x_m, ball.y_m), self._bodies.beside_m + _BALL_M)]

    def _outside(self, discs: Sequence[Disc], place: Point, velocity_m_s: Point) -> Point:
        """Returns the velocity, limited to what keeps the robot out of the discs."""
        for disc in discs:
            velocity_m_s = obstacles.braked_at_disc(velocity_m_s, place, disc, self.config.limits)
        return velocity_m_s

    def _within_walls(self, velocity: Velocity, place: Point) -> Velocity:
        config = self.config
        over_ground_m_s = Point(velocity.vx_m_s, velocity.vy_m_s)
        slower = obstacles.braked_at_walls(
            over_ground_m_s, place, config.field, self._bodies, config.limits.braking_m_s2
        )
        return Velocity(*slower, velocity.omega_rad_s)

    def _give_way(
        self, wanted: Velocity, place: Point, model: world_model_t, allowed: Callable[[Point], Point]
    ) -> Velocity:
        players = self.config.players
        number = number_of_player(self._robot, players)
        movers = obstacles.movers(model, self.config.limits.latency_s, number, players)
        now_m_s = Point(self._before.vx_m_s, self._before.vy_m_s)
        wanted_m_s, apart_m = Point(wanted.vx_m_s, wanted.vy_m_s), obstacles.apart_m(self._bodies)
        limits = self.config.limits
        velocity = safe_velocity(
            wanted_m_s, now_m_s, place, movers, apart_m, limits.acceleration_m_s2, limits.speed_m_s, allowed
        )
        return Velocity(*velocity, wanted.omega_rad_s)

    def _pose(self, model: world_model_t) -> Pose:
        """Returns the robot's pose when the wheels will begin to follow the next command.

        Until then they follow the commands on their way, from the measured velocity to the newest commanded one.
        """
        measured, latency_s = self.odometry.value, self.config.limits.latency_s
        here = Pose(Point(model.x_m, model.y_m), model.heading_rad)
        commanded = Velocity(*motion.turned(*self._before[:2], -model.heading_rad), self._before.omega_rad_s)
        velocity = Velocity(measured.vx_m_s, measured.vy_m_s, measured.omega_rad_s)
        if not plausible(*velocity):
            velocity = STANDSTILL
        return motion.ahead_in_time(here, motion.mean(velocity, commanded), latency_s)

    def _velocity(self, target: drive_target_t, way: Way, turn_rad: float) -> Velocity:
        limits = self.config.limits
        limit_m_s = min(target.speed_m_s, limits.speed_m_s) if target.speed_m_s > 0 else limits.speed_m_s
        speed_m_s = motion.speed_to_go_m_s(way.length_m, target.end_speed_m_s, limit_m_s, limits)
        if math.isfinite(way.free_m) and way.free_m < way.length_m:
            speed_m_s = min(speed_m_s, motion.speed_to_go_m_s(way.free_m, 0.2, limit_m_s, limits))
        omega_limit_rad_s = limits.ball_omega_rad_s if self._holds_ball else limits.omega_rad_s
        return Velocity(
            speed_m_s * math.cos(way.direction_rad),
            speed_m_s * math.sin(way.direction_rad),
            motion.turning_to_go_rad_s(turn_rad, omega_limit_rad_s, limits),
        )

    def _command(
        self,
        wanted: Velocity,
        heading_rad: float,
        allowed: Callable[[Point], Point] = lambda velocity_m_s: velocity_m_s,
    ) -> None:
        limits, held = self.config.limits, self._holds_ball
        change_m_s2 = self._ball_change_m_s2(wanted, heading_rad) if held else limits.acceleration_m_s2
        turn_rad_s2 = limits.ball_angular_acceleration_rad_s2 if held else limits.angular_acceleration_rad_s2
        period_s = self.clock.iteration_s
        wanted = motion.braked_first(self._before, wanted, allowed, change_m_s2 * period_s)
        self._before = motion.approach(self._before, wanted, period_s, change_m_s2, turn_rad_s2)
        # The robot turns on while it follows the command, so the command is meant for the middle of that time.
        middle_rad = heading_rad + self._before.omega_rad_s * period_s / 2
        command = self.motor_command.value
        command.vx_m_s, command.vy_m_s = motion.turned(self._before.vx_m_s, self._before.vy_m_s, -middle_rad)
        if held:
            command.vy_m_s -= limits.ball_pivot * self._before.omega_rad_s * self._bodies.held_ball_m
        command.omega_rad_s = self._before.omega_rad_s
        command.enabled = True
        self.motor_command.write()

    def _ball_change_m_s2(self, wanted: Velocity, heading_rad: float) -> float:
        """Returns the limit of the acceleration with the ball: a change towards the ball presses it into the mouth."""
        limits = self.config.limits
        forward, _ = motion.turned(
            wanted.vx_m_s - self._before.vx_m_s, wanted.vy_m_s - self._before.vy_m_s, -heading_rad
        )
        change_m_s = math.hypot(wanted.vx_m_s - self._before.vx_m_s, wanted.vy_m_s - self._before.vy_m_s)
        return limits.ball_push_m_s2 if forward > _FORWARD * change_m_s else limits.ball_acceleration_m_s2


def _makes_sense(target: drive_target_t) -> bool:
    return plausible(target.x_m, target.y_m, target.heading_rad, target.speed_m_s, target.end_speed_m_s)
