"""Ways around the nets of goals, and of field players around the goal areas."""

import math
from collections.abc import Iterator
from functools import partial

import pytest

from procs.behaviour import obstacles
from procs.behaviour.bodies import USUAL
from procs.behaviour.goals import Goals
from procs.behaviour.path import Disc, find_way
from procs.model.field import SIDES, Field, Point
from tests.procs.behaviour.behaviour_parts import FIELD

GOALS = Goals(FIELD, USUAL)
DEEP = Field(border_m=2.5)
"""Robots can drive behind the goals."""
POSTS = [Disc(post, 0.3425) for side in SIDES for post in FIELD.goal_posts(side)]


def possible(goals: Goals, field: Field, areas: bool, start: Point, end: Point) -> bool:
    return obstacles.inside_walls(end, field, USUAL) and goals.is_open(start, end, areas)


def driven(start: Point, target: Point, field: Field = FIELD, areas: bool = False) -> Iterator[Point]:
    """Yields the places of a robot that follows its way in small steps, until it has arrived."""
    goals, place, direction_rad = Goals(field, USUAL), start, None
    for _ in range(1000):
        turn = goals.turning_place(place, target, areas, POSTS)
        way = find_way(place, turn, POSTS, direction_rad, partial(possible, goals, field, areas, place))
        direction_rad = way.direction_rad
        step_m = min(0.03, way.length_m)
        place = Point(place.x_m + step_m * math.cos(direction_rad), place.y_m + step_m * math.sin(direction_rad))
        yield place
        if math.dist(place, target) < 0.05:
            return


def in_net(place: Point) -> bool:
    """Returns whether the middle of a robot is so near to a goal, outside it, that the robot touches the net."""
    behind_m = abs(place.x_m) - FIELD.half_length_m
    return 0.0 < behind_m < FIELD.goal_depth_m + 0.24 and 1.0 < abs(place.y_m) < 1.5


@pytest.mark.parametrize(
    ("start", "target"),
    [
        (Point(10.6, 3.0), Point(10.7, 0.5)),
        (Point(11.3, 1.6), Point(8.0, -2.0)),
        (Point(-11.3, -1.55), Point(-8.0, 2.0)),
        (Point(11.4, 2.2), Point(11.4, -2.5)),
        (Point(11.2, 0.4), Point(11.3, 2.2)),
        (Point(10.9, 0.0), Point(11.4, -1.9)),
        (Point(-11.4, 3.0), Point(11.4, -1.8)),
    ],
)
@pytest.mark.parametrize("field", [FIELD, DEEP])
def test_way_between_places_leads_through_no_net(field: Field, start: Point, target: Point) -> None:
    places = list(driven(start, target, field))
    assert math.dist(places[-1], target) < 0.05
    assert not any(map(in_net, places))


def test_robot_behind_a_goal_takes_the_shorter_way_round() -> None:
    places = list(driven(Point(12.6, 0.5), Point(5.0, 0.0), DEEP))
    assert math.dist(places[-1], Point(5.0, 0.0)) < 0.05
    assert max(place.y_m for place in places) > 1.5
    assert min(place.y_m for place in places) > -0.1


def test_robot_comes_out_of_a_goal_between_its_posts() -> None:
    for place in driven(Point(11.3, 0.8), Point(10.0, 5.0)):
        assert place.x_m < 10.95 or abs(place.y_m) < 1.0


def test_far_from_goals_the_target_stays_as_it_is() -> None:
    start, target = Point(-10.9, 6.0), Point(10.9, -1.7)
    assert GOALS.turning_place(start, target, areas=False) is target
    assert GOALS.is_open(start, target, areas=False)


def test_post_is_not_passed_through_its_net() -> None:
    beside = Point(10.6, 3.0)
    assert not GOALS.is_open(beside, Point(11.28, 1.3), areas=False)
    assert GOALS.is_open(beside, Point(10.6, 1.3), areas=False)
    assert not GOALS.is_open(Point(11.3, 0.8), Point(11.2, 1.4), areas=False)


def test_turning_place_with_a_robot_gives_way_outwards() -> None:
    start, target = Point(11.4, 2.2), Point(11.4, -2.5)
    free = GOALS.turning_place(start, target, areas=False)
    taken = Disc(Point(free.x_m, free.y_m + 0.1), 0.62, 0.5)
    turn = GOALS.turning_place(start, target, areas=False, discs=[taken])
    assert turn.y_m > free.y_m + 0.5
    assert math.dist(turn, taken.middle) > taken.radius_m


@pytest.mark.parametrize(
    ("start", "target"),
    [
        (Point(10.5, 3.0), Point(10.5, -3.0)),
        (Point(-11.4, 2.3), Point(-10.4, -2.4)),
        (Point(11.3, 1.7), Point(8.0, -2.0)),
        (Point(-10.2, 2.5), Point(-10.9, 5.0)),
    ],
)
@pytest.mark.parametrize("field", [FIELD, DEEP])
def test_field_player_drives_around_goal_areas(field: Field, start: Point, target: Point) -> None:
    places = list(driven(start, target, field, areas=True))
    assert math.dist(places[-1], target) < 0.05
    assert not any(field.in_goal_area(*place, side) for place in places for side in SIDES)


@pytest.mark.parametrize("start", [Point(10.9, 0.3), Point(-10.4, 1.0), Point(10.8, -1.8), Point(-11.3, 0.2)])
def test_field_player_comes_out_of_a_goal_area(start: Point) -> None:
    places = list(driven(start, Point(0.0, 0.0), areas=True))
    inside = [any(FIELD.in_goal_area(*place, side) for side in SIDES) for place in places]
    assert sum(inside) * 0.03 < 1.5
    assert math.hypot(*places[-1]) < 0.05


@pytest.mark.parametrize(
    ("place", "expected"),
    [
        (Point(10.9, 0.3), Point(10.15, 0.3)),
        (Point(-10.9, -1.9), Point(-10.9, -2.05)),
        (Point(10.1, 0.0), Point(10.1, 0.0)),
        (Point(-10.5, 2.1), Point(-10.5, 2.1)),
        (Point(11.4, 1.8), Point(11.4, 1.8)),
    ],
)
def test_place_in_a_goal_area_moves_to_its_edge(place: Point, expected: Point) -> None:
    assert GOALS.outside_areas(place) == pytest.approx(expected)
