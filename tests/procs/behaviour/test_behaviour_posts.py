"""Posts of a team: at set pieces they stay where they are while robots and ball are on their ways."""

import itertools
import math

import pytest

from procs.behaviour import formation, set_pieces
from procs.behaviour.game import Game, Whose
from procs.behaviour.posts import posts
from procs.behaviour.roles import ATTACKER, DEFENDER, SUPPORTER, Job, assign
from procs.behaviour.view import Agreement, Robot
from procs.model.field import Point
from procs.model.game_states import State
from tests.procs.behaviour.behaviour_parts import FIELD, ball, robot, view

KEEPER = robot("magenta1", -10.5, 0.0)
TAKER = robot("magenta2", -0.3, 0.5, role=ATTACKER)
NUMBERS = (4, 5)


def kick_off(whose: Whose, number: int = 4) -> Game:
    return Game(State.KICK_OFF, stopped=True, whose=whose, number=number)


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("whose", Whose)
def test_posts_of_a_set_piece_do_not_follow_robots_and_ball(whose: Whose, number: int) -> None:
    found = set()
    for y_m, ball_x_m, sooner in itertools.product((-4.0, -0.1, 0.1, 4.0), (0.0, 10.0), (True, False)):
        supporter = robot("magenta3", -2.0, y_m, role=SUPPORTER)
        seen = view(TAKER, ball(ball_x_m, y_m), (KEEPER, supporter))
        found.add(tuple(posts(3, seen, FIELD, kick_off(whose, number), sooner, supporter)))
    assert len(found) == 1


@pytest.mark.parametrize("number", NUMBERS)
def test_posts_of_a_kick_off_are_apart_on_both_sides(number: int) -> None:
    for whose in Whose:
        receiver, stopper, sweeper, _ = posts(4, view(TAKER, ball(0.0, 0.0)), FIELD, kick_off(whose, number), True)
        assert min(math.dist(*pair) for pair in itertools.combinations((receiver, stopper, sweeper), 2)) > 1.0
    receiver, _, sweeper, _ = posts(4, view(TAKER, ball(0.0, 0.0)), FIELD, kick_off(Whose.OURS, number), True)
    assert receiver.y_m * sweeper.y_m < 0.0


@pytest.mark.parametrize(
    ("state", "whose", "spot"),
    [
        (State.FREE_KICK, Whose.OURS, Point(-7.4, -2.0)),
        (State.FREE_KICK, Whose.OURS, Point(-7.4, 0.0)),
        (State.FREE_KICK, Whose.THEIRS, Point(-7.4, 2.0)),
        (State.PENALTY, Whose.THEIRS, Point(-7.4, 0.0)),
        (State.DROP_BALL, Whose.NEITHER, Point(-7.4, 0.0)),
    ],
)
@pytest.mark.parametrize("number", NUMBERS)
def test_posts_before_the_own_area_are_apart(state: State, whose: Whose, spot: Point, number: int) -> None:
    """Mates once pushed each other for one place: the rules moved the places of both to the same."""
    game = Game(state, stopped=True, whose=whose, spot=spot, number=number)
    found = posts(3, view(TAKER, ball(*spot)), FIELD, game, sooner=False)[:3]
    nearest = [] if whose is Whose.OURS else [formation.first_opponent_place(game, FIELD)]
    assert min(math.dist(*pair) for pair in itertools.combinations(found + nearest, 2)) >= 1.0


def test_place_that_the_taker_tells_moves_the_other_posts() -> None:
    """A mate that hears of the place goes to the other side, and not to the receiver."""
    game, supporter = kick_off(Whose.OURS), robot("magenta3", -2.0, 2.0, role=SUPPORTER)
    places = [set_pieces.receiver_place(variant, game, FIELD) for variant in set_pieces.BOOK[State.KICK_OFF]]
    for place in places:
        taker = TAKER._replace(agreement=Agreement("magenta3", place))
        other = robot("magenta4", -3.0, -2.0, role=DEFENDER)
        found = posts(3, view(other, ball(0.0, 0.0), (taker, supporter)), FIELD, game, True, supporter)
        assert found[0] == place
        assert found[2].y_m * place.y_m < 0.0


def driven(team: dict[str, Robot], jobs: dict[str, Job], game: Game) -> dict[str, Robot]:
    """Returns the team a step of 0.1 m later, each field player on its way around the ball."""
    moved = {}
    for name, one in team.items():
        job, place = jobs[name], one.place
        if job.role in (SUPPORTER, DEFENDER):
            step = formation.next_step(place, job.place, game, FIELD)
            share = min(1.0, 0.1 / max(0.1, math.dist(place, step)))
            place = Point(place.x_m + share * (step.x_m - place.x_m), place.y_m + share * (step.y_m - place.y_m))
        moved[name] = one._replace(place=place, role=job.role)
    return moved


@pytest.mark.parametrize("number", NUMBERS)
@pytest.mark.parametrize("whose", [Whose.OURS, Whose.THEIRS])
@pytest.mark.parametrize(
    "places",
    [
        ((-2.1, 0.91), (-2.25, -1.32), (-5.5, 0.0)),
        ((-0.4, -2.8), (-2.3, 0.2), (-5.5, 0.0)),
        ((3.0, 0.1), (3.0, -0.1), (6.0, 0.0)),
        ((3.5, 2.0), (-3.5, 0.0), (0.0, -3.5)),
    ],
)
def test_robots_reach_their_posts_of_a_kick_off_and_stay(
    places: tuple[tuple[float, float], ...], whose: Whose, number: int
) -> None:
    """A supporter on its way around the ball once moved the posts from side to side, and mates ran after them."""
    game = kick_off(whose, number)
    names = ("magenta3", "magenta4", "magenta5")
    team = {"magenta2": TAKER, "magenta1": KEEPER}
    for name, place, role in zip(names, places, (SUPPORTER, DEFENDER, DEFENDER), strict=True):
        team[name] = robot(name, *place, role=role)
    given = set()
    for _ in range(150):
        mates = tuple(one for name, one in team.items() if name != "magenta2")
        jobs = assign(view(team["magenta2"], ball(0.0, 0.0), mates), FIELD, game=game)
        given.add(tuple(jobs[name] for name in names))
        team = driven(team, jobs, game)
    assert len(given) <= 2, "mates may exchange their posts once, as they come closer"
    assert [team[name].place for name in names] == [pytest.approx(jobs[name].place) for name in names]
    assert all(team[name].place.x_m <= -0.25 for name in names)
