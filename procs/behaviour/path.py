"""Finds a way around discs: the direction of the freest tangent, as in a visibility graph of one step."""

import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

from procs.model.field import Point
from procs.model.geometry import ahead, bearing_rad, wrap_rad

_GRAZE_RAD = 0.02  # a way passes a disc by this angle more than its tangent
_SWITCH_RAD = 0.35
"""The other side of an obstacle must save so much turning, or a robot in front of two equal ways would dither."""
_CROWD_M = 0.02  # between a target and the core of the disc that covers it


class Disc(NamedTuple):
    """An area that the robot's middle avoids."""

    middle: Point
    radius_m: float
    core_m: float = 0.0
    """A target nearer to the middle than this is not approached further."""


class Way(NamedTuple):
    """Direction and length of a way towards the target."""

    direction_rad: float
    length_m: float
    """Length of the way, with the visible detour."""
    free_m: float
    """Free distance in that direction."""
    blocked: bool
    """No direction is free."""


def find_way(
    start: Point,
    target: Point,
    discs: Sequence[Disc],
    before_rad: float | None = None,
    possible: Callable[[Point], bool] | None = None,
) -> Way:
    """Finds the free way that turns least from the straight one.

    A disc that covers the target shrinks until the target lies outside it, but not below its core; from a disc that
    covers the start the way leads out. `before_rad` is the direction of the last tick: staying on the same side is
    preferred. Detours lead only over places that are `possible`: not behind a wall.
    """
    for disc in discs:
        if math.dist(disc.middle, target) < disc.core_m + _CROWD_M:
            target = ahead(disc.middle, bearing_rad(disc.middle, start), disc.core_m + _CROWD_M)
    distance_m, straight_rad = math.dist(start, target), bearing_rad(start, target)
    shrunk = [_shrink(disc, start, target) for disc in discs]
    free_m = _free_m(start, straight_rad, shrunk)
    if free_m >= distance_m:
        return Way(straight_rad, distance_m, free_m, blocked=False)
    best: tuple[float, Way] | None = None
    for disc in shrunk:
        away_m = math.dist(start, disc.middle)
        if away_m > distance_m + disc.radius_m:
            continue
        middle_rad = bearing_rad(start, disc.middle)
        half_rad = math.asin(min(1.0, disc.radius_m / max(away_m, 1e-6))) + _GRAZE_RAD
        needed_m = math.sqrt(max(0.0, away_m**2 - disc.radius_m**2))
        for direction_rad in (middle_rad + half_rad, middle_rad - half_rad):
            free_m = _free_m(start, direction_rad, shrunk)
            if free_m < needed_m:
                continue
            turning_place = ahead(start, direction_rad, needed_m)
            if possible and not possible(turning_place):
                continue
            turn_rad = wrap_rad(direction_rad - straight_rad)
            cost_rad = abs(turn_rad)
            if before_rad is not None and turn_rad * wrap_rad(before_rad - straight_rad) < 0:
                cost_rad += _SWITCH_RAD
            if best is None or cost_rad < best[0]:
                length_m = needed_m + math.dist(turning_place, target)
                best = cost_rad, Way(wrap_rad(direction_rad), length_m, free_m, blocked=False)
    return best[1] if best else Way(straight_rad, distance_m, _free_m(start, straight_rad, shrunk), blocked=True)


def _shrink(disc: Disc, start: Point, target: Point) -> Disc:
    room_m = min(math.dist(disc.middle, start), math.dist(disc.middle, target) - _CROWD_M)
    return disc if disc.radius_m <= room_m else Disc(disc.middle, max(0.0, room_m))


def _free_m(start: Point, direction_rad: float, discs: Sequence[Disc]) -> float:
    """Returns the length of a ray up to the first disc; infinite without one."""
    dx, dy = math.cos(direction_rad), math.sin(direction_rad)
    free_m = math.inf
    for disc in discs:
        to_x, to_y = disc.middle.x_m - start.x_m, disc.middle.y_m - start.y_m
        along_m = to_x * dx + to_y * dy
        if along_m <= 0.0:
            continue
        aside_m2 = to_x * to_x + to_y * to_y - along_m * along_m
        depth_m2 = disc.radius_m * disc.radius_m - aside_m2
        if depth_m2 > 0.0:
            free_m = min(free_m, max(0.0, along_m - math.sqrt(depth_m2)))
    return free_m
