"""Interception of a rolling ball: the first place on its way where a robot stands in time, its mouth to the ball."""

import math
from typing import NamedTuple

from procs.behaviour import ballistics
from procs.behaviour.bodies import Bodies
from procs.behaviour.view import Ball, View
from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, between, wrap_rad

_MARGIN_S = 0.2
"""The robot stands there so long before the ball arrives."""
_LEAST_M_S = 0.4
"""A slower ball is driven to."""
_TURN_RAD_S, _TURN_S = 4.0, 0.2  # speed of the robot's turn, and time to get into it and out of it
_FAST_M_S = 2.0
"""The robot does not drive towards a faster ball, which would bounce off."""
_NEAR_LINE_M = 0.4  # a robot that near to the ball's way nearly stands on it
_STEP_S, _HORIZON_S = 0.1, 3.0  # meetings are looked for in steps, up to the horizon
_WORTH_S = 0.5  # waiting for the ball may take so much longer than driving to it, because it does not bounce
_AHEAD = 0.1  # cosine of the angle off the ball's way from which the robot would have to overtake the ball
_KEPT_S = 0.3  # a meeting is kept until the robot is so late
_SMOOTHING_S = 0.2  # time constant of the mean velocity
_KICKED_M_S = 0.9  # a velocity that changes by more is that of a kick


class Stand(NamedTuple):
    """A place of the robot in the way of the ball."""

    place: Point
    heading_rad: float
    time_s: float
    """Time until the ball arrives at the place."""


class Interception:
    """Plan to meet one ball: it smooths the ball's velocity, and keeps to a meeting that is still possible."""

    def __init__(self) -> None:
        self._velocity_m_s: Point | None = None
        self._left_s = 0.0

    def smoothed(self, ball: Ball, duration_s: float) -> Ball:
        """Returns the ball with the mean of its newest velocities, `duration_s` after the last; a kick begins anew."""
        before = self._velocity_m_s
        if before is None or math.dist(before, ball.velocity_m_s) > _KICKED_M_S:
            before = ball.velocity_m_s
        share = min(1.0, duration_s / _SMOOTHING_S)
        self._velocity_m_s = between(before, ball.velocity_m_s, share)
        return ball._replace(velocity_m_s=self._velocity_m_s)

    def stand(self, view: View, duration_s: float) -> Stand | None:
        """Returns the place where the robot waits for the ball; None if driving to the ball is sooner."""
        ball, robot, bodies = view.ball, view.own, view.bodies
        speed_m_s = ball.speed_m_s
        way_rad = math.atan2(ball.velocity_m_s.y_m, ball.velocity_m_s.x_m)
        if speed_m_s < _LEAST_M_S or math.cos(bearing_rad(ball.place, robot.place) - way_rad) < _AHEAD:
            self._left_s = 0.0
            return None
        heading_rad = wrap_rad(way_rad + math.pi)
        if speed_m_s > _FAST_M_S:
            here = _beside(view, way_rad, heading_rad)
            if here is not None:
                self._left_s = here.time_s
                return here
        self._left_s = max(0.0, self._left_s - duration_s)
        latest_s = ballistics.meet(view).time_s + _WORTH_S
        turning_s = abs(wrap_rad(heading_rad - robot.heading_rad)) / _TURN_RAD_S + _TURN_S
        start = ballistics.carried(robot.place, robot.velocity_m_s)

        def late_s(time_s: float) -> float:
            way_m = math.dist(start, _mouth_at(ball, time_s, way_rad, bodies))
            return max(turning_s, ballistics.reach_s(way_m) + _MARGIN_S) - time_s

        if not (self._left_s > _STEP_S and late_s(self._left_s) < _KEPT_S):
            steps = (step * _STEP_S for step in range(1, round(min(latest_s, _HORIZON_S) / _STEP_S) + 1))
            self._left_s = next((time_s for time_s in steps if late_s(time_s) <= 0.0), 0.0)
        if not self._left_s:
            return None
        return Stand(_mouth_at(ball, self._left_s, way_rad, bodies), heading_rad, self._left_s)


def _mouth_at(ball: Ball, time_s: float, way_rad: float, bodies: Bodies) -> Point:
    """Returns the place of a robot that has the ball in its mouth at a time, ahead of the ball."""
    return ahead(ballistics.ball_after(ball, time_s, bodies), way_rad, bodies.held_ball_m)


def _beside(view: View, way_rad: float, heading_rad: float) -> Stand | None:
    """Returns the nearest place on the ball's way if the robot nearly stands there and the ball is yet to come."""
    ball, contact_m = view.ball, view.bodies.held_ball_m
    place = ballistics.carried(view.own.place, view.own.velocity_m_s)
    to_x_m, to_y_m = place.x_m - ball.place.x_m, place.y_m - ball.place.y_m
    along_m = to_x_m * math.cos(way_rad) + to_y_m * math.sin(way_rad)
    aside_m = abs(to_y_m * math.cos(way_rad) - to_x_m * math.sin(way_rad))
    time_s = (along_m - contact_m) / ball.speed_m_s
    if along_m < contact_m or aside_m > _NEAR_LINE_M or ballistics.reach_s(aside_m) > time_s:
        return None
    return Stand(ahead(ball.place, way_rad, along_m), heading_rad, time_s)
