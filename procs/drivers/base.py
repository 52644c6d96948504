"""Driver of the wheels: converts velocities into rim speeds, and measured speeds into odometry."""

from collections.abc import Iterable
from itertools import groupby
from typing import Annotated

from pydantic import Field as Setting
from pydantic import PositiveFloat

from fwk import Clock, Component, Config, Logger, Reads, Writes
from lcmtypes.robot import motor_command_t, odometry_t, wheel_command_t, wheel_state_t
from procs.drivers.odometry import Odometry
from procs.drivers.ramp import Ramp, within_wheel_limit
from procs.drivers.silence import Silence
from procs.model.expected_errors import EXPECTED
from procs.model.kinematics import (
    STANDSTILL,
    Velocity,
    Wheels,
    velocity_covariance_of,
    velocity_of,
    wheels_of,
)
from procs.model.realism import Realism, chosen
from procs.model.robot import ROBOT, RobotModel
from procs.model.units import US_PER_S
from procs.model.wheel_messages import WheelReader

_PLAUSIBLE = 2.0  # wheels cannot turn faster than this multiple of their limit, even when they are pushed
_LONGEST_GAP_S = 0.5  # a measurement after a longer silence does not count for the silence

_Deviation = Annotated[float, Setting(ge=0.0, le=1.0)]


class BaseConfig(Config):
    """Settings of the wheels' driver."""

    robot: RobotModel = ROBOT
    """Geometry of the robot, and the limit of its wheels."""
    speed_m_s: PositiveFloat = 3.5
    """Highest speed over the ground. That of the wheels."""
    acceleration_m_s2: PositiveFloat = 3.0
    """Highest acceleration over the ground. An estimate of the wheels' grip; Falcons use 1.0, Tribots 5.0."""
    braking_m_s2: PositiveFloat = 4.0
    """Highest deceleration over the ground. Tribots: 4.0."""
    omega_rad_s: PositiveFloat = 6.0
    """Highest turning speed. An estimate; Tribots 3, CAMBADA 9.4."""
    angular_acceleration_rad_s2: PositiveFloat = 20.0
    """Highest change of the turning speed. An estimate; Tribots 12."""
    command_timeout_s: PositiveFloat = 0.25
    """The robot brakes to a standstill when its newest motor command is older than this."""
    realism: Realism = "realistic"
    """Errors of the wheels that the covariance allows for: none, friendly, realistic or harsh."""
    wheel_scale_sd: _Deviation | None = None
    """Relative error of each wheel's speed that stays the same for a long time, such as that of a worn wheel; null: by
    `realism`."""
    wheel_noise_sqrt_s: _Deviation | None = None
    """Relative error of the distance that a wheel measures in one second; in a tick it is larger by the square root of
    the number of ticks in a second. Null: by `realism`."""
    wheel_resolution_m_s: _Deviation = 0.001
    """Error in m/s of a wheel that hardly turns: the step from one value of the encoder to the next; an estimate."""


class Base(Component):
    """Publishes odometry when sensors are read, and wheel commands when actuators act.

    A robot whose wheels are not measured any more stands still as far as its odometry knows.
    """

    stage = ("sensor_acquire", "act_exec")

    wheel_state: Reads[wheel_state_t]
    motor_command: Reads[motor_command_t]
    odometry: Writes[odometry_t]
    wheel_command: Writes[wheel_command_t]
    config: BaseConfig
    clock: Clock
    log: Logger

    def init(self) -> None:
        self._odometry = Odometry()
        self._measured_us: int | None = None  # time of the newest measurement
        self._wheels = WheelReader("wheel_state", "ignored", self.log.error)
        self._silence = Silence(
            "no speeds of the wheels for {silent_s:.2f} s: the robot counts as standing", self.log.warning
        )
        self._late = False
        self._driven_us = -1  # time of the newest wheel command
        self._apply_settings(STANDSTILL)

    def config_changed(self) -> None:
        self._apply_settings(self._ramp.velocity)

    def loop(self) -> None:
        # Both stages take measurements: one that arrives between the stages must not be missing in the sum.
        for measured_us, states in groupby(self.wheel_state.fresh, lambda state: state.header.time_us):
            self._add(measured_us, states)
        self._silence.go_on(self.clock)
        if self.clock.stage == "act_exec":
            self._drive()
        else:
            self._report()

    def finalize(self) -> None:
        """Leaves the wheels stopped."""
        self.wheel_command.value = wheel_command_t()
        self.wheel_command.value.wheel_m_s = list(wheels_of(STANDSTILL, self.config.robot.wheel_distance_m))
        self.wheel_command.write()

    def _apply_settings(self, velocity: Velocity) -> None:
        """Takes errors and limits from the settings; the ramp continues from `velocity` (robot frame)."""
        config = self.config
        self._errors = chosen(EXPECTED[config.realism], config)
        self._ramp = Ramp(
            config.speed_m_s,
            config.acceleration_m_s2,
            config.braking_m_s2,
            config.omega_rad_s,
            config.angular_acceleration_rad_s2,
        )
        self._ramp.velocity = velocity

    def _add(self, measured_us: int, states: Iterable[wheel_state_t]) -> None:
        """Adds the possible ones of the measurements of one tick to the odometry.

        Wheels that are measured several times in a tick turned with the mean speed.
        """
        possible = []
        for state in states:
            wheels_m_s = self._possible(state)
            if wheels_m_s is not None:
                possible.append(wheels_m_s)
                self.odometry.value.capture_us = state.capture_us or measured_us
        if not possible:
            return
        self._silence.end(self.clock)
        passed_s = -1.0 if self._measured_us is None else (measured_us - self._measured_us) / US_PER_S
        self._measured_us = measured_us
        if not 0 <= passed_s <= _LONGEST_GAP_S:
            passed_s = self.clock.period_s
        first, second, third = (sum(speeds) / len(possible) for speeds in zip(*possible, strict=True))
        self._odometry.advance(velocity_of((first, second, third), self.config.robot.wheel_distance_m), passed_s)
        self.odometry.value.velocity_covariance = self._covariance((first, second, third))

    def _possible(self, state: wheel_state_t) -> Wheels | None:
        """Returns the measured speeds; None if they are impossible."""
        wheels_m_s = self._wheels.read(state.measured_m_s, state.header.writer)
        if wheels_m_s is None:
            return None
        if not all(abs(speed) <= _PLAUSIBLE * self.config.robot.wheel_limit_m_s for speed in wheels_m_s):
            self.log.warning(f"wheel speeds {', '.join(map(str, wheels_m_s))} m/s are impossible; ignored")
            return None
        return wheels_m_s

    def _covariance(self, wheels_m_s: Wheels) -> list[list[float]]:
        """Returns the covariance (3, 3) of the velocity, from the errors of wheels that were measured for one tick."""
        config, errors = self.config, self._errors
        relative = errors.wheel_scale_sd**2 + errors.wheel_noise_sqrt_s**2 / self.clock.period_s
        standing_m2_s2 = config.wheel_resolution_m_s**2
        first, second, third = wheels_m_s
        variances_m2_s2 = (
            relative * first * first + standing_m2_s2,
            relative * second * second + standing_m2_s2,
            relative * third * third + standing_m2_s2,
        )
        return velocity_covariance_of(variances_m2_s2, config.robot.wheel_distance_m)

    def _report(self) -> None:
        report, odometry = self.odometry.value, self._odometry
        if self._silence.is_long:
            odometry.velocity, report.velocity_covariance = STANDSTILL, [[0.0] * 3] * 3  # not known
        report.x_m, report.y_m, report.heading_rad = odometry.x_m, odometry.y_m, odometry.heading_rad
        report.vx_m_s, report.vy_m_s, report.omega_rad_s = odometry.velocity
        report.path_length_m = odometry.path_length_m
        self.odometry.write()

    def _drive(self) -> None:
        """Commands the wheels to follow the wanted velocity within the limits."""
        robot = self.config.robot
        usual_s = self.clock.iteration_s
        passed_s = usual_s if self._driven_us < 0 else self.clock.since_s(self._driven_us)
        self._driven_us = self.clock.now_us
        velocity = self._ramp.advance(self._wanted(), min(passed_s, max(_LONGEST_GAP_S, usual_s)))
        possible = within_wheel_limit(velocity, robot.wheel_limit_m_s, robot.wheel_distance_m)
        self._ramp.velocity = possible  # from a faster one it would begin to brake late
        self.wheel_command.value.wheel_m_s = list(wheels_of(possible, robot.wheel_distance_m))
        self.wheel_command.write()

    def _wanted(self) -> Velocity:
        """Returns the commanded velocity, or standstill if the command is late; reports the first late tick."""
        command = self.motor_command.value
        age_s = self.clock.since_s(self.motor_command.header.time_us)
        late = self.motor_command.has_value and age_s > self.config.command_timeout_s
        if late and not self._late:
            self.log.warning(f"no motor command for {age_s:.2f} s: braking")
        self._late = late
        if late or not command.enabled:
            return STANDSTILL
        return Velocity(command.vx_m_s, command.vy_m_s, command.omega_rad_s)
