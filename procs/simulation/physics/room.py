"""Room on the ground for the ball and robots: places between the walls that are clear of goals and of robots."""

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from heapq import merge
from itertools import combinations

from procs.model.field import SIDES, Field, Point, Segment
from procs.model.geometry import ahead, clamp
from procs.simulation.physics.arena import NET_RADIUS_M, nets
from procs.simulation.physics.start_places import free_place

_FIRST_M, _FURTHER = 0.02, 1.08  # radius of the first ring around a place that is not free, and from ring to ring
_BEARINGS = 48  # places tried on a ring
_SLACK_M = 1e-6  # bodies that touch are clear of each other


class Room:
    """Finds free places for round bodies."""

    def __init__(self, field: Field) -> None:
        self._x_m, self._y_m = field.half_length_m + field.border_m, field.half_width_m + field.border_m
        self._post_m = field.post_diameter_m / 2
        self._posts = [post for side in SIDES for post in field.goal_posts(side)]
        self._nets = [net for side in SIDES for net in nets(field, side)]

    def mistakes_in(self, starts: Mapping[str, Point], radius_m: float) -> Iterator[str]:
        """Yields why robots of that radius cannot begin at their places: walls, goals or each other are in the way."""
        x_m, y_m = self._x_m - radius_m, self._y_m - radius_m
        for name, place in starts.items():
            where = f"{name} at ({place.x_m:g}, {place.y_m:g})"
            if abs(place.x_m) > x_m + _SLACK_M or abs(place.y_m) > y_m + _SLACK_M:
                yield f"{where} is outside the walls; x is at most {x_m:g} m, y {y_m:g} m"
            elif not self.is_free(place, radius_m, (), 0.0):
                yield f"{where} is in a post or a net of a goal; a robot needs {radius_m:g} m"
        for (one, at), (other, there) in combinations(starts.items(), 2):
            distance_m = math.dist(at, there)
            if distance_m < 2 * radius_m - _SLACK_M:
                yield f"{one} and {other} are {distance_m:g} m apart; robots need {2 * radius_m:g} m"

    def is_free(self, place: Point, radius_m: float, robots: Sequence[Point], clearance_m: float) -> bool:
        """Returns whether a body fits.

        Args:
            place: middle of the body.
            radius_m: its radius.
            robots: middles of the robots that may be in the way.
            clearance_m: least distance to each of them.
        """
        x_m, y_m = place
        if abs(x_m) > self._x_m - radius_m + _SLACK_M or abs(y_m) > self._y_m - radius_m + _SLACK_M:
            return False
        if any(math.dist(place, robot) < clearance_m - _SLACK_M for robot in robots):
            return False
        if any(math.dist(place, post) < self._post_m + radius_m - _SLACK_M for post in self._posts):
            return False
        return all(_distance_m(place, net) >= NET_RADIUS_M + radius_m - _SLACK_M for net in self._nets)

    def nearest(
        self,
        wanted: Point,
        radius_m: float,
        robots: Sequence[Point],
        clearance_m: float,
        accepts: Callable[[Point], bool] = lambda _: True,
    ) -> Point | None:
        """Returns the free place nearest to the wanted one, of those tried; None if none of them is free.

        Tried are the place to which the robots in the way push the body, and 48 bearings on rings, each 8 % wider than
        the one before: a free place that is narrower than the steps between them may be missed. The arguments are those
        of `is_free`; `accepts` may refuse places.
        """
        x_m, y_m = self._x_m - radius_m, self._y_m - radius_m
        wanted = Point(clamp(wanted.x_m, -x_m, x_m), clamp(wanted.y_m, -y_m, y_m))
        beside = free_place(wanted, robots, clearance_m)
        rings = _around(wanted, 2 * math.hypot(self._x_m, self._y_m))
        places = merge([beside], rings, key=lambda place: math.dist(wanted, place))
        free = (place for place in places if self.is_free(place, radius_m, robots, clearance_m))
        return next(filter(accepts, free), None)


def _around(middle: Point, farthest_m: float) -> Iterator[Point]:
    """Yields places on rings around the middle, the nearest first."""
    away_m = _FIRST_M
    while away_m < farthest_m:
        for number in range(_BEARINGS):
            yield ahead(middle, math.tau * number / _BEARINGS, away_m)
        away_m *= _FURTHER


def _distance_m(place: Point, line: Segment) -> float:
    """Returns the distance from a place to a straight line."""
    (x_m, y_m), (end_x_m, end_y_m) = line
    along_x_m, along_y_m = end_x_m - x_m, end_y_m - y_m
    share = ((place.x_m - x_m) * along_x_m + (place.y_m - y_m) * along_y_m) / (along_x_m**2 + along_y_m**2)
    share = min(1.0, max(0.0, share))
    return math.dist(place, (x_m + share * along_x_m, y_m + share * along_y_m))
