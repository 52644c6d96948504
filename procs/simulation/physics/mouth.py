"""Mouth of a robot: ball handling, light barrier and kick."""

import math

import pymunk

from procs.simulation.physics.ball_body import Ball
from procs.simulation.physics.robot_body import Robot
from procs.simulation.physics.settings import HandlingSettings

_GAP_M = 0.002  # kept between mouth and handled ball, so that handling does not fight the contact


class Mouth:
    """The front of one robot, as far as it concerns the ball."""

    def __init__(self, robot: Robot, ball: Ball, handling: HandlingSettings, strength: float = 1.0) -> None:
        """`strength` multiplies the acceleration that the handling can bring about."""
        self._robot = robot
        self._ball = ball
        self._handling = handling
        self._pull_m_s2 = handling.pull_m_s2 * strength
        self.far_m = robot.radius_m + ball.radius_m + handling.reach_m
        """Farthest that the middle of a ball in the mouth can be from the robot's."""

    @property
    def holds_ball(self) -> bool:
        """True if the light barrier sees the ball in the mouth."""
        return self.held_ball() is not None

    def held_ball(self) -> pymunk.Vec2d | None:
        """Returns the place of the ball in the robot frame in m, if it is in the mouth; otherwise None."""
        away = self._ball.body.position - self._robot.body.position
        if self._ball.z_m > self._handling.highest_m or away.dot(away) > self.far_m**2:
            return None
        place = self._robot.body.world_to_local(self._ball.body.position)
        gap_m = place.x - self._robot.mouth_x_m - self._ball.radius_m
        held = gap_m <= self._handling.reach_m and abs(place.y) <= self._handling.half_width_m and place.x > 0
        return place if held else None

    def pull(self, place: pymunk.Vec2d, duration_s: float) -> pymunk.Vec2d:
        """Draws the ball to the middle of the mouth with limited force, for one step.

        Args:
            place: place of the ball as `held_ball` returns it.
            duration_s: duration of the step.

        Returns:
            Change of the ball's velocity in m/s, for the world to apply; the recoil has reached the robot.
        """
        robot, handling = self._robot.body, self._handling
        x_m, y_m = place
        wanted_x_m = self._robot.mouth_x_m + self._ball.radius_m + _GAP_M
        approach = pymunk.Vec2d(wanted_x_m - x_m, -y_m) / handling.centring_s
        mouth_velocity = robot.velocity_at_local_point((x_m, y_m))
        change = mouth_velocity + approach.rotated(robot.angle) - self._ball.body.velocity
        limit_m_s = self._pull_m_s2 * duration_s
        return self._recoil(change if change.length <= limit_m_s else change.scale_to_length(limit_m_s))

    def kick(self, speed_m_s: float, direction_error_rad: float) -> pymunk.Vec2d:
        """Drives the ball out: `speed_m_s` is along the mouth's direction and relative to the robot.

        Returns the change of the ball's velocity like `pull`.
        """
        robot, ball = self._robot.body, self._ball.body
        direction_rad = robot.angle + direction_error_rad
        away = speed_m_s * pymunk.Vec2d(math.cos(direction_rad), math.sin(direction_rad))
        return self._recoil(robot.velocity_at_world_point(ball.position) + away - ball.velocity)

    def _recoil(self, change: pymunk.Vec2d) -> pymunk.Vec2d:
        self._robot.body.apply_impulse_at_world_point(-self._ball.mass_kg * change, self._ball.body.position)
        return change
