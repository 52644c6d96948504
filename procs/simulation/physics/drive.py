"""Motors, wheels and their grip: turns wheel commands into the forces that move a robot."""

import math

from procs.model.kinematics import SIN_60, Wheels
from procs.model.robot import RobotModel
from procs.simulation.physics.ball_body import GRAVITY_M_S2
from procs.simulation.physics.bodies import State
from procs.simulation.physics.delay import DelayLine
from procs.simulation.physics.settings import DriveSettings

_AT_REST: Wheels = (0.0, 0.0, 0.0)
_STABLE = 1.8  # largest share of an error of the slip that a step may take back; from 2 on the error would last


def longest_step_s(robot: RobotModel, settings: DriveSettings) -> float:
    """Returns the longest step in which the force of the wheels does not oscillate with their slip."""
    grip_1_s = settings.traction * GRAVITY_M_S2 / settings.full_slip_m_s
    driving_1_s, turning_1_s = grip_1_s / 2, grip_1_s * (robot.wheel_distance_m / robot.radius_m) ** 2 / robot.inertia
    return _STABLE / max(driving_1_s, turning_1_s)


class Drive:
    """Three motors with their wheels.

    A motor follows its command like a first-order lag up to its speed limit. A wheel's force grows with the speed of
    its rim over the ground and is limited by the grip, so hard acceleration makes wheels slip and encoders lie.
    """

    def __init__(self, robot: RobotModel, settings: DriveSettings, delay_s: float = 0.0) -> None:
        self.wheels_m_s: Wheels = _AT_REST
        """Rim speeds now."""
        self._stuck: frozenset[int] = frozenset()
        self._robot = robot
        self._motor_time_s = settings.motor_time_s
        self._distance_m, self._full_slip_m_s = robot.wheel_distance_m, settings.full_slip_m_s
        self._grip_n = settings.traction * robot.mass_kg * GRAVITY_M_S2 / 3
        self._line: DelayLine[Wheels] = DelayLine(round(delay_s * 1e6))
        self._commanded_m_s, self._wanted_m_s = _AT_REST, _AT_REST  # differ for wheels that are stuck
        self._begun_m_s, self._following_s = _AT_REST, 0.0  # rim speeds when that began to hold, and time since then
        self._travelled_m, self._travelled_s = _AT_REST, 0.0  # until then, from the last measurement on
        self._work_j = 0.0
        self._step_s, self._share = 0.0, 0.0  # duration of a step, and the share of its way that a motor comes in it

    @property
    def stuck(self) -> frozenset[int]:
        """Wheels, 0 to 2, that do not turn whatever their motors are told."""
        return self._stuck

    @stuck.setter
    def stuck(self, stuck: frozenset[int]) -> None:
        if stuck != self._stuck:
            self._stuck = stuck
            self._follow(self._commanded_m_s, self.wheels_m_s)

    def command(self, wheels_m_s: Wheels, now_us: int) -> None:
        """Takes the wanted rim speeds; the motors begin to follow after the delay. NaN stops its wheel."""
        limit = self._robot.wheel_limit_m_s
        first, second, third = (min(limit, max(-limit, 0.0 if math.isnan(speed) else speed)) for speed in wheels_m_s)
        self._line.put((first, second, third), now_us)

    def turn(self, now_us: int, duration_s: float, body: State) -> tuple[float, float, float]:
        """Lets the motors follow their commands for a while, and counts the work of the wheels.

        Args:
            now_us: logical time at the beginning.
            duration_s: the while.
            body: state of the robot's body at the beginning.

        Returns:
            Force of the wheels along x and y of the world frame in N, and their torque in Nm.
        """
        if self._line.next_us <= now_us:
            *_, newest = self._line.due(now_us)
            self._follow(newest, self.wheels_m_s)
        if duration_s != self._step_s:
            self._step_s, self._share = duration_s, -math.expm1(-duration_s / self._motor_time_s)
        share, grip_n, full_slip_m_s = self._share, self._grip_n, self._full_slip_m_s
        (rim_1, rim_2, rim_3), (to_1, to_2, to_3) = self.wheels_m_s, self._wanted_m_s
        rim_1 += (to_1 - rim_1) * share
        rim_2 += (to_2 - rim_2) * share
        rim_3 += (to_3 - rim_3) * share
        self.wheels_m_s = rim_1, rim_2, rim_3
        self._following_s += duration_s
        _, _, heading_rad, vx_m_s, vy_m_s, omega_rad_s = body
        cos, sin = math.cos(heading_rad), math.sin(heading_rad)
        # Speeds of the ground below the wheels as in `wheels_of`, whose call would cost a tenth of a step.
        ahead_m_s, left_m_s = SIN_60 * (cos * vx_m_s + sin * vy_m_s), cos * vy_m_s - sin * vx_m_s
        turn_m_s, side_m_s = self._distance_m * omega_rad_s, 0.5 * left_m_s
        first = grip_n * math.tanh((rim_1 - (side_m_s - ahead_m_s + turn_m_s)) / full_slip_m_s)
        second = grip_n * math.tanh((rim_2 - (turn_m_s - left_m_s)) / full_slip_m_s)
        third = grip_n * math.tanh((rim_3 - (ahead_m_s + side_m_s + turn_m_s)) / full_slip_m_s)
        power_w = first * rim_1 + second * rim_2 + third * rim_3
        if power_w > 0.0:
            self._work_j += power_w * duration_s
        ahead_n, left_n = SIN_60 * (third - first), 0.5 * (first + third) - second
        torque_nm = self._distance_m * (first + second + third)
        return cos * ahead_n - sin * left_n, sin * ahead_n + cos * left_n, torque_nm

    def halt(self) -> None:
        """Stops motors and wheels at once, and drops the commands that have not taken effect yet."""
        self._line.clear()
        self._follow(_AT_REST, _AT_REST)

    def take_work_j(self) -> float:
        """Returns the work of the wheels at their rims since the last call; braking counts nothing."""
        work_j, self._work_j = self._work_j, 0.0
        return work_j

    def measured_m_s(self) -> Wheels:
        """Returns the mean rim speeds since the last call; the present ones if no time has passed."""
        self._follow(self._commanded_m_s, self.wheels_m_s)
        if not self._travelled_s:
            return self.wheels_m_s
        first, second, third = (way_m / self._travelled_s for way_m in self._travelled_m)
        self._travelled_m, self._travelled_s = _AT_REST, 0.0
        return first, second, third

    def _follow(self, commanded_m_s: Wheels, wheels_m_s: Wheels) -> None:
        """Begins to follow a command at some rim speeds; wheels that are stuck stand still.

        The way until now counts: that of a first-order lag differs from the way at the wanted speed by its time
        constant times the change of speed.
        """
        time_s, lag_s = self._following_s, self._motor_time_s
        first, second, third = (
            way_m + to_m_s * time_s + (begun_m_s - rim_m_s) * lag_s
            for way_m, to_m_s, begun_m_s, rim_m_s in zip(
                self._travelled_m, self._wanted_m_s, self._begun_m_s, self.wheels_m_s, strict=True
            )
        )
        self._travelled_m, self._travelled_s = (first, second, third), self._travelled_s + time_s
        self._commanded_m_s, self._wanted_m_s = commanded_m_s, self._unless_stuck(commanded_m_s)
        self.wheels_m_s = self._begun_m_s = self._unless_stuck(wheels_m_s)
        self._following_s = 0.0

    def _unless_stuck(self, speeds_m_s: Wheels) -> Wheels:
        if not self._stuck:
            return speeds_m_s
        first, second, third = (0.0 if wheel in self._stuck else speed for wheel, speed in enumerate(speeds_m_s))
        return first, second, third
