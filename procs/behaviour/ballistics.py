"""How far a ball rolls, how hard to kick it, and where a robot can meet it."""

import math
from typing import NamedTuple

from procs.behaviour.view import Ball
from procs.field import Point

SLIDING_M_S2 = 3.0
ROLLING_M_S2 = 0.4
ROLLING_SHARE = 0.6
"""Share of a kick's speed that is left when the ball begins to roll without sliding."""

_STEP_S = 0.1
_HORIZON_S = 4.0


class Meeting(NamedTuple):
    """Where and when a robot can be at the ball."""

    place: Point
    time_s: float


def ball_after(ball: Ball, time_s: float) -> Point:
    """Where the rolling ball will be, if nobody touches it."""
    speed_m_s = ball.speed_m_s
    if speed_m_s < 0.05:
        return ball.place
    rolling_s = min(time_s, speed_m_s / ROLLING_M_S2)
    share = rolling_s - ROLLING_M_S2 * rolling_s * rolling_s / (2 * speed_m_s)
    return Point(ball.place.x_m + ball.velocity_m_s.x_m * share, ball.place.y_m + ball.velocity_m_s.y_m * share)


def kick_speed_m_s(distance_m: float, arrival_m_s: float) -> float:
    """Speed of a kick after which the ball still has the arrival speed that far away.

    The ball slides until its speed has fallen to `ROLLING_SHARE` of the kick's, then rolls.
    """
    sliding_m = (1 - ROLLING_SHARE**2) / (2 * SLIDING_M_S2)  # way of sliding for each (m/s)^2 of the kick
    squared = (arrival_m_s**2 + 2 * ROLLING_M_S2 * distance_m) / (ROLLING_SHARE**2 + 2 * ROLLING_M_S2 * sliding_m)
    return math.sqrt(max(squared, arrival_m_s**2))


def reach_s(distance_m: float, speed_m_s: float = 2.5, acceleration_m_s2: float = 2.5) -> float:
    """Time to drive a distance from rest to rest."""
    if distance_m < speed_m_s**2 / acceleration_m_s2:
        return 2 * math.sqrt(max(0.0, distance_m) / acceleration_m_s2)
    return distance_m / speed_m_s + speed_m_s / acceleration_m_s2


def meet(ball: Ball, place: Point, contact_m: float = 0.33) -> Meeting:
    """The earliest meeting of the ball with a robot that is now at `place`.

    `contact_m` is the distance of their middles when they touch. If the ball outruns the robot, the meeting is where
    the ball will be at the end of the horizon of four seconds.
    """
    if ball.speed_m_s < 0.2:
        return Meeting(ball.place, reach_s(math.dist(place, ball.place) - contact_m))
    for step in range(round(_HORIZON_S / _STEP_S)):
        time_s = step * _STEP_S
        there = ball_after(ball, time_s)
        if reach_s(math.dist(place, there) - contact_m) <= time_s:
            return Meeting(there, time_s)
    there = ball_after(ball, _HORIZON_S)
    return Meeting(there, max(_HORIZON_S, reach_s(math.dist(place, there) - contact_m)))
