"""Paths around discs."""

import math

import pytest

from procs.behaviour import obstacles
from procs.behaviour.bodies import USUAL
from procs.behaviour.path import Disc, find_way
from procs.model.field import Point
from tests.procs.behaviour.behaviour_parts import FIELD

START, TARGET = Point(0.0, 0.0), Point(4.0, 0.0)


def test_free_path_is_straight() -> None:
    way = find_way(START, TARGET, [Disc(Point(2.0, 1.0), 0.6), Disc(Point(-1.0, 0.0), 0.6)])
    assert (way.direction_rad, way.length_m, way.blocked) == (0.0, 4.0, False)


@pytest.mark.parametrize(("y_m", "side"), [(0.1, -1.0), (-0.1, 1.0)])
def test_disc_is_passed_on_the_shorter_side(y_m: float, side: float) -> None:
    way = find_way(START, TARGET, [Disc(Point(2.0, y_m), 0.6)])
    assert way.direction_rad * side > 0
    assert 4.0 < way.length_m < 4.4


def test_robot_that_began_to_pass_on_one_side_stays_there() -> None:
    disc = Disc(Point(2.0, 0.02), 0.6)
    assert find_way(START, TARGET, [disc]).direction_rad < 0
    assert find_way(START, TARGET, [disc], before_rad=0.3).direction_rad > 0


def test_two_overlapping_discs_are_passed_as_one() -> None:
    way = find_way(START, TARGET, [Disc(Point(2.0, 0.1), 0.6), Disc(Point(2.0, -0.9), 0.6)])
    assert way.direction_rad > 0


def test_closed_ring_has_no_path_out() -> None:
    ring = [Disc(Point(math.cos(turn), math.sin(turn)), 0.6) for turn in (index * math.pi / 4 for index in range(8))]
    way = find_way(START, TARGET, ring)
    assert way.blocked
    assert way.free_m < 0.5


def test_target_in_a_disc_is_approached_from_outside() -> None:
    way = find_way(START, Point(1.7, 0.0), [Disc(Point(2.0, 0.0), 0.6)])
    assert not way.blocked
    assert way.direction_rad == 0.0


def test_target_inside_a_disc_is_approached_to_its_edge() -> None:
    way = find_way(START, Point(2.1, 0.1), [Disc(Point(2.0, 0.0), 0.6, core_m=0.5)])
    assert not way.blocked
    assert way.length_m == pytest.approx(1.48)


@pytest.mark.parametrize("target", [Point(-3.0, 0.0), Point(0.0, 3.0)])
def test_path_from_inside_a_disc_leads_out(target: Point) -> None:
    way = find_way(START, target, [Disc(Point(0.4, 0.0), 0.6)])
    assert not way.blocked


def test_following_the_path_touches_no_disc_and_arrives() -> None:
    discs = [Disc(Point(1.5, 0.3), 0.6), Disc(Point(2.5, -0.5), 0.6), Disc(Point(1.8, -1.2), 0.6)]
    place, direction_rad = START, None
    for _ in range(200):
        way = find_way(place, TARGET, discs, direction_rad)
        direction_rad = way.direction_rad
        step_m = min(0.05, way.length_m)
        place = Point(place.x_m + step_m * math.cos(direction_rad), place.y_m + step_m * math.sin(direction_rad))
        assert all(math.dist(place, disc.middle) > disc.radius_m - 0.01 for disc in discs)
    assert math.dist(place, TARGET) < 0.01


def test_no_way_leads_between_an_obstacle_and_the_wall() -> None:
    at_wall, target, parked = Point(-3.7, -7.75), Point(-1.4, -6.8), Disc(Point(-3.1, -7.5), 0.62, 0.5)
    towards_wall_rad = -0.9
    way = find_way(
        at_wall, target, [parked], towards_wall_rad, lambda place: obstacles.inside_walls(place, FIELD, USUAL)
    )
    assert 0.5 < way.direction_rad < 2.5
