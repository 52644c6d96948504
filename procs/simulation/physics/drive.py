"""Motors, wheels and their grip: turns wheel commands into the forces that move a robot."""

import math

from procs.model.kinematics import SIN_60, Wheels
from procs.model.robot import RobotModel
from procs.simulation.physics.ball_body import GRAVITY_M_S2
from procs.simulation.physics.delay import DelayLine
from procs.simulation.physics.settings import DriveSettings

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
        self.wheels_m_s: Wheels = (0.0, 0.0, 0.0)
        """Rim speeds now."""
        self.stuck: frozenset[int] = frozenset()
        """Wheels, 0 to 2, that do not turn whatever their motors are told."""
        self._robot = robot
        self._motor_time_s = settings.motor_time_s
        self._distance_m, self._full_slip_m_s = robot.wheel_distance_m, settings.full_slip_m_s
        self._grip_n = settings.traction * robot.mass_kg * GRAVITY_M_S2 / 3
        self._line: DelayLine[Wheels] = DelayLine(round(delay_s * 1e6))
        self._wanted_m_s: Wheels = (0.0, 0.0, 0.0)
        self._travelled_m: Wheels = (0.0, 0.0, 0.0)
        self._measured_s = 0.0
        self._work_j = 0.0
        self._step_s, self._share = 0.0, 0.0  # duration of a step, and the share of its way that a motor comes in it

    def command(self, wheels_m_s: Wheels, now_us: int) -> None:
        """Takes the wanted rim speeds; the motors begin to follow after the delay. NaN stops its wheel."""
        limit = self._robot.wheel_limit_m_s
        first, second, third = (min(limit, max(-limit, 0.0 if math.isnan(speed) else speed)) for speed in wheels_m_s)
        self._line.put((first, second, third), now_us)

    def turn(
        self, now_us: int, duration_s: float, vx_m_s: float, vy_m_s: float, omega_rad_s: float
    ) -> tuple[float, float, float]:
        """Lets the motors follow their commands for a while, and counts the work of the wheels.

        Args:
            now_us: logical time at the beginning.
            duration_s: the while.
            vx_m_s: velocity of the body, robot frame.
            vy_m_s: the same to the left.
            omega_rad_s: turning of the body.

        Returns:
            Force of the wheels along x and y of the robot frame in N, and their torque in Nm.
        """
        if self._line.next_us <= now_us:
            *_, self._wanted_m_s = self._line.due(now_us)
        if duration_s != self._step_s:
            self._step_s, self._share = duration_s, -math.expm1(-duration_s / self._motor_time_s)
        share, catching_up_s = self._share, self._motor_time_s * self._share
        (a, b, c), (to_a, to_b, to_c) = self.wheels_m_s, self._wanted_m_s
        if self.stuck:
            a, b, c = (0.0 if wheel in self.stuck else speed for wheel, speed in enumerate((a, b, c)))
            to_a, to_b, to_c = (0.0 if wheel in self.stuck else speed for wheel, speed in enumerate((to_a, to_b, to_c)))
        rim_1, rim_2, rim_3 = self.wheels_m_s = (
            a + (to_a - a) * share,
            b + (to_b - b) * share,
            c + (to_c - c) * share,
        )
        way_a, way_b, way_c = self._travelled_m
        self._travelled_m = (
            way_a + to_a * duration_s + (a - to_a) * catching_up_s,
            way_b + to_b * duration_s + (b - to_b) * catching_up_s,
            way_c + to_c * duration_s + (c - to_c) * catching_up_s,
        )
        self._measured_s += duration_s
        distance_m, full_slip_m_s, grip_n = self._distance_m, self._full_slip_m_s, self._grip_n
        # Speeds of the ground below the wheels as in `wheels_of`, whose call would cost a tenth of a step.
        turn_m_s, side_m_s, ahead_m_s = distance_m * omega_rad_s, 0.5 * vy_m_s, SIN_60 * vx_m_s
        first = grip_n * math.tanh((rim_1 - (side_m_s - ahead_m_s + turn_m_s)) / full_slip_m_s)
        second = grip_n * math.tanh((rim_2 - (turn_m_s - vy_m_s)) / full_slip_m_s)
        third = grip_n * math.tanh((rim_3 - (ahead_m_s + side_m_s + turn_m_s)) / full_slip_m_s)
        power_w = first * rim_1 + second * rim_2 + third * rim_3
        if power_w > 0.0:
            self._work_j += power_w * duration_s
        return SIN_60 * (third - first), 0.5 * (first + third) - second, distance_m * (first + second + third)

    def halt(self) -> None:
        """Stops motors and wheels at once, and drops the commands that have not taken effect yet."""
        self._line.clear()
        self.wheels_m_s = self._wanted_m_s = (0.0, 0.0, 0.0)

    def take_work_j(self) -> float:
        """Returns the work of the wheels at their rims since the last call; braking counts nothing."""
        work_j, self._work_j = self._work_j, 0.0
        return work_j

    def measured_m_s(self) -> Wheels:
        """Returns the mean rim speeds since the last call; the present ones if no time has passed."""
        if not self._measured_s:
            return self.wheels_m_s
        first, second, third = (way / self._measured_s for way in self._travelled_m)
        self._travelled_m = (0.0, 0.0, 0.0)
        self._measured_s = 0.0
        return first, second, third
