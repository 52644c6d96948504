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
            other._replace(place=Point(*(at + speed * tick / 20 for at, speed in zip(*other[:2], strict=True))))
            for other in others
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
    end, least_m = driven(REST, Point(4.5, 0.0), [Mover(Point(*place), Point(*velocity), False, 0.1)], 4.0)
    assert least_m > 0.5
    assert math.dist(end, (4.5, 0.0)) < 0.3


def hardest(first: tuple[Point, Point], second: tuple[Point, Point], apart_m: float = 0.5) -> float:
    """Drives two mates, of which the second gives way; returns the closing speed of their collision, else 0."""
    ways, velocities = [first, second], [REST, REST]
    places = [start for start, _ in ways]
    for _ in range(60):
        chosen = []
        for own, other in ((0, 1), (1, 0)):
            target, way_m = ways[own][1], math.dist(places[own], ways[own][1])
            speed = min(2.5, 3.0 * way_m) / max(way_m, 1e-9)
            wanted = Point(speed * (target.x_m - places[own].x_m), speed * (target.y_m - places[own].y_m))
            mover = Mover(places[other], velocities[other], gives_way=own == 0, margin_m=0.1)
            chosen.append(safe_velocity(wanted, velocities[own], places[own], [mover], APART_M, 3.0))
        for own, safe in enumerate(chosen):
            now = velocities[own]
            share = min(1.0, 0.15 / max(math.dist(now, safe), 1e-9))
            now = Point(now.x_m + share * (safe.x_m - now.x_m), now.y_m + share * (safe.y_m - now.y_m))
            velocities[own], place = now, places[own]
            places[own] = Point(place.x_m + now.x_m / 20, place.y_m + now.y_m / 20)
        away_m = math.dist(*places)
        if away_m < apart_m:
            to_x, to_y = places[1].x_m - places[0].x_m, places[1].y_m - places[0].y_m
            one, two = velocities
            return ((one.x_m - two.x_m) * to_x + (one.y_m - two.y_m) * to_y) / away_m
    return 0.0


def test_mates_whose_ways_cross_do_not_collide() -> None:
    hits = []
    for degrees in range(20, 341, 20):
        angle = math.radians(degrees)
        start = Point(-2.5 * math.cos(angle), -2.5 * math.sin(angle))
        for late_m in (0.0, 0.3, 0.6):
            target = Point(2.0 * math.cos(angle), 2.0 * math.sin(angle))
            hits.append(hardest((Point(-2.5 - late_m, 0.0), Point(2.0, 0.0)), (start, target)))
    assert max(hits) < 1.0


def test_robot_does_not_rely_on_passing_behind_another() -> None:
    """Two robots that both turned to pass behind the other ran into each other at more than 3 m/s."""
    now = Point(2.0, 0.0)
    crossing, far = (
        Mover(Point(*place), Point(0.0, 1.8), gives_way=False, margin_m=0.1) for place in ((1.6, 0.0), (3.2, -1.4))
    )
    assert safe_velocity(now, now, REST, [crossing], APART_M, 3.0) != now, "it may brake"
    assert safe_velocity(now, now, REST, [crossing._replace(gives_way=True)], APART_M, 3.0) == now
    assert safe_velocity(now, now, REST, [far], APART_M, 3.0) == now


@pytest.mark.parametrize("aside_m", [-0.02, 0.0, 0.02])
def test_robots_that_meet_pass_on_the_same_side(aside_m: float) -> None:
    for turn_rad in (0.0, 1.0, math.pi):
        cos, sin = math.cos(turn_rad), math.sin(turn_rad)
        oncoming = Mover(
            Point(2.5 * cos - aside_m * sin, 2.5 * sin + aside_m * cos), Point(-2.0 * cos, -2.0 * sin), gives_way=False
        )
        wanted = Point(2.0 * cos, 2.0 * sin)
        safe = safe_velocity(wanted, wanted, REST, [oncoming], APART_M, 3.0)
        assert safe.y_m * cos - safe.x_m * sin < -0.1, "to the right"


def test_room_beside_a_robot_grows_with_its_uncertainty() -> None:
    def passed_m(margin_m: float) -> float:
        return driven(REST, Point(4.5, 0.0), [Mover(Point(2.0, 0.02), REST, gives_way=False, margin_m=margin_m)])[1]

    assert passed_m(0.25) > passed_m(0.1) + 0.03


def test_room_grows_with_the_time_until_robots_meet() -> None:
    wanted, now = Point(2.0, 0.0), Point(2.0, 0.0)
    far, near = (Mover(Point(x_m, 0.7), REST, gives_way=False, margin_m=0.1) for x_m in (2.2, 0.3))
    assert safe_velocity(wanted, now, REST, [far], APART_M, 3.0) != wanted, "by then it may have come closer"
    assert safe_velocity(wanted, now, REST, [near], APART_M, 3.0) == wanted


def test_robot_slows_down_rather_than_run_into_a_row() -> None:
    row = [Mover(Point(2.2, 0.8 * step), REST, gives_way=False, margin_m=0.1) for step in range(-3, 4)]
    chosen = safe_velocity(Point(2.5, 0.0), Point(2.5, 0.0), REST, row, APART_M, 3.0)
    assert math.hypot(*chosen) < 1.0


def test_robot_beside_another_may_leave() -> None:
    near = Mover(Point(0.5, 0.0), REST, gives_way=False)
    assert safe_velocity(Point(-2.0, 0.0), REST, REST, [near], APART_M, 3.0) == (-2.0, 0.0)


@pytest.mark.parametrize("bearing_rad", [0.1, 1.0, 2.0, 3.0, -0.7, -2.5])
def test_standing_robot_evades_alike_from_all_directions(bearing_rad: float) -> None:
    """The robot that keeps its place once evaded along the world's x axis, so that the teams played differently."""
    chosen = []
    for turn_rad in (0.0, math.pi, 0.4):
        cos, sin = math.cos(bearing_rad + turn_rad), math.sin(bearing_rad + turn_rad)
        place, velocity = Point(1.5 * cos - 0.1 * sin, 1.5 * sin + 0.1 * cos), Point(-1.5 * cos, -1.5 * sin)
        safe = safe_velocity(REST, REST, REST, [Mover(place, velocity, gives_way=False)], APART_M, 3.0)
        assert safe != REST
        chosen.append((safe.x_m * cos + safe.y_m * sin, safe.y_m * cos - safe.x_m * sin))
    assert chosen[1] == pytest.approx(chosen[0], abs=1e-9)
    assert chosen[2] == pytest.approx(chosen[0], abs=1e-9)
