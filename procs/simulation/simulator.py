"""Simulator of the match: moves the world by one tick, and replaces the hardware of every robot."""

import math
from collections.abc import Collection, Iterable
from typing import Annotated, Literal, TypeVar

import numpy as np
from pydantic import BeforeValidator, PositiveFloat, ValidationInfo, field_validator
from pydantic import Field as Setting

from fwk import Clock, Component, Config, Each, Logger, Reads, Serves, TimeSource, Writes, channel
from lcmtypes.robot import battery_state_t, imu_t, kicker_drive_t, kicker_sensor_t, wheel_command_t, wheel_state_t
from lcmtypes.soccer import (
    ball_placement_t,
    field_t,
    freeze_world_t,
    ground_truth_t,
    hold_robot_t,
    match_events_t,
    place_ball_t,
    place_robot_t,
    reset_world_t,
)
from procs.model.ball import BALL, BallModel
from procs.model.events import Event
from procs.model.field import Field, MatchField, Point
from procs.model.kinematics import Wheels
from procs.model.realism import Realism
from procs.model.robot import PLAYERS, ROBOT, Players, RobotModel, player_of
from procs.model.units import US_PER_S, heading_mistake
from procs.model.wheel_messages import WheelReader
from procs.simulation.field_crew import FieldCrew
from procs.simulation.physics.kick_mechanism import KickerCommand
from procs.simulation.physics.realism import Changes, noise_of
from procs.simulation.physics.reports import event_message, field_message, robot_message
from procs.simulation.physics.room import Room
from procs.simulation.physics.sensors import Encoders, Imu
from procs.simulation.physics.settings import PhysicsSettings
from procs.simulation.physics.start_places import Pose, three_numbers
from procs.simulation.physics.world import World

Starts = dict[str, Annotated[tuple[float, float, float], BeforeValidator(three_numbers)]]
StuckWheels = dict[str, tuple[Literal[1, 2, 3], ...]]
Named = TypeVar("Named", Starts, StuckWheels, list[str])
_STOPPED: Wheels = (0.0, 0.0, 0.0)
_BATTERY_US = US_PER_S  # from one message about the batteries to the next
_FIELD_TICKS = 100  # from one message with the measures of the field to the next, for readers that come late


class SimulatorConfig(Config):
    """Settings of the world."""

    field: MatchField = Setting(Field(), frozen=True)
    """Measures of the field."""
    players: Players = dict(PLAYERS)
    """Team and number of each robot."""
    robot: RobotModel = Setting(ROBOT, frozen=True)
    """Geometry of all robots."""
    ball: BallModel = Setting(BALL, frozen=True)
    """Size and friction of the ball."""
    physics: PhysicsSettings = Setting(PhysicsSettings(), frozen=True)
    """Motors, mouths, kickers, contacts."""
    realism: Realism = Setting("realistic", frozen=True)
    """Deviation of actuators and sensors from the ideal: none, friendly, realistic or harsh."""
    errors: Changes = Setting({}, frozen=True)
    """Errors and delays that differ from those of the preset, by name: `{drive_delay_s: 0.1}`."""
    starts: Starts = Setting({}, frozen=True)
    """Starts of the robots: name to x in m, y in m and heading in rad (world frame); others take the default place."""
    command_timeout_s: PositiveFloat = 0.25
    """Wheels and ball handling stop when their command is older, and older than the previous tick."""
    stuck_wheels: StuckWheels = {}
    """Faults: wheels that do not turn, by robot: `{cyan3: [2]}`."""
    silent_imus: list[str] = []
    """Faults: robots whose compass, gyro and accelerometers send nothing: `[cyan3]`."""

    @field_validator("ball")
    @classmethod
    def _fits_into_goals(cls, ball: BallModel, info: ValidationInfo) -> BallModel:
        """Refuses goals into which no ball can go; the field has been checked before."""
        if "field" in info.data:
            for name in ("goal_width_m", "goal_height_m", "goal_depth_m"):
                measure_m = getattr(info.data["field"], name)
                if measure_m <= 2 * ball.radius_m:
                    raise ValueError(
                        f"no ball of {2 * ball.radius_m:g} m goes into a goal with a {name} of {measure_m:g} m"
                    )
        return ball

    @field_validator("players")
    @classmethod
    def _different(cls, players: Players, info: ValidationInfo) -> Players:
        """Refuses two robots of one team and number, as far as the robots are known."""
        if mistake := _double(_players_of(_robots_of(info) or (), players), players):
            raise ValueError(mistake)
        return players

    @field_validator("starts", "stuck_wheels", "silent_imus")
    @classmethod
    def _of_robots(cls, named: Named, info: ValidationInfo) -> Named:
        """Refuses robots that the system does not have, as far as its robots are known."""
        robots = _robots_of(info)
        if robots is not None and (mistakes := _strangers(named, robots)):
            raise ValueError("; ".join(mistakes))
        return named

    @field_validator("stuck_wheels")
    @classmethod
    def _each_once(cls, stuck: StuckWheels) -> StuckWheels:
        for robot, wheels in stuck.items():
            if double := next((wheel for wheel in wheels if wheels.count(wheel) > 1), None):
                raise ValueError(f"{robot}: wheel {double} occurs twice; name each wheel once")
        return stuck

    @field_validator("starts")
    @classmethod
    def _possible(cls, starts: Starts, info: ValidationInfo) -> Starts:
        """Refuses starts where no robot has room, and headings in degrees; field and robot have been checked before."""
        found = {robot: heading_mistake(heading_rad) for robot, (_, _, heading_rad) in starts.items()}
        mistakes = [f"{robot}: {mistake}" for robot, mistake in found.items() if mistake]
        if {"field", "robot"} <= info.data.keys():
            places = {robot: Point(x_m, y_m) for robot, (x_m, y_m, _) in starts.items()}
            mistakes += Room(info.data["field"]).mistakes_in(places, info.data["robot"].radius_m)
        if mistakes:
            raise ValueError("; ".join(mistakes))
        return starts


class Simulator(Component):
    """Simulates the true world and determines the system's time. Its robots are the namespaces with a wheel command."""

    stage = "pre_loop"

    wheel_command: Each[Reads[wheel_command_t]] = channel("*/wheel_command")
    kicker_drive: Each[Reads[kicker_drive_t]] = channel("*/kicker_drive")
    ball_placement: Reads[ball_placement_t] = channel("world/ball_placement")
    place_robot: Serves[place_robot_t]
    hold_robot: Serves[hold_robot_t]
    place_ball: Serves[place_ball_t]
    freeze: Serves[freeze_world_t]
    reset: Serves[reset_world_t]
    field: Writes[field_t]
    ground_truth: Writes[ground_truth_t]
    match_events: Writes[match_events_t]
    wheel_state: Each[Writes[wheel_state_t]] = channel("*/wheel_state")
    kicker_sensor: Each[Writes[kicker_sensor_t]] = channel("*/kicker_sensor")
    imu: Each[Writes[imu_t]] = channel("*/imu")
    battery_state: Each[Writes[battery_state_t]] = channel("*/battery_state")
    config: SimulatorConfig
    clock: Clock
    time_source: TimeSource
    rng: np.random.Generator
    log: Logger

    def init(self) -> None:
        """Sets the world up.

        Raises:
            ValueError: a start or a fault is that of a robot that does not exist, or two robots have one number.
        """
        config, noise = self.config, noise_of(self.config.realism, self.config.errors)
        robots = sorted(self.wheel_command)
        for setting in ("starts", "stuck_wheels", "silent_imus"):
            for mistake in _strangers(getattr(config, setting), robots):
                raise ValueError(f"{self.name}: {setting}: {mistake}")
        self._players = _players_of(robots, config.players)
        if mistake := _double(self._players, config.players):
            raise ValueError(f"{self.name}: players: {mistake}")
        starts = {robot: Pose(*pose) for robot, pose in config.starts.items()}
        self._world = World(
            robots,
            self.rng,
            config.field,
            config.robot,
            config.ball,
            config.physics,
            noise,
            starts,
            self._players,
        )
        self._crew = FieldCrew(self._world, config.field)
        self._encoders = {robot: Encoders(noise, self.rng) for robot in robots}
        self._imus = {robot: Imu(noise, self.rng) for robot in robots}
        self._before_us = -1
        self._battery_us = -_BATTERY_US  # the first message is due at once
        self._empty: set[str] = set()  # robots whose motors stand because their batteries are empty
        self._placement_id = 0
        self._wheels = {
            robot: WheelReader(f"{robot}/wheel_command", f"{robot} stops", self.log.error) for robot in robots
        }
        self._spoil_wheels()

    def config_changed(self) -> None:
        self._spoil_wheels()

    def loop(self) -> None:
        now_us = self.clock.now_us
        passed_us = self.clock.period_us if self._before_us < 0 else max(0, now_us - self._before_us)
        self._before_us = now_us
        self.time_source.next_us = now_us + self.clock.period_us
        self._place_ball()
        self._crew.carry_out(self.place_robot, self.hold_robot, self.place_ball, self.freeze, self.reset)
        for name in self._crew.put_down:
            self._imus[name].put_down()
        events: list[Event] = []
        if not self._crew.frozen:
            self._command_robots()
            events = self._world.advance(passed_us)
        self._sense(passed_us / US_PER_S)
        self._check_batteries()
        self._report_truth()
        report = self.match_events.value
        report.ball_in_field = self._world.ball_in_field
        report.ball_x_m, report.ball_y_m = self._world.ball.body.position
        report.ball_speed_m_s = 0.0 if self._crew.frozen else self._world.ball.speed_m_s
        report.last_touch, report.frozen = self._world.last_touch, self._crew.frozen
        report.events = [event_message(event, self._players) for event in events]
        self.match_events.write()
        if self.clock.tick % _FIELD_TICKS == 1:
            self.field.value = field_message(self.config.field)
            self.field.write()

    def _spoil_wheels(self) -> None:
        for setting in ("stuck_wheels", "silent_imus"):
            for mistake in _strangers(getattr(self.config, setting), self._world.robots):
                self.log.warning(f"{setting}: {mistake}")
        for name, robot in self._world.robots.items():
            robot.drive.stuck = frozenset(wheel - 1 for wheel in self.config.stuck_wheels.get(name, ()))

    def _place_ball(self) -> None:
        for placement in self.ball_placement.fresh:
            if placement.placement_id == self._placement_id:
                continue
            self._placement_id = placement.placement_id
            if math.isfinite(placement.x_m) and math.isfinite(placement.y_m):
                if not self._world.place_ball(placement.x_m, placement.y_m):
                    self.log.warning(
                        f"ball placement {placement.placement_id}: there is no room left for the ball between the walls"
                    )
            else:
                self.log.warning(
                    f"ball placement {placement.placement_id} asks for ({placement.x_m}, {placement.y_m}); ignored"
                )

    def _command_robots(self) -> None:
        world = self._world
        for robot, reader in self.wheel_command.items():
            obeys = self._may_move(robot) and self._is_fresh(reader)
            wheels_m_s = self._wanted_m_s(robot, reader) if obeys else _STOPPED
            world.robots[robot].drive.command(wheels_m_s, world.time_us)
        for robot in world.kickers:
            if robot not in self.kicker_drive:
                continue
            drives = self.kicker_drive[robot]
            wishes = [_command(drive) for drive in drives.fresh]
            obeys = self._may_move(robot) and self._is_fresh(drives)
            for wish in wishes if obeys else [KickerCommand(0, 0.0, dribble=False)]:
                world.kickers[robot].command(wish, world.time_us)

    def _wanted_m_s(self, robot: str, reader: Reads[wheel_command_t]) -> Wheels:
        """Returns the rim speeds of a command; one for another number of wheels stops the robot."""
        return self._wheels[robot].read(reader.value.wheel_m_s, reader.header.writer) or _STOPPED

    def _may_move(self, robot: str) -> bool:
        return robot not in self._empty and robot not in self._crew.held

    def _is_fresh(self, reader: Reads[wheel_command_t] | Reads[kicker_drive_t]) -> bool:
        age_s = self.clock.since_s(reader.header.time_us)
        return reader.has_value and age_s <= max(self.config.command_timeout_s, self.clock.period_s)

    def _sense(self, passed_s: float) -> None:
        # All sensors are read, with or without a reader: readers must not change the random numbers.
        now_us = self.clock.now_us
        for name, robot in self._world.robots.items():
            body = robot.body
            moves = not self._crew.frozen
            wheels_m_s = self._encoders[name].read(robot.drive.measured_m_s() if moves else _STOPPED, passed_s)
            turning_rad_s = body.angular_velocity if moves else 0.0
            inertial = self._imus[name].read(body.angle, turning_rad_s, body.velocity, passed_s)
            if name in self.wheel_state:
                state = self.wheel_state[name].value
                state.measured_m_s, state.capture_us = wheels_m_s, now_us
                self.wheel_state[name].write()
            if name in self.imu and name not in self.config.silent_imus:
                imu = self.imu[name].value
                imu.heading_rad, imu.yaw_rate_rad_s, imu.ax_m_s2, imu.ay_m_s2, *deviations = inertial
                imu.heading_sd_rad, imu.yaw_rate_sd_rad_s, imu.acceleration_sd_m_s2 = deviations
                imu.capture_us = now_us
                self.imu[name].write()
            if name in self.kicker_sensor:
                sensor, kicker = self.kicker_sensor[name].value, self._world.kickers[name]
                sensor.ball_held = kicker.mouth.holds_ball
                sensor.charged = kicker.charged(self._world.time_us)
                sensor.charge = kicker.charge(self._world.time_us)
                sensor.kick_id, sensor.capture_us = kicker.kick_id, now_us
                self.kicker_sensor[name].write()

    def _check_batteries(self) -> None:
        now_us, batteries = self.clock.now_us, self._world.batteries
        empty = {name for name, battery in batteries.items() if battery.empty}
        for name in sorted(empty - self._empty):
            self.log.warning(f"the battery of {name} is empty: motors and kicker stop; world/reset puts a full one in")
            self._world.kickers[name].drop_commands()
        self._empty = empty
        if now_us - self._battery_us < _BATTERY_US:
            return
        self._battery_us = now_us
        for name, battery in batteries.items():
            if name in self.battery_state:
                state = self.battery_state[name].value
                state.charge, state.voltage_v, state.capture_us = battery.charge, battery.voltage_v, now_us
                self.battery_state[name].write()

    def _report_truth(self) -> None:
        truth, ball, players = self.ground_truth.value, self._world.ball, self._players
        moves = not self._crew.frozen
        truth.ball_x_m, truth.ball_y_m = ball.body.position
        truth.ball_z_m = ball.z_m
        truth.ball_vx_m_s, truth.ball_vy_m_s = ball.body.velocity if moves else (0.0, 0.0)
        truth.ball_vz_m_s = ball.vz_m_s if moves else 0.0
        truth.robots = [robot_message(robot, players.get(name), moves) for name, robot in self._world.robots.items()]
        self.ground_truth.write()


def _robots_of(info: ValidationInfo) -> list[str] | None:
    """Returns the robots of the system whose settings are checked, in order; None if they are not known yet."""
    if info.context is None:
        return None
    return sorted(name.rpartition("/")[0] for name in info.context["channels"]["wheel_command"])


def _strangers(named: Iterable[str], robots: Collection[str]) -> list[str]:
    """Returns a sentence for each name that no robot has."""
    known = ", ".join(robots) or "none"
    return [f"no robot '{name}'; there are: {known}" for name in sorted(set(named) - set(robots))]


def _players_of(robots: Iterable[str], stated: Players) -> Players:
    found = {robot: player_of(robot, stated) for robot in robots}
    return {robot: player for robot, player in found.items() if player}


def _double(players: Players, stated: Players) -> str:
    """Names two robots of one team and number. Names give those of robots without an entry in the stated players."""
    for robot in sorted(players, key=lambda name: (name in stated, name)):
        player, rivals = players[robot], players if robot in stated else stated
        for other in sorted(name for name, rival in rivals.items() if rival == player and name != robot):
            pair = f"{min(robot, other)} and {max(robot, other)} are both {player.team} {player.number}"
            return pair if robot in stated else f"{pair}; players.{robot} is missing"
    return ""


def _command(drive: kicker_drive_t) -> KickerCommand:
    """Returns the command of a driver; an impossible elevation counts as 0."""
    elevation_rad = drive.elevation_rad if 0.0 <= drive.elevation_rad <= math.pi / 3 else 0.0
    return KickerCommand(drive.kick_id, drive.kick_m_s, drive.dribble, elevation_rad)
