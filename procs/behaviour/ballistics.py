"""Range of a rolling ball, speed of a kick, flight of a lob, and meeting points of ball and robot."""

import math
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

from procs.behaviour.bodies import Bodies
from procs.behaviour.view import Ball, View
from procs.model.field import Point
from procs.model.kicker import STEEPEST_RAD

_STEP_S, _HORIZON_S = 0.1, 4.0  # the ball's way is looked at in steps, up to the horizon
_RESTING_M_S = 0.2  # a slower ball counts as at rest
_SPEED_M_S, _ACCELERATION_M_S2 = 2.5, 2.5  # of a robot on its way to the ball; the navigator allows more
_CARRY_S = 0.25
"""A robot that drives reaches what a robot at rest reaches from the place where it will be after this time."""
_STANDING = Point(0.0, 0.0)
_GRAVITY_M_S2 = 9.81
_LOB_SPARE_M_S, _SPARE_M_S = 0.8, 0.1
"""A lob over the ground, and any kick, stay so far below the kicker's limit. A lob is as fast as it can be: the faster,
the less its error changes the height."""
_OVER_M = 0.09
"""The top of a lob's flight, which passes over robots and under the bar, is so far above a robot."""
_KEEPER_M = 0.45
"""A keeper's middle is so far before the goal line."""


class Meeting(NamedTuple):
    """Place and time at which a robot can be at the ball."""

    place: Point
    time_s: float


class Lob(NamedTuple):
    """Kick into the air, without the resistance of the air."""

    speed_m_s: float
    """Over the ground."""
    lift_m_s: float
    """Upwards."""

    def clear_m(self, height_m: float) -> float:
        """Returns how far from the kick the ball's lowest point gets above a height; infinite if it never does."""
        squared = self.lift_m_s**2 - 2 * _GRAVITY_M_S2 * height_m
        if squared < 0.0:
            return math.inf
        return self.speed_m_s * (self.lift_m_s - math.sqrt(squared)) / _GRAVITY_M_S2

    def is_possible(self, bodies: Bodies) -> bool:
        """Returns whether the kicker of a robot that stands is strong enough, and can kick so steeply."""
        steep = math.atan2(self.lift_m_s, self.speed_m_s) > STEEPEST_RAD
        return not steep and math.hypot(self.speed_m_s, self.lift_m_s) <= bodies.kick_limit_m_s


def lob(distance_m: float, bodies: Bodies, carried_m_s: float = 0.0) -> Lob:
    """Returns the lob that is as high as a goalkeeper's top and a little more when it gets to the goal.

    Its flight of `distance_m` is a parabola. The robot that kicks drives towards the goal at `carried_m_s`, which makes
    the lob faster than the kick. From near the goal the ball is at the top of its flight above the goalkeeper, from
    further away on its way down; a weak kicker cannot kick that far, as `Lob.is_possible` tells.
    """
    distance_m = max(2 * _KEEPER_M, distance_m)
    rise_s = math.sqrt(2 * (bodies.robot_height_m + _OVER_M) / _GRAVITY_M_S2)
    slow_m_s = (distance_m - _KEEPER_M) / rise_s
    speed_m_s = min(bodies.kick_limit_m_s - _LOB_SPARE_M_S + carried_m_s, slow_m_s)
    lift_m_s = _lift_m_s(distance_m / speed_m_s, rise_s)
    hardest_m_s = hardest_kick_m_s(bodies)
    kick_m_s = math.sqrt(hardest_m_s**2 - min(hardest_m_s / 2, lift_m_s) ** 2)
    speed_m_s = min(speed_m_s, kick_m_s + carried_m_s)
    return Lob(speed_m_s, _lift_m_s(distance_m / speed_m_s, rise_s))


def _lift_m_s(time_s: float, rise_s: float) -> float:
    """Returns the speed upwards at which the ball has the height of a lob at the goal after a time.

    `rise_s` is the time in which a ball falls from that height.
    """
    top_m = _GRAVITY_M_S2 * rise_s**2 / 2
    return top_m / time_s + _GRAVITY_M_S2 * time_s / 2


def carried(place: Point, velocity_m_s: Point) -> Point:
    """Returns the place from which a robot at rest reaches the same as a driving robot at `place`."""
    return Point(place.x_m + _CARRY_S * velocity_m_s.x_m, place.y_m + _CARRY_S * velocity_m_s.y_m)


def ball_after(ball: Ball, time_s: float, bodies: Bodies) -> Point:
    """Returns the position of the rolling ball after `time_s` without a touch."""
    speed_m_s = ball.speed_m_s
    if speed_m_s < 0.05:
        return ball.place
    rolling_m_s2 = bodies.rolling_m_s2
    rolling_s = min(time_s, speed_m_s / rolling_m_s2)
    share = rolling_s - rolling_m_s2 * rolling_s * rolling_s / (2 * speed_m_s)
    return Point(ball.place.x_m + ball.velocity_m_s.x_m * share, ball.place.y_m + ball.velocity_m_s.y_m * share)


def hardest_kick_m_s(bodies: Bodies) -> float:
    """Returns the highest speed that is asked of a kick."""
    return bodies.kick_limit_m_s - _SPARE_M_S


def kick_speed_m_s(distance_m: float, arrival_m_s: float, bodies: Bodies) -> float:
    """Returns the speed of a kick after which the ball still has the arrival speed that far away.

    The ball slides until its speed has fallen to `rolling_share` of the kick's, then rolls.
    """
    share, rolling_m_s2 = bodies.rolling_share, bodies.rolling_m_s2
    sliding_m = (1 - share**2) / (2 * bodies.sliding_m_s2)  # way of sliding for each (m/s)^2 of the kick
    squared = (arrival_m_s**2 + 2 * rolling_m_s2 * distance_m) / (share**2 + 2 * rolling_m_s2 * sliding_m)
    return math.sqrt(max(squared, arrival_m_s**2))


def reach_s(distance_m: float) -> float:
    """Returns the time in which a robot drives a distance from rest to rest."""
    if distance_m < _SPEED_M_S**2 / _ACCELERATION_M_S2:
        return 2 * math.sqrt(max(0.0, distance_m) / _ACCELERATION_M_S2)
    return distance_m / _SPEED_M_S + _SPEED_M_S / _ACCELERATION_M_S2


def way_m(time_s: float) -> float:
    """Returns the distance that a robot drives in a time from rest to rest: the inverse of `reach_s`."""
    if time_s < 2 * _SPEED_M_S / _ACCELERATION_M_S2:
        return _ACCELERATION_M_S2 * time_s**2 / 4
    return _SPEED_M_S * time_s - _SPEED_M_S**2 / _ACCELERATION_M_S2


_WAYS = [(step * _STEP_S, way_m(step * _STEP_S)) for step in range(round(_HORIZON_S / _STEP_S) + 1)]


class Course:
    """The ball's way during the next four seconds, and how far a robot can get meanwhile."""

    def __init__(self, ball: Ball, bodies: Bodies) -> None:
        self.bodies = bodies
        """Sizes of the robots and the ball."""
        self._ball = ball
        self._contact_m = contact_m = bodies.held_ball_m  # distance of the middles of ball and robot that meet
        speed_m_s = ball.speed_m_s
        self._resting = speed_m_s < _RESTING_M_S
        self._stations: list[tuple[float, float, float, float]] = []
        """Place of the ball, time, and how near a robot has to be now to meet it there."""
        if self._resting:
            return
        rolling_m_s2 = bodies.rolling_m_s2
        (x_m, y_m), (vx_m_s, vy_m_s), stands_s = ball.place, ball.velocity_m_s, speed_m_s / rolling_m_s2
        for time_s, robot_m in _WAYS:
            rolling_s = min(time_s, stands_s)
            share = rolling_s - rolling_m_s2 * rolling_s * rolling_s / (2 * speed_m_s)
            self._stations.append((x_m + vx_m_s * share, y_m + vy_m_s * share, time_s, robot_m + contact_m))
        self._is_fast = speed_m_s * _STEP_S > contact_m  # it passes a robot between two stations

    def meet(self, place: Point, velocity_m_s: Point = _STANDING) -> Meeting:
        """Returns the earliest meeting with a robot that is now at `place`.

        If the ball outruns the robot, the meeting is where the ball will be at the end of the four seconds.
        """
        own_x_m, own_y_m = carried(place, velocity_m_s)
        if self._resting:
            away_m = math.hypot(own_x_m - self._ball.place.x_m, own_y_m - self._ball.place.y_m)
            return Meeting(self._ball.place, reach_s(away_m - self._contact_m))
        for x_m, y_m, time_s, near_m in self._stations_for(own_x_m, own_y_m) if self._is_fast else self._stations:
            if (own_x_m - x_m) ** 2 + (own_y_m - y_m) ** 2 <= near_m * near_m:
                return Meeting(Point(x_m, y_m), time_s)
        x_m, y_m, time_s, _ = self._stations[-1]
        needed_s = reach_s(math.hypot(own_x_m - x_m, own_y_m - y_m) - self._contact_m)
        return Meeting(Point(x_m, y_m), max(time_s, needed_s))

    def _stations_for(self, own_x_m: float, own_y_m: float) -> Iterator[tuple[float, float, float, float]]:
        """Yields the stations, and between two of them the one that is nearest to a robot."""
        yield self._stations[0]
        for before, after in pairwise(self._stations):
            dx_m, dy_m = after[0] - before[0], after[1] - before[1]
            along_m2, way_m2 = (own_x_m - before[0]) * dx_m + (own_y_m - before[1]) * dy_m, dx_m**2 + dy_m**2
            if 0.0 < along_m2 < way_m2:
                share = along_m2 / way_m2
                x_m, y_m, time_s, near_m = (
                    start + share * (end - start) for start, end in zip(before, after, strict=True)
                )
                yield x_m, y_m, time_s, near_m
            yield after


def meet(view: View) -> Meeting:
    """Returns the earliest meeting of the ball with the own robot."""
    return Course(view.ball, view.bodies).meet(view.own.place, view.own.velocity_m_s)
