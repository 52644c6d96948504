"""The tops of the robots, on which a ball in flight can fall."""

import math
from collections.abc import Sequence

from procs.simulation.physics.ball_body import Ball
from procs.simulation.physics.robot_body import Robot
from procs.simulation.physics.settings import ContactSettings


class Tops:
    """Lets the ball fall: to the ground, or on a robot, off which it bounces and rolls."""

    def __init__(self, robots: Sequence[Robot], height_m: float, ball: Ball, contacts: ContactSettings) -> None:
        """`height_m` is that of the robots."""
        self._robots = robots
        self._height_m = height_m
        self._ball = ball
        self._bounce, self._roll_off_m_s = contacts.top_bounce, contacts.roll_off_m_s

    def fall(self, duration_s: float) -> str | None:
        """Lets gravity act on the ball for a while; returns the robot on whose top it has fallen, if any."""
        ball = self._ball
        below = self._robot_below() if ball.z_m >= self._height_m else None
        if below is None:
            ball.fall(duration_s)
            return None
        if not ball.fall(duration_s, self._height_m, self._bounce):
            return None
        away = ball.body.position - below.body.position
        outwards = away.normalized() if away.length else below.body.rotation_vector
        speed_m_s = (ball.body.velocity - below.body.velocity).dot(outwards)
        ball.body.velocity += max(0.0, self._roll_off_m_s - speed_m_s) * outwards
        return below.name

    def _robot_below(self) -> Robot | None:
        """Returns the robot above which the ball's middle is."""
        place = self._ball.body.position
        return next((each for each in self._robots if math.dist(place, each.body.position) < each.radius_m), None)
