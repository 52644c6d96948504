"""Chooses a velocity that runs into no other robot: reciprocal velocity obstacles.

After J. van den Berg, M. Lin, D. Manocha, "Reciprocal velocity obstacles for real-time multi-agent navigation", ICRA
2008: velocities around the wanted one are rated by their difference from it and by the time to the first collision.
Two additions: a velocity counts as what the robot can reach of it in a moment, as in a dynamic window (Fox, Burgard,
Thrun, 1997), and a gentle touch is allowed, because robots that fight for the ball touch each other.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from procs.model.field import Point

_HORIZON_S = 1.6
_REACTION_S = 0.35
"""In this time the robot changes its velocity as far as its acceleration allows; others keep theirs."""
_SOONEST_S = 0.15
_TOUCH_M_S = 0.6
"""Closing speed of a touch that does no harm."""
_WEIGHT_S = 1.2
"""Cost of a collision of 1 m/s in 1 s, as a difference from the wanted velocity in m/s."""
_SPEED_SHARES = (1.0, 0.6, 0.25)
_TURNS_RAD = (0.35, -0.35, 0.8, -0.8, 1.4, -1.4, 2.2, -2.2)
_LEAST_M_S = 1.0


class Mover(NamedTuple):
    """Another robot."""

    place: Point
    velocity_m_s: Point
    gives_way: bool
    """A mate: its navigator makes half of the evasion, so the own robot makes the other half only."""


def safe_velocity(
    wanted_m_s: Point, now_m_s: Point, place: Point, movers: Sequence[Mover], apart_m: float, change_m_s2: float
) -> Point:
    """Returns the wanted velocity, or the best one near it that leads to no collision soon.

    `now_m_s` is the present velocity, `apart_m` the distance of the middles of two robots that touch, and
    `change_m_s2` the limit of the acceleration.
    """
    near = [mover for mover in movers if math.dist(mover.place, place) < apart_m + 4.0 * _HORIZON_S]
    change_m_s = change_m_s2 * _REACTION_S
    best, best_cost = wanted_m_s, _danger(wanted_m_s, now_m_s, place, near, apart_m, change_m_s)
    if best_cost == 0.0:
        return best
    for velocity in _candidates(wanted_m_s):
        cost = math.dist(velocity, wanted_m_s)
        if cost < best_cost:
            cost += _danger(velocity, now_m_s, place, near, apart_m, change_m_s)
            if cost < best_cost:
                best, best_cost = velocity, cost
    return best


def _candidates(wanted_m_s: Point) -> list[Point]:
    speed_m_s, way_rad = max(_LEAST_M_S, math.hypot(*wanted_m_s)), math.atan2(wanted_m_s.y_m, wanted_m_s.x_m)
    turned = [
        Point(share * speed_m_s * math.cos(way_rad + turn_rad), share * speed_m_s * math.sin(way_rad + turn_rad))
        for share in _SPEED_SHARES
        for turn_rad in (0.0, *_TURNS_RAD, math.pi)
    ]
    return [*turned, Point(0.0, 0.0)]


def _danger(
    velocity: Point, now: Point, place: Point, movers: Sequence[Mover], apart_m: float, change_m_s: float
) -> float:
    """Returns the cost of the worst collision that the velocity leads to; 0 without one."""
    dvx, dvy = velocity.x_m - now.x_m, velocity.y_m - now.y_m
    share = min(1.0, change_m_s / max(math.hypot(dvx, dvy), 1e-9))
    vx, vy = now.x_m + share * dvx, now.y_m + share * dvy
    worst = 0.0
    for mover in movers:
        factor = 2.0 if mover.gives_way else 1.0
        closing_x = factor * vx - (factor - 1.0) * now.x_m - mover.velocity_m_s.x_m
        closing_y = factor * vy - (factor - 1.0) * now.y_m - mover.velocity_m_s.y_m
        to_x, to_y = mover.place.x_m - place.x_m, mover.place.y_m - place.y_m
        away_m = math.hypot(to_x, to_y)
        towards = to_x * closing_x + to_y * closing_y
        if towards <= 0.0:
            continue
        if away_m <= apart_m:
            time_s, impact_m_s = 0.0, towards / max(away_m, 1e-6)
        else:
            squared = closing_x * closing_x + closing_y * closing_y
            root = towards * towards - squared * (away_m * away_m - apart_m * apart_m)
            if root <= 0.0:
                continue
            time_s = (towards - math.sqrt(root)) / squared
            impact_m_s = math.sqrt(root) / apart_m
        if time_s < _HORIZON_S and impact_m_s > _TOUCH_M_S:
            worst = max(
                worst, _WEIGHT_S * (impact_m_s - _TOUCH_M_S) * (1.0 / max(time_s, _SOONEST_S) - 1.0 / _HORIZON_S)
            )
    return worst
