"""Kinematics of a base with three omnidirectional wheels at 60, 180 and 300 degrees from forward.

Robot frame: x forward, y left, angles counter-clockwise. A positive rim speed turns the robot counter-clockwise.
"""

import math
from typing import NamedTuple

SIN_60 = math.sqrt(3) / 2

WHEEL_ANGLES_DEG = (60, 180, 300)
"""Direction from the robot's middle to each wheel, from forward."""

Wheels = tuple[float, float, float]
"""One value for each wheel, in the order of the angles."""


class Velocity(NamedTuple):
    """Velocity of a body, in its own frame unless another frame is named."""

    vx_m_s: float
    vy_m_s: float
    omega_rad_s: float


STANDSTILL = Velocity(0.0, 0.0, 0.0)


def wheels_of(velocity: Velocity, wheel_distance_m: float) -> Wheels:
    """Returns rim speeds in m/s without slip; `wheel_distance_m` is from the robot's middle to a wheel."""
    vx, vy, omega = velocity
    turn = wheel_distance_m * omega
    return -SIN_60 * vx + 0.5 * vy + turn, -vy + turn, SIN_60 * vx + 0.5 * vy + turn


def velocity_of(wheels: Wheels, wheel_distance_m: float) -> Velocity:
    """Returns the velocity of the body without slip: the inverse of `wheels_of`."""
    first, second, third = wheels
    return Velocity(
        (third - first) * SIN_60 / 1.5,
        (0.5 * (first + third) - second) / 1.5,
        (first + second + third) / (3 * wheel_distance_m),
    )


def velocity_covariance_of(variances_m2_s2: Wheels, wheel_distance_m: float) -> list[list[float]]:
    """Returns the covariance (3, 3) of `velocity_of` for wheels whose rim speeds have independent errors."""
    first, second, third = variances_m2_s2
    ahead_aside = (third - first) * SIN_60 / 4.5
    ahead_turn = (third - first) * SIN_60 / (4.5 * wheel_distance_m)
    aside_turn = (0.5 * (first + third) - second) / (4.5 * wheel_distance_m)
    return [
        [(first + third) / 3, ahead_aside, ahead_turn],
        [ahead_aside, (0.25 * (first + third) + second) / 2.25, aside_turn],
        [ahead_turn, aside_turn, (first + second + third) / (3 * wheel_distance_m) ** 2],
    ]
