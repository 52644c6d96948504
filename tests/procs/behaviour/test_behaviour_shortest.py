"""Shortest ways around discs, and the way home at a kick-off."""

import math
import random

import pytest

from fwk.testing import Bench
from lcmtypes.soccer import drive_target_t, game_state_t, robot_estimate_t, world_model_t
from procs.behaviour import formation
from procs.behaviour.game import Game, Whose
from procs.behaviour.navigator import Navigator
from procs.behaviour.path import Disc
from procs.behaviour.shortest import first_turn
from procs.model.field import Field, Point
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


def seconds_to_place(own: Point, place: Point, rivals: list[Point], game: Game, field: Field = FIELD) -> float:
    """Drives a robot to its place at a set piece, past rivals that stand; returns the time, infinite after 15 s."""
    navigator, noise = Bench(Navigator, "cyan2/navigator", field=field), random.Random(1)
    others = [robot(f"magenta{number}", *rival) for number, rival in enumerate(rivals)]
    team = game_state_t.TEAM_CYAN if game.whose is Whose.OURS else game_state_t.TEAM_MAGENTA
    told = game_state_t(state=game.state, state_team=team, stopped=game.stopped)
    told.ball_x_m, told.ball_y_m = game.spot
    navigator.port("game_state").put(told)
    heading_rad = math.pi
    for tick in range(300):
        seen = Point(own.x_m + noise.gauss(0.0, 0.02), own.y_m + noise.gauss(0.0, 0.02))
        model = world_model_t(localized=True, x_m=seen.x_m, y_m=seen.y_m, heading_rad=heading_rad)
        model.opponents = [robot_estimate_t(x_m=rival.x_m, y_m=rival.y_m) for rival in rivals]
        model.ball.known, (model.ball.x_m, model.ball.y_m) = True, game.spot
        model.header.time_us = navigator.time_us
        navigator.port("world_model").put(model)
        step = formation.next_step(seen, place, game, field, others)
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
    game = Game(State.KICK_OFF, stopped=True, whose=whose, spot=Point(0.0, 0.0))
    assert seconds_to_place(Point(*own), Point(*place), [Point(*each) for each in rivals], game) < 8.0


@pytest.mark.parametrize(
    ("size_m", "spot", "own", "place", "others"),
    [
        ((18.0, 12.0), (4.25, 1.9), (5.15, -4.86), (0.98, 1.43), [(2.61, -1.19), (-2.52, 0.93), (0.82, -1.21)]),
        ((18.0, 12.0), (-3.86, -0.33), (-8.38, -1.96), (-4.85, 2.82), [(-1.39, -2.53), (-6.26, -2.59), (-6.12, 2.07)]),
        ((12.0, 8.0), (0.75, 2.7), (4.65, -0.2), (-2.08, 0.41), [(-0.46, -0.38), (0.51, -0.83), (-2.32, 1.47)]),
    ],
)
def test_robots_at_the_circle_do_not_keep_a_mate_from_its_place(
    size_m: tuple[float, float],
    spot: tuple[float, float],
    own: tuple[float, float],
    place: tuple[float, float],
    others: list[tuple[float, float]],
) -> None:
    """Two robots that stand there close the shorter side of the circle; a robot that tried it drove to and fro."""
    field = Field(length_m=size_m[0], width_m=size_m[1])
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=Point(*spot))
    assert seconds_to_place(Point(*own), Point(*place), [Point(*each) for each in others], game, field) < 10.0
