"""Limits speed and acceleration between the wanted velocity of a base and its wheel commands."""

import math

from procs.model.kinematics import STANDSTILL, Velocity, wheels_of


class Ramp:
    """Follows a wanted velocity (robot frame) as fast as the limits allow, straight towards it.

    The limits apply over the ground: a robot that turns while it drives straight on changes its velocity in its own
    frame, but does not accelerate.
    """

    def __init__(
        self,
        speed_m_s: float,
        acceleration_m_s2: float,
        braking_m_s2: float,
        omega_rad_s: float,
        angular_acceleration_rad_s2: float,
    ) -> None:
        """Begins at a standstill; the arguments are the limits, over the ground."""
        self.velocity = STANDSTILL
        self._speed_m_s = speed_m_s
        self._acceleration_m_s2 = acceleration_m_s2
        self._braking_m_s2 = braking_m_s2
        self._omega_rad_s = omega_rad_s
        self._angular_acceleration_rad_s2 = angular_acceleration_rad_s2

    def advance(self, wanted: Velocity, duration_s: float) -> Velocity:
        """Returns the velocity (robot frame) to command for the next `duration_s`.

        A wanted velocity with a value that is not finite counts as standstill.
        """
        if not all(map(math.isfinite, wanted)):
            wanted = STANDSTILL
        omega = min(self._omega_rad_s, max(-self._omega_rad_s, wanted.omega_rad_s))
        turn_limit = self._angular_acceleration_rad_s2 * duration_s
        omega = self.velocity.omega_rad_s + min(turn_limit, max(-turn_limit, omega - self.velocity.omega_rad_s))
        turn_rad = (self.velocity.omega_rad_s + omega) / 2 * duration_s
        cos, sin = math.cos(turn_rad), math.sin(turn_rad)
        before_x = cos * self.velocity.vx_m_s + sin * self.velocity.vy_m_s
        before_y = cos * self.velocity.vy_m_s - sin * self.velocity.vx_m_s
        speed_m_s = math.hypot(wanted.vx_m_s, wanted.vy_m_s)
        scale = min(1.0, self._speed_m_s / speed_m_s) if speed_m_s else 1.0
        change_x, change_y = wanted.vx_m_s * scale - before_x, wanted.vy_m_s * scale - before_y
        slower = speed_m_s * scale < math.hypot(self.velocity.vx_m_s, self.velocity.vy_m_s)
        limit_m_s = (self._braking_m_s2 if slower else self._acceleration_m_s2) * duration_s
        change_m_s = math.hypot(change_x, change_y)
        share = min(1.0, limit_m_s / change_m_s) if change_m_s else 1.0
        self.velocity = Velocity(before_x + change_x * share, before_y + change_y * share, omega)
        return self.velocity


def within_wheel_limit(velocity: Velocity, wheel_limit_m_s: float, wheel_distance_m: float) -> Velocity:
    """Returns the velocity (robot frame), scaled down if necessary so that no wheel exceeds its limit.

    `wheel_limit_m_s` is the highest rim speed, `wheel_distance_m` the distance from the robot's middle to a wheel.
    """
    fastest_m_s = max(map(abs, wheels_of(velocity, wheel_distance_m)))
    scale = min(1.0, wheel_limit_m_s / fastest_m_s) if fastest_m_s else 1.0
    return Velocity(*(part * scale for part in velocity))
