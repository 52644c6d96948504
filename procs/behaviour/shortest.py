"""Finds the shortest way around discs, over points beside them; a robot that follows it does not turn back."""

import heapq
import math
from collections.abc import Callable, Iterator, Sequence
from itertools import pairwise

from procs.behaviour.path import Disc
from procs.model.field import Point
from procs.model.geometry import ahead

_STEPS = 16  # points around a disc
_OUTSIDE = 1.0 / math.cos(math.pi / _STEPS)  # then the sides between them touch the disc
_CLEAR_M = 0.01


def first_turn(start: Point, target: Point, discs: Sequence[Disc], possible: Callable[[Point], bool]) -> Point | None:
    """Returns where the shortest way turns first: the target if nothing stands between; None if there is no way.

    Ways turn only at places that are `possible`. A disc that covers start or target shrinks to leave it out. Most discs
    are far from the way; a search among those that stand in it, until none does, takes much less time than among all.
    """
    shrunk = [_shrunk(disc, start, target) for disc in discs]
    in_the_way: list[Disc] = []
    way: list[Point] = [start, target]
    while crossed := [disc for disc in shrunk if any(_covers(disc, *leg) for leg in pairwise(way))]:
        in_the_way += crossed
        way = _shortest(start, target, in_the_way, possible)
        if not way:
            return None
    return way[1]


def _shortest(start: Point, target: Point, discs: Sequence[Disc], possible: Callable[[Point], bool]) -> list[Point]:
    """Returns the places of the shortest way (A*), with both ends; empty if there is none.

    The search looks for discs on a leg when it takes the leg up; it never takes up most of them.
    """
    open_places = [target, *(place for place in _beside(discs) if possible(place))]
    waiting: list[tuple[float, float, Point, Point | None]] = [(math.dist(start, target), 0.0, start, None)]
    before: dict[Point, Point | None] = {}
    while waiting and target not in before:
        _, way_m, place, came_from = heapq.heappop(waiting)
        if place in before or (came_from and any(_covers(disc, came_from, place) for disc in discs)):
            continue
        before[place] = came_from
        for following in open_places:
            if following not in before:
                there_m = way_m + math.dist(place, following)
                heapq.heappush(waiting, (there_m + math.dist(following, target), there_m, following, place))
    way, place_before = [], target if target in before else None
    while place_before is not None:
        way.append(place_before)
        place_before = before[place_before]
    return way[::-1]


def _shrunk(disc: Disc, start: Point, target: Point) -> Disc:
    room_m = min(math.dist(disc.middle, start), math.dist(disc.middle, target)) - _CLEAR_M
    return disc if disc.radius_m <= room_m else Disc(disc.middle, max(0.0, room_m))


def _beside(discs: Sequence[Disc]) -> Iterator[Point]:
    """Yields the points around each disc that no other disc covers."""
    for disc in discs:
        for step in range(_STEPS):
            place = ahead(disc.middle, step * math.tau / _STEPS, disc.radius_m * _OUTSIDE + _CLEAR_M)
            if all(math.dist(place, other.middle) >= other.radius_m for other in discs):
                yield place


def _covers(disc: Disc, start: Point, end: Point) -> bool:
    """Returns whether a disc covers a part of the straight way."""
    dx, dy = end.x_m - start.x_m, end.y_m - start.y_m
    to_x, to_y = disc.middle.x_m - start.x_m, disc.middle.y_m - start.y_m
    length_m2 = dx * dx + dy * dy
    share = min(1.0, max(0.0, (to_x * dx + to_y * dy) / length_m2)) if length_m2 else 0.0
    off_x, off_y = to_x - share * dx, to_y - share * dy
    return off_x * off_x + off_y * off_y < disc.radius_m * disc.radius_m
