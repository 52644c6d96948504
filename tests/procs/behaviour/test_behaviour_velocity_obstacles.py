"""Velocity obstacles: two robots pass each other, and a robot does not run into one that stands."""

import math

import pytest

from procs.behaviour.velocity_obstacles import Mover, safe_velocity
from procs.model.field import Point

APART_M, REST = 0.56, Point(0.0, 0.0)


def driven(start: Point, target: Point, others: list[Mover], seconds: float = 3.0) -> tuple[Point, float]:
    """Drives a robot to a target; returns its place at the end and the least distance from the others."""
    place, now, least_m = start, REST, math.inf
    for tick in range(round(seconds * 20)):
        movers = [
            Mover(Point(x + vx * tick / 20, y + vy * tick / 20), Point(vx, vy), yields)
            for (x, y), (vx, vy), yields in others
        ]
        way = math.dist(place, target)
        speed = min(2.5, 3.0 * way)
        wanted = Point(*(speed * (to - at) / max(way, 1e-9) for at, to in zip(place, target, strict=True)))
        safe = safe_velocity(wanted, now, place, movers, APART_M, 3.0)
        change = math.dist(now, safe)
        share = min(1.0, 0.15 / max(change, 1e-9))
        now = Point(now.x_m + share * (safe.x_m - now.x_m), now.y_m + share * (safe.y_m - now.y_m))
        place = Point(place.x_m + now.x_m / 20, place.y_m + now.y_m / 20)
        least_m = min(least_m, *(math.dist(place, mover.place) for mover in movers))
    return place, least_m


def test_free_way_leaves_the_wanted_velocity() -> None:
    aside = Mover(Point(2.0, 2.0), REST, gives_way=False)
    assert safe_velocity(Point(2.0, 0.0), REST, REST, [aside], APART_M, 3.0) == (2.0, 0.0)


@pytest.mark.parametrize(
    ("place", "velocity"),
    [((2.0, 0.02), (0.0, 0.0)), ((4.0, 0.0), (-1.5, 0.0)), ((2.0, -2.0), (0.0, 1.2))],
    ids=["standing", "oncoming", "crossing"],
)
def test_robot_arrives_without_a_collision(place: tuple[float, float], velocity: tuple[float, float]) -> None:
    end, least_m = driven(REST, Point(4.5, 0.0), [Mover(Point(*place), Point(*velocity), gives_way=False)], 4.0)
    assert least_m > 0.5
    assert math.dist(end, (4.5, 0.0)) < 0.3


def test_robot_beside_another_may_leave() -> None:
    near = Mover(Point(0.5, 0.0), REST, gives_way=False)
    assert safe_velocity(Point(-2.0, 0.0), REST, REST, [near], APART_M, 3.0) == (-2.0, 0.0)
