"""Mouth of a robot: ball handling, light barrier and kick."""

import math

import pymunk

from procs.simulation.physics.ball_body import Ball
from procs.simulation.physics.bodies import State
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
        self.ball_mass_kg = ball.mass_kg
        self._pull_m_s2 = handling.pull_m_s2 * strength
        self.far_m = math.hypot(robot.mouth_x_m + ball.radius_m + handling.reach_m, handling.half_width_m)
        """Farthest that the middle of a ball in the mouth can be from the robot's."""

    @property
    def holds_ball(self) -> bool:
        """True if the light barrier sees the ball in the mouth."""
        return self.held_ball() is not None

    def held_ball(self) -> pymunk.Vec2d | None:
        """Returns the place of the ball in the robot frame in m, if it is in the mouth; otherwise None."""
        at = self._ball.body.position
        away = at - self._robot.body.position
        return None if away.dot(away) > self.far_m**2 else self.place_of(*at)

    def place_of(self, x_m: float, y_m: float) -> pymunk.Vec2d | None:
        """Returns the same for a ball at a place of the world that is not further away than `far_m`."""
        if self._ball.z_m > self._handling.highest_m:
            return None
        place = self._robot.body.world_to_local((x_m, y_m))
        gap_m = place.x - self._robot.mouth_x_m - self._ball.radius_m
        held = gap_m <= self._handling.reach_m and abs(place.y) <= self._handling.half_width_m and place.x > 0
        return place if held else None

    def pull(self, place: pymunk.Vec2d, ball: State, duration_s: float) -> tuple[float, float]:
        """Draws the ball to the middle of the mouth with limited force, for one step.

        Args:
            place: place of the ball as `held_ball` returns it.
            ball: present state of the ball.
            duration_s: duration of the step.

        Returns:
            Change of the ball's velocity in m/s, for the world to apply; the recoil has reached the robot.
        """
        robot, centring_s = self._robot.body, self._handling.centring_s
        x_m, y_m, _, vx_m_s, vy_m_s, _ = ball
        wanted_x_m = self._robot.mouth_x_m + self._ball.radius_m + _GAP_M
        ahead_m_s, aside_m_s = (wanted_x_m - place.x) / centring_s, -place.y / centring_s
        mouth_x_m_s, mouth_y_m_s = robot.velocity_at_local_point(place)
        cos, sin = math.cos(robot.angle), math.sin(robot.angle)
        change_x = mouth_x_m_s + (ahead_m_s * cos - aside_m_s * sin) - vx_m_s
        change_y = mouth_y_m_s + (ahead_m_s * sin + aside_m_s * cos) - vy_m_s
        limit_m_s, change_m_s = self._pull_m_s2 * duration_s, math.sqrt(change_x**2 + change_y**2)
        if change_m_s > limit_m_s:
            change_x, change_y = change_x * limit_m_s / change_m_s, change_y * limit_m_s / change_m_s
        mass_kg = self._ball.mass_kg
        robot.apply_impulse_at_world_point((-mass_kg * change_x, -mass_kg * change_y), (x_m, y_m))
        return change_x, change_y

    def kick(self, speed_m_s: float, direction_error_rad: float) -> tuple[float, float]:
        """Drives the ball out: `speed_m_s` is along the mouth's direction and relative to the robot.

        Returns the change of the ball's velocity like `pull`.
        """
        robot, ball = self._robot.body, self._ball.body
        direction_rad = robot.angle + direction_error_rad
        away = speed_m_s * pymunk.Vec2d(math.cos(direction_rad), math.sin(direction_rad))
        change = robot.velocity_at_world_point(ball.position) + away - ball.velocity
        robot.apply_impulse_at_world_point(-self._ball.mass_kg * change, ball.position)
        return change
