"""Velocities of an omnidirectional robot that can still stop at its target, within the grip of its wheels."""

import math
from collections.abc import Callable
from typing import NamedTuple

from pydantic import BaseModel, ConfigDict, Field, NonNegativeFloat, PositiveFloat

from procs.model.field import Point
from procs.model.geometry import clamp, wrap_rad
from procs.model.kinematics import Velocity


class Pose(NamedTuple):
    """Place and heading in the world frame."""

    place: Point
    heading_rad: float


class Limits(BaseModel):
    """Limits and gains of the motion."""

    model_config = ConfigDict(extra="forbid")

    speed_m_s: PositiveFloat = 3.0
    """Highest speed."""
    acceleration_m_s2: PositiveFloat = 3.0
    """Limit of the change of the velocity."""
    braking_m_s2: PositiveFloat = 2.5
    """Deceleration assumed for stopping at the target."""
    omega_rad_s: PositiveFloat = 5.0
    """Highest turning speed."""
    angular_acceleration_rad_s2: PositiveFloat = 18.0
    """Limit of its change."""
    angular_braking_rad_s2: PositiveFloat = 9.0
    """Deceleration assumed for stopping at the heading."""
    ball_omega_rad_s: PositiveFloat = 4.0
    """Highest turning speed with the ball in the mouth."""
    ball_acceleration_m_s2: PositiveFloat = 2.5
    """Limit of the change of the velocity with the ball in the mouth."""
    ball_push_m_s2: PositiveFloat = 4.0
    """The same for a change towards the ball, which ends a drive backwards before it counts as holding."""
    ball_angular_acceleration_rad_s2: PositiveFloat = 14.0
    """Limit of the change of the turning speed with the ball in the mouth; more than these loses the ball."""
    ball_pivot: float = Field(default=0.6, ge=0.0, le=1.0)
    """With the ball the robot turns about a point on the way from its middle (0) to the ball (1). The nearer to the
    ball, the less the handling has to pull; a ball that rests for long is held."""
    position_gain_1_s: PositiveFloat = 4.0
    """Speed for each metre to go, close to the target."""
    heading_gain_1_s: PositiveFloat = 6.0
    """Turning speed for each radian to go, close to the heading."""
    latency_s: NonNegativeFloat = 0.14
    """From a pose's measurement until the wheels follow the command that it led to."""


def ahead_in_time(pose: Pose, velocity: Velocity, duration_s: float) -> Pose:
    """Returns the pose after `duration_s`; the velocity is in the robot frame."""
    middle_rad = pose.heading_rad + velocity.omega_rad_s * duration_s / 2
    vx_m_s, vy_m_s = turned(velocity.vx_m_s, velocity.vy_m_s, middle_rad)
    place = Point(pose.place.x_m + vx_m_s * duration_s, pose.place.y_m + vy_m_s * duration_s)
    return Pose(place, wrap_rad(pose.heading_rad + velocity.omega_rad_s * duration_s))


def mean(one: Velocity, other: Velocity) -> Velocity:
    """Returns the mean of two velocities in the same frame."""
    return Velocity(*((a + b) / 2 for a, b in zip(one, other, strict=True)))


def turned(x: float, y: float, angle_rad: float) -> tuple[float, float]:
    """Returns the vector (x, y), in any unit, turned counter-clockwise."""
    cos, sin = math.cos(angle_rad), math.sin(angle_rad)
    return x * cos - y * sin, x * sin + y * cos


def speed_to_go_m_s(distance_m: float, end_m_s: float, limit_m_s: float, limits: Limits) -> float:
    """Returns the highest speed from which the robot still brakes to the end speed within the distance."""
    braking_m_s = math.sqrt(end_m_s**2 + 2 * limits.braking_m_s2 * max(0.0, distance_m))
    return min(limit_m_s, braking_m_s, end_m_s + limits.position_gain_1_s * max(0.0, distance_m))


def turning_to_go_rad_s(turn_rad: float, limit_rad_s: float, limits: Limits) -> float:
    """Returns the turning speed from which the robot still stops at the heading."""
    braking_rad_s = math.sqrt(2 * limits.angular_braking_rad_s2 * abs(turn_rad))
    return math.copysign(min(limit_rad_s, braking_rad_s, limits.heading_gain_1_s * abs(turn_rad)), turn_rad)


def braked_first(before: Velocity, wanted: Velocity, allowed: Callable[[Point], Point], change_m_s: float) -> Velocity:
    """Returns the velocity to want in this iteration, so that the robot brakes as it must before it turns as it likes.

    Args:
        before: velocity of the iteration before.
        wanted: velocity to come to.
        allowed: returns the velocity, braked where it leads to a forbidden place.
        change_m_s: largest change of the velocity in an iteration.
    """
    braked = allowed(Point(before.vx_m_s, before.vy_m_s))
    left_m_s = change_m_s - math.dist(braked, (before.vx_m_s, before.vy_m_s))
    if left_m_s <= 0.0:
        return Velocity(*braked, wanted.omega_rad_s)
    return approach(Velocity(*braked, wanted.omega_rad_s), wanted, 1.0, left_m_s, 0.0)


def approach(before: Velocity, wanted: Velocity, duration_s: float, change_m_s2: float, turn_rad_s2: float) -> Velocity:
    """Returns the wanted velocity, or the nearest one that the limits allow after `duration_s`, in the same frame.

    `change_m_s2` limits the change of the velocity, `turn_rad_s2` that of the turning speed.
    """
    dvx, dvy = wanted.vx_m_s - before.vx_m_s, wanted.vy_m_s - before.vy_m_s
    change_m_s, possible_m_s = math.hypot(dvx, dvy), change_m_s2 * duration_s
    share = 1.0 if change_m_s <= possible_m_s else possible_m_s / change_m_s
    turn = turn_rad_s2 * duration_s
    omega = clamp(wanted.omega_rad_s, before.omega_rad_s - turn, before.omega_rad_s + turn)
    return Velocity(before.vx_m_s + dvx * share, before.vy_m_s + dvy * share, omega)
