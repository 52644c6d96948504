"""The ball as a body of the physics engine."""

import math

import pymunk

from procs.simulation.physics.arena import BALL, BALL_FILTER
from procs.simulation.physics.rolling import RollingFriction
from procs.simulation.physics.settings import BallSettings

_UPRIGHT_SPIN_S = 0.5  # time constant with which the ground stops a spin around the vertical


class Ball:
    """A ball that stays on the ground; positions in the world frame."""

    def __init__(self, space: pymunk.Space, ball: BallSettings, friction_scale: float = 1.0) -> None:
        self.radius_m = ball.radius_m
        self.mass_kg = ball.mass_kg
        self.friction = RollingFriction(ball, friction_scale)
        self.body = pymunk.Body(ball.mass_kg, ball.inertia * ball.mass_kg * ball.radius_m**2)
        shape = pymunk.Circle(self.body, ball.radius_m)
        shape.collision_type, shape.elasticity, shape.friction = BALL, 1.0, 1.0
        shape.filter = BALL_FILTER
        space.add(self.body, shape)

    @property
    def speed_m_s(self) -> float:
        """Speed over the ground."""
        return math.hypot(*self.body.velocity)

    def rub(self, duration_s: float) -> None:
        """Lets the ground act on the ball for a while."""
        self.body.angular_velocity *= math.exp(-duration_s / _UPRIGHT_SPIN_S)
        self.body.velocity = self.friction.advance(*self.body.velocity, duration_s)

    def put(self, x_m: float, y_m: float) -> None:
        """Lays the ball down at rest."""
        self.body.position = (x_m, y_m)
        self.body.velocity = (0.0, 0.0)
        self.body.angular_velocity = 0.0
        self.friction.roll(0.0, 0.0)
