"""Motors, wheels and their grip: turns wheel commands into the forces that move a robot."""

import math

from procs.physics.delay import DelayLine
from procs.physics.kinematics import SIN_60, Velocity, Wheels, wheels_of
from procs.physics.settings import RobotSettings

GRAVITY_M_S2 = 9.81


class Drive:
    """Three motors with their wheels.

    A motor follows its command like a first-order lag up to its speed limit. A wheel's force grows with the speed of
    its rim over the ground and is limited by the grip, so hard acceleration makes wheels slip and encoders lie.
    """

    def __init__(self, robot: RobotSettings, delay_s: float = 0.0) -> None:
        self.wheels_m_s: Wheels = (0.0, 0.0, 0.0)
        """Rim speeds now."""
        self._robot = robot
        self._grip_n = robot.traction * robot.mass_kg * GRAVITY_M_S2 / 3
        self._line: DelayLine[Wheels] = DelayLine(round(delay_s * 1e6))
        self._wanted_m_s: Wheels = (0.0, 0.0, 0.0)
        self._travelled_m = [0.0, 0.0, 0.0]
        self._measured_s = 0.0

    def command(self, wheels_m_s: Wheels, now_us: int) -> None:
        """Rim speeds wanted; the motors begin to follow after the delay."""
        limit = self._robot.wheel_limit_m_s
        first, second, third = (min(limit, max(-limit, speed)) for speed in wheels_m_s)
        self._line.put((first, second, third), now_us)

    def turn_motors(self, now_us: int, duration_s: float) -> None:
        """Lets the motors follow their commands for a while."""
        for wanted in self._line.due(now_us):
            self._wanted_m_s = wanted
        share = 1 - math.exp(-duration_s / self._robot.motor_time_s)
        (a, b, c), (to_a, to_b, to_c) = self.wheels_m_s, self._wanted_m_s
        self.wheels_m_s = a + (to_a - a) * share, b + (to_b - b) * share, c + (to_c - c) * share
        for index, speed in enumerate(self.wheels_m_s):
            self._travelled_m[index] += speed * duration_s
        self._measured_s += duration_s

    def push(self, velocity: Velocity) -> tuple[float, float, float]:
        """Force in N along x and y of the robot frame and torque in Nm on a body that moves at `velocity`."""
        distance_m, full_slip_m_s = self._robot.wheel_distance_m, self._robot.full_slip_m_s
        ground = wheels_of(velocity, distance_m)
        first, second, third = (
            self._grip_n * math.tanh((rim - floor) / full_slip_m_s)
            for rim, floor in zip(self.wheels_m_s, ground, strict=True)
        )
        return SIN_60 * (third - first), 0.5 * (first + third) - second, distance_m * (first + second + third)

    def measured_m_s(self) -> Wheels:
        """Mean rim speeds since the last call; the speeds now if no time has passed."""
        if not self._measured_s:
            return self.wheels_m_s
        first, second, third = (way / self._measured_s for way in self._travelled_m)
        self._travelled_m = [0.0, 0.0, 0.0]
        self._measured_s = 0.0
        return first, second, third
