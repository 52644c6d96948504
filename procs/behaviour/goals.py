"""Ways around the goals: their nets, and for field players the goal areas, which only goalkeepers may enter.

Here u is the distance behind a goal line, and v that to the left of the middle of the field, which is y.
"""

import math
from collections.abc import Sequence
from typing import NamedTuple

from procs.behaviour.bodies import Bodies
from procs.behaviour.path import Disc
from procs.model.field import SIDES, Field, Point
from procs.model.geometry import clamp

_OFF_POST_M = 0.05  # room between a robot that drives around a post and the post
_NET_M = 0.04  # thickness of a net
_OFF_AREA_M = 0.1  # field players keep so far off the goal areas
_CORNER_M = 0.02  # a turning place lies so far off the block
_ROOM_M = 0.05  # beside a robot that stands at a turning place


class _Place(NamedTuple):
    u_m: float
    v_m: float


class _Block(NamedTuple):
    """A rectangle behind and before a goal line that the robot's middle avoids."""

    front_m: float
    back_m: float
    """Infinite without room between the goal and the wall."""
    aside_m: float
    before_m: float = 0.0
    """Turning places lie so far before the front."""

    def holds(self, place: _Place) -> bool:
        return self.front_m < place.u_m < self.back_m and abs(place.v_m) < self.aside_m

    def is_crossed(self, start: _Place, end: _Place) -> bool:
        """Returns whether the straight way leads through the inside."""
        first, last = 0.0, 1.0
        for at_m, change_m, low_m, high_m in (
            (start.u_m, end.u_m - start.u_m, self.front_m, self.back_m),
            (start.v_m, end.v_m - start.v_m, -self.aside_m, self.aside_m),
        ):
            if abs(change_m) < 1e-9:
                if not low_m < at_m < high_m:
                    return False
                continue
            enters, leaves = sorted(((low_m - at_m) / change_m, (high_m - at_m) / change_m))
            first, last = max(first, enters), min(last, leaves)
        return first < last - 1e-9

    def corners(self) -> list[_Place]:
        aside_m = self.aside_m + _CORNER_M
        rows_m = [self.front_m - self.before_m - _CORNER_M]
        if math.isfinite(self.back_m):
            rows_m.append(self.back_m + _CORNER_M)
        return [_Place(u_m, side * aside_m) for u_m in rows_m for side in SIDES]


class Goals:
    """Finds turning places on ways that nets, or goal areas, stand in; does nothing on other ways."""

    def __init__(self, field: Field, bodies: Bodies) -> None:
        self._field = field
        self._line_m = -field.line_width_m / 2  # where the posts stand
        self._post_m = (field.goal_width_m + field.post_diameter_m) / 2
        self._depth_m = field.goal_depth_m + _NET_M
        self._touching = _Block(
            self._line_m, self._back_m(bodies, bodies.robot_radius_m), self._post_m + bodies.robot_radius_m
        )
        off_m = bodies.robot_radius_m + field.post_diameter_m / 2 + _OFF_POST_M
        back_m = self._back_m(bodies, off_m)
        self._mouth_m = self._post_m - off_m
        self._nets = _Block(self._line_m, back_m, self._post_m + off_m, off_m)
        self._area = _Block(-field.goal_area_depth_m, back_m, field.goal_area_width_m / 2)
        self._off_area = _Block(
            self._area.front_m - _OFF_AREA_M, back_m, max(self._area.aside_m + _OFF_AREA_M, self._nets.aside_m)
        )

    def outside_areas(self, place: Point) -> Point:
        """Returns the place, or the nearest one that is off the goal areas."""
        for side in SIDES:
            here = self._seen(place, side)
            if self._off_area.holds(here) and here.u_m <= 0.0:
                return self._point(self._way_out(here), side)
        return place

    def turning_place(self, start: Point, target: Point, areas: bool, discs: Sequence[Disc] = ()) -> Point:
        """Returns the target, or the place where the shortest way around goals turns first.

        `areas`: the way also leads around the goal areas, and out of them. `discs` are other obstacles: a turning
        place in one of them gives way to the side.
        """
        for side in SIDES if start.x_m > 0.0 else SIDES[::-1]:  # the goal at the start last
            here, there = self._seen(start, side), self._seen(target, side)
            block = self._off_area if areas else self._nets
            if max(here.u_m, there.u_m) <= block.front_m:
                continue
            if turn := self._turn(here, there, block, areas):
                target = self._point(turn, side)
                if abs(turn.v_m) > self._post_m:
                    target = _beside(target, discs)
        return target

    def is_open(self, start: Point, end: Point, areas: bool) -> bool:
        """Returns whether a straight detour leads through no net, nor into a goal area that is to be avoided."""
        for side in SIDES:
            here, there = self._seen(start, side), self._seen(end, side)
            block = self._area if areas else self._touching
            if max(here.u_m, there.u_m) <= block.front_m:
                continue
            if self._in_goal(here):
                if abs(self._crossing_m(here, there)) > self._post_m:
                    return False
            elif self._shrunk(block, here).is_crossed(here, there):
                return False
        return True

    def _turn(self, here: _Place, there: _Place, block: _Block, areas: bool) -> _Place | None:
        if self._in_goal(here):
            crossing_m = self._crossing_m(here, there)
            if there.u_m < self._line_m and abs(crossing_m) <= self._mouth_m:
                return None
            return _Place(self._line_m - _OFF_AREA_M, clamp(crossing_m, -self._mouth_m, self._mouth_m))
        from_beside = there.u_m <= 0.0 and abs(here.v_m) >= self._post_m
        if areas and self._area.holds(here) and (here.u_m <= 0.0 or from_beside):
            return self._way_out(here)
        free = self._shrunk(self._shrunk(block, here), there)
        if not free.is_crossed(here, there):
            return None
        return min((_way_m(here, corner, there, free, block.corners()), corner) for corner in block.corners())[1]

    def _shrunk(self, block: _Block, place: _Place) -> _Block:
        """Returns the block without the part that a robot at the place is in."""
        if not block.holds(place):
            return block
        if place.u_m > self._line_m:
            beside = abs(place.v_m) >= self._post_m
            return block._replace(aside_m=abs(place.v_m)) if beside else block._replace(back_m=place.u_m)
        if place.u_m - block.front_m <= block.aside_m - abs(place.v_m):
            return block._replace(front_m=place.u_m)
        return block._replace(aside_m=abs(place.v_m))

    def _way_out(self, here: _Place) -> _Place:
        block = self._off_area
        if here.u_m - block.front_m <= block.aside_m - abs(here.v_m):
            return _Place(block.front_m, here.v_m)
        return _Place(here.u_m, math.copysign(block.aside_m, here.v_m))

    def _in_goal(self, place: _Place) -> bool:
        return self._line_m < place.u_m < self._depth_m and abs(place.v_m) < self._post_m

    def _crossing_m(self, here: _Place, there: _Place) -> float:
        """Returns where the way out of the goal crosses the line of the posts; its end, if that is in the goal too."""
        if there.u_m >= self._line_m:
            return there.v_m
        share = (self._line_m - here.u_m) / (there.u_m - here.u_m)
        return here.v_m + share * (there.v_m - here.v_m)

    def _back_m(self, bodies: Bodies, off_m: float) -> float:
        back_m = self._depth_m + off_m
        return back_m if back_m + _CORNER_M < self._field.border_m - bodies.robot_radius_m else math.inf

    def _seen(self, place: Point, side: float) -> _Place:
        return _Place(side * place.x_m - self._field.half_length_m, place.y_m)

    def _point(self, place: _Place, side: float) -> Point:
        return Point(side * (place.u_m + self._field.half_length_m), place.v_m)


def _way_m(here: _Place, turn: _Place, there: _Place, block: _Block, corners: Sequence[_Place]) -> float:
    """Returns the length of the shortest way with that first turn; infinite without one."""
    if block.is_crossed(here, turn):
        return math.inf
    way_m = math.dist(here, turn)
    if not block.is_crossed(turn, there):
        return way_m + math.dist(turn, there)
    others = [corner for corner in corners if corner != turn]
    return way_m + min((_way_m(turn, corner, there, block, others) for corner in others), default=math.inf)


def _beside(place: Point, discs: Sequence[Disc]) -> Point:
    """Returns the place, or one further from the middle of the field's width that no disc covers."""
    side = math.copysign(1.0, place.y_m)
    for disc in sorted(discs, key=lambda disc: side * disc.middle.y_m):
        if math.dist(place, disc.middle) < disc.radius_m:
            place = Point(place.x_m, disc.middle.y_m + side * (disc.radius_m + _ROOM_M))
    return place
