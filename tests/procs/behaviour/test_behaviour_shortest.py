"""Shortest ways around discs, and the way home at a kick-off."""

import math
import random

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import drive_target_t, robot_estimate_t, world_model_t
from procs.behaviour import formation
from procs.behaviour.game import Game, Whose
from procs.behaviour.navigator import Navigator
from procs.behaviour.path import Disc
from procs.behaviour.shortest import first_turn
from procs.model.field import Point
from procs.model.game_states import State
from tests.procs.behaviour.behaviour_parts import FIELD, moved, robot

START, TARGET = Point(-3.0, 0.0), Point(3.0, 0.0)


def anywhere(_: Point) -> bool:
    return True


def test_free_way_is_straight() -> None:
    assert first_turn(START, TARGET, [Disc(Point(0.0, 2.0), 1.9)], anywhere) == TARGET


@pytest.mark.parametrize("side", [1.0, -1.0])
def test_way_leads_along_the_shorter_side(side: float) -> None:
    turn = first_turn(START, TARGET, [Disc(Point(0.0, -0.3 * side), 1.0)], anywhere)
    assert turn
    assert 0.6 < side * turn.y_m < 1.0


def test_way_leads_around_a_disc_that_closes_the_shorter_side() -> None:
    discs = [Disc(Point(0.0, -0.3), 1.0), Disc(Point(0.0, 1.2), 0.7)]
    turn = first_turn(START, TARGET, discs, anywhere)
    assert turn
    assert turn.y_m < -1.0
    turn = first_turn(START, TARGET, discs, lambda place: place.y_m > -1.0)
    assert turn
    assert turn.y_m > 1.5


def test_there_is_no_way_where_no_turn_is_possible() -> None:
    assert first_turn(START, TARGET, [Disc(Point(0.0, 0.0), 1.0)], lambda _: False) is None


@pytest.mark.parametrize("place", [START, TARGET])
def test_disc_over_an_end_of_the_way_shrinks(place: Point) -> None:
    assert first_turn(START, TARGET, [Disc(place, 1.0)], anywhere) == TARGET


def seconds_home(own: Point, place: Point, rivals: list[Point], whose: Whose) -> float:
    """Drives a robot to its place at a kick-off, past rivals that stand; returns the time, infinite after 15 s."""
    navigator, noise = Bench(Navigator, "cyan2/navigator"), random.Random(1)
    game = Game(State.KICK_OFF, stopped=True, whose=whose, spot=Point(0.0, 0.0))
    others = [robot(f"magenta{number}", *rival) for number, rival in enumerate(rivals)]
    heading_rad = math.pi
    for tick in range(300):
        seen = Point(own.x_m + noise.gauss(0.0, 0.02), own.y_m + noise.gauss(0.0, 0.02))
        model = world_model_t(localized=True, x_m=seen.x_m, y_m=seen.y_m, heading_rad=heading_rad)
        model.opponents = [robot_estimate_t(x_m=rival.x_m, y_m=rival.y_m) for rival in rivals]
        model.ball.known = True
        model.header.time_us = navigator.time_us
        navigator.port("world_model").put(model)
        step = formation.next_step(seen, place, game, FIELD, others)
        target = drive_target_t(x_m=step.x_m, y_m=step.y_m, avoid_ball=True)
        target.avoid_robots, target.header.time_us = True, navigator.time_us
        navigator.port("drive_target").put(target)
        navigator.iterate()
        own, heading_rad = moved(own, heading_rad, navigator.port("motor_command").sent[-1])
        if math.dist(own, place) < 0.3:
            return 0.05 * tick
    return math.inf


@pytest.mark.parametrize(
    ("whose", "own", "place", "rivals"),
    [
        (Whose.THEIRS, (4.42, -1.93), (-1.46, 2.97), [(2.75, 2.25)]),
        (Whose.THEIRS, (3.73, 0.23), (-3.2, 0.29), [(3.21, 1.81)]),
        (Whose.THEIRS, (5.07, 0.91), (-3.62, -1.61), [(3.16, -1.92)]),
        (Whose.OURS, (1.82, 1.26), (-4.29, -3.26), [(2.54, 0.65), (2.32, -1.69)]),
        (Whose.THEIRS, (2.84, -0.18), (-3.51, 0.85), [(2.82, 1.83), (2.31, 0.19)]),
        (Whose.OURS, (3.4, -1.74), (-2.22, 3.62), [(2.08, 1.19), (1.19, 2.6)]),
    ],
)
def test_rival_at_the_circle_does_not_keep_a_robot_from_home(
    whose: Whose, own: tuple[float, float], place: tuple[float, float], rivals: list[tuple[float, float]]
) -> None:
    assert seconds_home(Point(*own), Point(*place), [Point(*each) for each in rivals], whose) < 8.0
