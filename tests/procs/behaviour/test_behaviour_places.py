"""Places of teams of all sizes on fields of all sizes: in the field, off the walls, and apart."""

import itertools
import math
from collections.abc import Iterator

import pytest

from procs.behaviour import formation, set_pieces
from procs.behaviour.bodies import Bodies
from procs.behaviour.company import job_among_silent
from procs.behaviour.game import Game, Whose
from procs.behaviour.posts import PLAY, posts
from procs.model.ball import BALL
from procs.model.field import SIDES, Field, Point
from procs.model.game_states import State
from procs.model.robot import RobotModel
from tests.procs.behaviour.behaviour_parts import ball, robot, view

SMALL = {
    "restart_offset_m": 1.0,
    "penalty_mark_distance_m": 1.8,
    "penalty_area_width_m": 3.5,
    "penalty_area_depth_m": 1.2,
    "goal_area_width_m": 2.6,
    "goal_area_depth_m": 0.5,
    "goal_width_m": 1.5,
}
FIELDS = {
    "usual": Field(),
    "at the walls": Field(border_m=0.3, goal_depth_m=0.3),
    "large": Field(length_m=28.0, width_m=18.0),
    "medium": Field(length_m=18.0, width_m=12.0),
    "short": Field(length_m=12.0, width_m=8.0),
    "small": Field(length_m=9.0, width_m=6.0, **SMALL),
}
STATES = (State.FREE_KICK, State.THROW_IN, State.GOAL_KICK, State.CORNER_KICK, State.DROP_BALL)
FIELD_PLAYERS = 5
"""The ball's taker and four more, as in a team of six; smaller teams have the first of these places."""
MARGIN_M = 0.1

every_field = pytest.mark.parametrize("field", FIELDS.values(), ids=FIELDS)
every_size = pytest.mark.parametrize("radius_m", [0.1, 0.25, 0.5])


def border(field: Field) -> Iterator[Point]:
    """Yields places on the touch lines and the goal lines, with the corners."""
    for share in (step / 4 for step in range(-4, 5)):
        for side in SIDES:
            yield Point(share * field.half_length_m, side * field.half_width_m)
            yield Point(side * field.half_length_m, share * field.half_width_m)


def games(field: Field) -> Iterator[Game]:
    for state, spot, number in itertools.product(STATES, border(field), (0, 1)):
        for whose in (Whose.NEITHER,) if state is State.DROP_BALL else (Whose.OURS, Whose.THEIRS):
            yield Game(state, True, whose, spot, number=number)
    for whose, number in itertools.product(Whose, (0, 1)):
        yield Game(State.KICK_OFF, True, whose, number=number)
    for whose, side in ((Whose.OURS, 1.0), (Whose.THEIRS, -1.0)):
        yield Game(State.PENALTY, True, whose, field.penalty_mark(side))


def bodies(radius_m: float) -> Bodies:
    return Bodies.of(RobotModel(radius_m=radius_m), BALL)


def assert_fit(places: list[Point], field: Field, radius_m: float) -> None:
    """Asserts that robots stand at the places in the field, beside each other, off walls and areas."""
    for place in places:
        assert field.in_field(*place)
        assert field.in_field(*place, field.border_m - radius_m - MARGIN_M / 2)
        assert not any(field.in_penalty_area(*place, side) for side in SIDES)
    nearest_m = min((math.dist(*pair) for pair in itertools.combinations(places, 2)), default=math.inf)
    assert nearest_m >= 2 * radius_m + MARGIN_M - 1e-9


@every_size
@every_field
def test_places_of_set_pieces_fit_and_keep_the_distance(field: Field, radius_m: float) -> None:
    for game in games(field):
        seen = view(robot("cyan2", *game.spot), ball(*game.spot))._replace(bodies=bodies(radius_m))
        found = posts(FIELD_PLAYERS - 1, seen, field, game, sooner=False)
        if game.whose is not Whose.OURS:
            found.append(formation.first_opponent_place(game, field, seen.bodies))
        assert_fit(found, field, radius_m)
        least_m = 1.0 if game.state is State.DROP_BALL else 2.0 if game.whose is Whose.OURS else 3.0
        assert min(math.dist(place, game.spot) for place in found) >= least_m
        assert game.state is not State.KICK_OFF or max(place.x_m for place in found) < 0.0


@every_field
def test_receivers_at_the_border_wait_in_the_field(field: Field) -> None:
    for game in games(field):
        for variant in set_pieces.BOOK.get(game.state, ()):
            assert_fit([set_pieces.receiver_place(variant, game, field)], field, 0.25)


@pytest.mark.parametrize("y_m", [7.0, -7.0])
def test_ball_in_the_corner_is_laid_off_into_the_field(y_m: float) -> None:
    field = FIELDS["usual"]
    for x_m in (11.0, -11.0):
        game = Game(State.FREE_KICK, True, Whose.OURS, Point(x_m, y_m))
        place = set_pieces.lay_off(game, field)
        assert field.in_field(*place, -0.3)
        assert math.dist(place, game.spot) == pytest.approx(2.4)


@every_size
@every_field
def test_robots_in_play_do_not_touch_at_their_places(field: Field, radius_m: float) -> None:
    for spot, sooner in itertools.product(border(field), (True, False)):
        seen = view(robot("cyan2", *spot), ball(*spot))._replace(bodies=bodies(radius_m))
        found = posts(FIELD_PLAYERS - 1, seen, field, PLAY, sooner)
        assert all(field.in_field(*place) for place in found)
        assert min(math.dist(*pair) for pair in itertools.combinations(found, 2)) >= 2 * radius_m + MARGIN_M - 1e-9


def test_sixth_of_a_silent_team_has_a_place_of_its_own() -> None:
    seen = view(robot("cyan6", 0.0, 5.0), ball(9.0, 0.0))._replace(silent_mates=(robot("", 8.5, 0.0),))
    found = [job_among_silent(seen, rank, FIELDS["usual"]) for rank in range(6)]
    assert len({job.place for job in found}) == len(found)
