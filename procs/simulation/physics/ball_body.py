"""The ball as a body of the physics engine."""

import math

import pymunk

from procs.model.ball import BallModel
from procs.model.robot import ROBOT, RobotModel
from procs.simulation.physics.arena import BALL, NET_RADIUS_M, ball_filter
from procs.simulation.physics.rolling import RollingFriction

GRAVITY_M_S2 = 9.81
THROW_LIMIT_M_S = 15.0
"""Largest part of a thrown ball's velocity along each axis."""


def longest_step_within_nets_s(ball: BallModel, robot: RobotModel, kick_error: float) -> float:
    """Returns the longest step in which no ball gets from one side of a net to the other.

    `kick_error` is the factor of a kick's speed with the largest error.
    """
    fastest_m_s = max(math.sqrt(2) * THROW_LIMIT_M_S, kick_error * robot.kick_limit_m_s + robot.wheel_limit_m_s)
    return (ball.radius_m + NET_RADIUS_M) / fastest_m_s


class Ball:
    """A ball on the ground or in flight; positions in the world frame."""

    def __init__(
        self,
        space: pymunk.Space,
        ball: BallModel,
        friction_scale: float = 1.0,
        robot_height_m: float = ROBOT.height_m,
        goal_height_m: float = 1.0,
    ) -> None:
        """Adds the ball to the space; it meets robots and goals while its lowest point is not above them."""
        self.z_m = 0.0
        """Height of its lowest point above the ground."""
        self.vz_m_s = 0.0
        self._robot_height_m, self._goal_height_m = robot_height_m, goal_height_m
        self._bounce, self._least_rebound_m_s, self._spin_s = ball.bounce, ball.least_rebound_m_s, ball.spin_s
        self.radius_m = ball.radius_m
        self.mass_kg = ball.mass_kg
        self.friction = RollingFriction(ball, friction_scale)
        self.body = pymunk.Body(ball.mass_kg, ball.inertia * ball.mass_kg * ball.radius_m**2)
        shape = pymunk.Circle(self.body, ball.radius_m)
        shape.collision_type, shape.elasticity, shape.friction = BALL, 1.0, 1.0
        shape.filter = ball_filter()
        self._shape = shape
        space.add(self.body, shape)

    @property
    def speed_m_s(self) -> float:
        """Speed over the ground."""
        return math.hypot(*self.body.velocity)

    @property
    def flies(self) -> bool:
        """True if the ball is above the ground."""
        return self.z_m > 0.0 or self.vz_m_s > 0.0

    def fall(self, duration_s: float, floor_m: float = 0.0, bounce: float | None = None) -> bool:
        """Lets gravity act on a ball in flight for a while; returns whether it has reached the floor.

        Args:
            duration_s: the while.
            floor_m: height of the floor, which is not above the ball.
            bounce: share of the vertical speed after a bounce; None: that of the ground.
        """
        if not self.flies:
            return False
        landing_m_s = math.sqrt(self.vz_m_s**2 + 2 * GRAVITY_M_S2 * max(0.0, self.z_m - floor_m))
        gained_m_s = GRAVITY_M_S2 * duration_s
        self.z_m += self.vz_m_s * duration_s - GRAVITY_M_S2 * duration_s**2 / 2
        self.vz_m_s -= gained_m_s
        landed = self.z_m <= floor_m
        if landed:
            # The step ends below the floor, where the ball is faster than it was at the floor.
            rebound_m_s = landing_m_s * (self._bounce if bounce is None else bounce)
            self._bounce_off(floor_m, rebound_m_s, least_m_s=gained_m_s)
        self._meet_what_is_as_high()
        return landed

    def rub(self, duration_s: float, vx_m_s: float, vy_m_s: float, omega_rad_s: float) -> None:
        """Lets the ground act for a while on a ball of this velocity, unless it flies."""
        if self.flies:
            self.body.velocity = vx_m_s, vy_m_s
            return
        if omega_rad_s:
            self.body.angular_velocity = omega_rad_s * math.exp(-duration_s / self._spin_s)
        self.body.velocity = self.friction.advance(vx_m_s, vy_m_s, duration_s)

    def throw(self, height_m: float, vx_m_s: float, vy_m_s: float, vz_m_s: float) -> None:
        """Lifts the ball to a height and gives it a velocity; one that is thrown down on the ground bounces at once."""
        self.z_m, self.vz_m_s = max(0.0, height_m), vz_m_s
        self.body.velocity = (vx_m_s, vy_m_s)
        if not self.z_m and vz_m_s < 0.0:
            self._bounce_off(0.0, -self._bounce * vz_m_s)
        self._meet_what_is_as_high()

    def put(self, x_m: float, y_m: float) -> None:
        """Lays the ball down at rest."""
        self.z_m = self.vz_m_s = 0.0
        self._shape.filter = ball_filter()
        self.body.position = (x_m, y_m)
        self.body.velocity = (0.0, 0.0)
        self.body.angular_velocity = 0.0
        self.friction.roll(0.0, 0.0)

    def _meet_what_is_as_high(self) -> None:
        self._shape.filter = ball_filter(self.z_m >= self._robot_height_m, self.z_m > self._goal_height_m)

    def _bounce_off(self, floor_m: float, rebound_m_s: float, least_m_s: float = 0.0) -> None:
        """Sends the ball, which has reached a floor, up again; one that is not faster than `least_m_s` stays there."""
        rises = rebound_m_s > max(self._least_rebound_m_s, least_m_s)
        self.z_m, self.vz_m_s = floor_m, rebound_m_s if rises else 0.0
