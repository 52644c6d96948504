"""Chooses a velocity that runs into no other robot: velocity obstacles with acceleration limits.

After P. Fiorini, Z. Shiller, "Motion planning in dynamic environments using velocity obstacles", IJRR 1998: velocities
around the wanted one are rated by their difference from it and by the time to the first collision. The way to each
velocity is that of a robot which accelerates within its limit (J. van den Berg, J. Snape, S. Guy, D. Manocha,
"Reciprocal collision avoidance with acceleration-velocity obstacles", ICRA 2011). Of two mates one evades: halves of an
evasion, as in reciprocal velocity obstacles, are too small when one of the two believes something else. Any other robot
may evade as well. Two robots that both turn to the same side, each to pass behind the other, would meet, so a robot
nearby counts as one that goes on and as one that brakes, and turns to the right cost less than those to the left. A
gentle touch is allowed, because robots that fight for the ball touch each other.
"""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np

from procs.model.field import Point
from procs.model.frames import Floats

_HORIZON_S = 1.6
_REACTION_S = 0.35
"""A robot that touches another already is judged by its velocity after this time."""
_LATE_S = 0.4
"""The robot evades a mate that gives way only if they would collide so soon."""
_SOONEST_S = 0.15
"""An earlier collision costs no more."""
_TOUCH_M_S = 0.4
"""Closing speed of a touch that does no harm."""
_WEIGHT_S = 3.0
"""Cost of a collision of 1 m/s in 1 s, as a difference from the wanted velocity in m/s."""
_GROWTH_M_S = 0.2
"""Further room for each second until robots meet: velocities are known roughly, and robots change them."""
_BRAKES_M_S2 = 2.5
"""Deceleration of another robot that evades as well ..."""
_EVADES_M = 3.0
"""... when it is nearer than this."""
DRIVES_M_S = 0.3
"""A slower robot plays the ball or stays at its place."""
_TO_THE_LEFT = 0.3
"""Cost of a turn to the left, for each m/s across the wanted direction: robots that meet pass on one side."""
_LEAST_M_S = 1.0
"""Velocities to choose from are at least so fast, so that a robot that stands can evade."""
_STANDS_M_S = 1e-6
"""A slower robot has no direction."""
_FASTEST_M_S = 4.0
"""Speed at which two robots approach each other at most."""
_ALIKE = 9
"""Costs that are equal to so many decimals are equal."""
_SPEED_SHARES = (1.0, 0.6, 0.25)
_TURNS_RAD = (0.0, 0.35, -0.35, 0.8, -0.8, 1.4, -1.4, 2.2, -2.2, math.pi)
_CHANGES = [(share * math.cos(turn), share * math.sin(turn)) for share in _SPEED_SHARES for turn in _TURNS_RAD]
_TIMES_S = np.concatenate([np.arange(1, 9) * 0.05, np.arange(5, 17) * 0.1])
_LATE = int(np.searchsorted(_TIMES_S, _LATE_S + 1e-9))
_REACTED = int(np.searchsorted(_TIMES_S, _REACTION_S - 1e-9))


class Mover(NamedTuple):
    """Another robot."""

    place: Point
    velocity_m_s: Point
    gives_way: bool
    """A mate that has agreed to evade, because its rank is lower."""
    margin_m: float = 0.0
    """Further distance to keep, because the place is not known well."""


def safe_velocity(
    wanted_m_s: Point,
    now_m_s: Point,
    place: Point,
    movers: Sequence[Mover],
    apart_m: float,
    change_m_s2: float,
    fastest_m_s: float = math.inf,
    allowed: Callable[[Point], Point] = lambda velocity_m_s: velocity_m_s,
) -> Point:
    """Returns the wanted velocity, or the best one near it that leads to no collision soon.

    Args:
        wanted_m_s: velocity without other robots.
        now_m_s: present velocity.
        place: of the robot.
        movers: the other robots.
        apart_m: distance of the middles of two robots that touch.
        change_m_s2: limit of the acceleration.
        fastest_m_s: limit of the speed; neither the wanted nor the present velocity exceeds it.
        allowed: returns the nearest velocity that leads into no forbidden place; the wanted velocity leads into none.
    """
    near = [mover for mover in movers if math.dist(mover.place, place) < apart_m + _FASTEST_M_S * _HORIZON_S]
    if not near:
        return wanted_m_s
    others = _Others(near, place, now_m_s, apart_m)
    if others.dangers(np.array([wanted_m_s]), change_m_s2)[0] == 0.0:
        return wanted_m_s
    along = wanted_m_s if math.hypot(*wanted_m_s) > _STANDS_M_S else _away(near, place)
    found = _candidates(wanted_m_s, now_m_s, along, min(_LEAST_M_S, fastest_m_s))
    candidates = np.array([allowed(each) for each in found])
    across = (along.x_m * candidates[:, 1] - along.y_m * candidates[:, 0]) / max(_STANDS_M_S, math.hypot(*along))
    costs = np.sqrt(((candidates - wanted_m_s) ** 2).sum(axis=1)) + others.dangers(candidates, change_m_s2)
    costs += _TO_THE_LEFT * np.maximum(0.0, across)
    # Rounding errors must not decide between equals; the first one turns least.
    return Point(*candidates[int(costs.round(_ALIKE).argmin())].tolist())


def _away(movers: Sequence[Mover], place: Point) -> Point:
    """Returns the way from the nearest robot: the direction of one that wants to stand."""
    nearest = min(movers, key=lambda mover: math.dist(mover.place, place))
    return Point(place.x_m - nearest.place.x_m, place.y_m - nearest.place.y_m)


def _candidates(wanted_m_s: Point, now_m_s: Point, along: Point, least_m_s: float) -> list[Point]:
    """Returns velocities to choose from, around the direction `along`."""
    scale = max(least_m_s, math.hypot(*wanted_m_s)) / max(_STANDS_M_S, math.hypot(*along))
    x, y = along.x_m * scale, along.y_m * scale
    turned = [Point(x * cos - y * sin, x * sin + y * cos) for cos, sin in _CHANGES]
    return [wanted_m_s, *turned, now_m_s, Point(0.0, 0.0)]


def _may_brake(mover: Mover, place: Point) -> bool:
    """Returns whether the other robot drives nearby and has not agreed to evade."""
    drives = not mover.gives_way and math.hypot(*mover.velocity_m_s) > DRIVES_M_S
    return drives and math.dist(mover.place, place) < _EVADES_M


class _Others:
    """The robots nearby on their ways during the next moments; axes: velocity, time, way.

    A robot that may brake has two ways: it goes on as it does, and it brakes to a stop.
    """

    def __init__(self, movers: Sequence[Mover], place: Point, now_m_s: Point, apart_m: float) -> None:
        braking = [mover for mover in movers if _may_brake(mover, place)]
        steady, ways = len(movers), [*movers, *braking]
        self._now = np.array(now_m_s)
        to = np.array([mover.place for mover in ways]) - place
        self._velocity = np.array([mover.velocity_m_s for mover in ways])
        self._yields = np.array([mover.gives_way for mover in ways])
        stop_s = np.full(len(ways), math.inf)
        stop_s[steady:] = np.sqrt((self._velocity[steady:] ** 2).sum(axis=1)) / _BRAKES_M_S2
        drives_s = np.minimum(_TIMES_S[:, None], stop_s)
        self._left = 1.0 - drives_s / stop_s  # share of the velocity that is left (time, way)
        drives_s = drives_s - drives_s**2 / (2 * stop_s)
        away = np.sqrt((to**2).sum(axis=1))
        wide = apart_m + np.array([mover.margin_m for mover in ways])
        apart = np.minimum(wide, np.maximum(apart_m, away - 0.02))
        self._gap_x = to[:, 0] + self._velocity[:, 0] * drives_s - self._now[0] * _TIMES_S[:, None]
        self._gap_y = to[:, 1] + self._velocity[:, 1] * drives_s - self._now[1] * _TIMES_S[:, None]
        grown = np.minimum(apart + _GROWTH_M_S * _TIMES_S[:, None], np.maximum(apart, away - 0.02))
        self._apart_m2 = grown**2
        self._touching = away <= apart
        self._touches = bool(self._touching.any())

    def dangers(self, velocities: Floats, change_m_s2: float) -> Floats:
        """Returns the cost of the worst collision that each velocity (n, 2) leads to; 0 without one."""
        change = velocities - self._now
        speeds = np.sqrt((change**2).sum(axis=1))
        ramp_s = np.maximum(speeds / change_m_s2, 1e-9)[:, None]
        share = np.minimum(_TIMES_S / ramp_s, 1.0)  # of the change that has been made (velocity, time)
        way_s = np.where(share < 1.0, _TIMES_S * share / 2, _TIMES_S - ramp_s / 2)
        gap_x = self._gap_x - (change[:, :1] * way_s)[:, :, None]
        gap_y = self._gap_y - (change[:, 1:] * way_s)[:, :, None]
        away_m2 = gap_x * gap_x + gap_y * gap_y
        hits = away_m2 <= self._apart_m2
        hits[:, _LATE:, self._yields] = False
        if self._touches:
            hits[:, :_REACTED, self._touching] = False
            hits[:, _REACTED, self._touching] = True
        if not hits.any():
            return np.zeros(len(velocities))
        first = hits.argmax(axis=1)  # (velocity, way)
        row, way = np.nonzero(hits.any(axis=1))
        step = first[row, way]
        closing = (
            self._now + change[row] * share[row, step][:, None] - self._velocity[way] * self._left[step, way][:, None]
        )
        x, y = gap_x[row, step, way], gap_y[row, step, way]
        towards = (x * closing[:, 0] + y * closing[:, 1]) / np.sqrt(np.maximum(away_m2[row, step, way], 1e-9))
        time_s = np.where(self._touching[way], 0.0, _TIMES_S[step])
        urgency = 1.0 / np.maximum(time_s, _SOONEST_S) - 1.0 / _HORIZON_S
        cost = _WEIGHT_S * np.maximum(0.0, towards - _TOUCH_M_S) * urgency
        worst = np.zeros(len(velocities))
        np.maximum.at(worst, row, cost)
        return worst
