"""Book of set pieces: variants keep the rules, take turns, and avoid rivals; taker and receiver agree on a place."""

import math

import numpy as np
import pytest

from procs.behaviour import set_pieces
from procs.behaviour.bodies import USUAL
from procs.behaviour.game import Game, Whose
from procs.behaviour.posts import posts
from procs.behaviour.roles import ATTACKER, GOALKEEPER, SUPPORTER, Job
from procs.behaviour.set_pieces import (
    BOOK,
    ahead_on_the_wing,
    back_left,
    back_right,
    cut_back,
    long_to_the_wing,
    short,
    square,
    wide_left,
    wide_right,
)
from procs.behaviour.tactics import Tactics
from procs.behaviour.view import Agreement, View
from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.geometry import between
from procs.model.teams import Team
from procs.referee.positions import misplaced
from procs.referee.restarts import Restart
from tests.procs.behaviour.behaviour_parts import FIELD, ball, job, robot, view

SPOTS = {
    State.KICK_OFF: [Point(0.0, 0.0)],
    State.FREE_KICK: [Point(7.4, -1.0), Point(-6.0, 5.0), Point(0.0, 0.3)],
    State.THROW_IN: [Point(2.0, 6.9), Point(-9.0, -6.9), Point(10.0, 6.9)],
    State.GOAL_KICK: [Point(-7.4, 3.5), Point(-7.4, -3.5)],
    State.CORNER_KICK: [Point(10.8, 6.8), Point(10.8, -6.8)],
}
GAMES = [
    Game(state, stopped=True, whose=Whose.OURS, spot=spot, number=number)
    for state, spots in SPOTS.items()
    for spot in spots
    for number in (3, 4)
]


def name_of(game: Game) -> str:
    return f"{game.state.name.lower()} {game.spot.x_m:g} {game.spot.y_m:g} {game.number}"


def test_every_set_piece_but_the_penalty_has_two_variants() -> None:
    assert set(BOOK) == {*State} - {State.FROZEN, State.PLAY, State.DROP_BALL, State.PENALTY, State.HALF_TIME}
    assert all(len({variant.name for variant in variants}) >= 2 for variants in BOOK.values())


@pytest.mark.parametrize("game", GAMES, ids=name_of)
def test_receiver_waits_within_the_rules_and_the_reach_of_a_pass(game: Game) -> None:
    chosen = set_pieces.choose(game, (), FIELD, USUAL)
    assert chosen is not None
    name, place = chosen
    assert name == BOOK[game.state][game.number % len(BOOK[game.state])].name
    assert FIELD.in_field(*place)
    assert not any(FIELD.in_penalty_area(*place, side) for side in (-1.0, 1.0))
    assert 2.0 <= math.dist(place, game.spot) <= 9.0
    restart = Restart(game.state, Team.CYAN, game.spot)
    assert misplaced(restart, {"cyan2": game.spot, "cyan3": place}) == []


@pytest.mark.parametrize(("along", "across"), [(0.5, 0.5), (1.5, 1.0), (1.0, 0.75), (2.0, 1.5)])
def test_places_of_the_book_grow_with_the_field(along: float, across: float) -> None:
    """Receivers on a short field waited as far from the ball as on the usual field."""
    field = Field(length_m=along * FIELD.length_m, width_m=across * FIELD.width_m)
    for state, spot in ((State.KICK_OFF, Point(0.0, 0.0)), (State.FREE_KICK, Point(1.0, 4.0))):
        usual = Game(state, stopped=True, whose=Whose.OURS, spot=spot)
        game = usual._replace(spot=Point(along * spot.x_m, across * spot.y_m))
        for place in (back_left, back_right, wide_left, wide_right, square, ahead_on_the_wing, long_to_the_wing, short):
            x_m, y_m = place(usual, FIELD)
            assert place(game, field) == pytest.approx((along * x_m, across * y_m)), place.__name__
    corner = Game(State.CORNER_KICK, stopped=True, whose=Whose.OURS, spot=Point(field.half_length_m - 0.2, -3.0))
    x_m, y_m = cut_back(corner, field)
    assert field.half_length_m - x_m == pytest.approx(field.penalty_area_depth_m + 1.35)
    assert y_m == pytest.approx(across * cut_back(corner, FIELD).y_m)


def test_places_of_the_book_on_the_usual_field() -> None:
    game = Game(State.CORNER_KICK, stopped=True, whose=Whose.OURS, spot=Point(2.0, 4.0))
    places = (
        back_left,
        back_right,
        wide_left,
        wide_right,
        square,
        ahead_on_the_wing,
        long_to_the_wing,
        short,
        cut_back,
    )
    assert [place(game, FIELD) for place in places] == [
        (-2.2, 1.0),
        (-2.2, -1.0),
        (-0.7, 4.5),
        (-0.7, -4.5),
        (2.0, 4.0 - 3.2),
        (5.5, 4.0),
        (7.5, -3.0),
        (-1.0, 4.0),
        (11.0 - 3.6, 2.2),
    ]


@pytest.mark.parametrize("spot", [Point(-10.25, 6.9), Point(-10.25, -6.9), Point(-10.0, 6.9)])
def test_receiver_at_the_own_corner_is_inside_the_field(spot: Point) -> None:
    """Behind its goal line it took the ball along, out of the field, and the rivals had a corner kick."""
    game = Game(State.THROW_IN, stopped=True, whose=Whose.OURS, spot=spot)
    places = [set_pieces.receiver_place(variant, game, FIELD) for variant in BOOK[game.state]]
    assert all(FIELD.in_field(*place, -0.3) for place in places)


@pytest.mark.parametrize("game", GAMES, ids=name_of)
def test_variant_whose_way_is_blocked_is_passed_over(game: Game) -> None:
    places = [set_pieces.receiver_place(variant, game, FIELD) for variant in BOOK[game.state]]
    turn = game.number % len(places)
    blocker = robot("", *between(game.spot, places[turn], 0.6))
    chosen = set_pieces.choose(game, (blocker,), FIELD, USUAL)
    assert chosen is not None
    assert chosen[0] == BOOK[game.state][(turn + 1) % len(places)].name


@pytest.mark.parametrize("state", BOOK)
def test_receiver_goes_where_the_taker_says(state: State) -> None:
    game = Game(state, stopped=True, whose=Whose.OURS, spot=SPOTS[state][0], number=4)
    taker_tactics, receiver_tactics = Tactics(FIELD), Tactics(FIELD)
    supporter = robot("cyan3", game.spot.x_m - 3.0, game.spot.y_m * 0.5, role=SUPPORTER)
    places = [set_pieces.receiver_place(variant, game, FIELD) for variant in BOOK[state]]
    rival = robot("", *between(game.spot, places[0], 0.6))
    taker = robot("cyan2", *game.spot, role=ATTACKER)
    taker_tactics.decide(view(taker, ball(*game.spot), (supporter,), (rival,)), game, job(ATTACKER), False, 0.05)
    said = taker_tactics.passing.said
    assert (said.receiver, said.place) == ("cyan3", places[1])
    asks = taker._replace(agreement=Agreement("cyan3", said.place))
    for mate, place in ((taker, places[0]), (asks, places[1])):
        seen = view(supporter, ball(*game.spot), (mate,), (rival,))
        post = posts(1, seen, FIELD, game, sooner=True, supporter=supporter)[0]
        order = receiver_tactics.decide(seen, game, Job(SUPPORTER, post), False, 0.05)
        assert math.dist(order.place, place) < 0.01 or math.dist(order.place, supporter.place) <= 1.6, "on its way"
    assert receiver_tactics.passing.said.passer == "cyan2"


@pytest.mark.parametrize("supporter", [Point(-0.5, 1.8), Point(-9.0, -4.0)])
def test_taker_tells_a_receiver_out_of_a_passes_reach(supporter: Point) -> None:
    """A receiver that did not hear its place while it drove past the ball turned to another, and back."""
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=Point(0.0, 0.0), number=4)
    seen = view(robot("cyan2", -0.7, 0.0), ball(0.0, 0.0), (robot("cyan3", *supporter, role=SUPPORTER),))
    tactics = Tactics(FIELD)
    tactics.decide(seen, game, job(ATTACKER), False, 0.05)
    said, chosen = tactics.passing.said, set_pieces.choose(game, (), FIELD, USUAL)
    assert chosen is not None
    assert (said.receiver, said.place) == ("cyan3", chosen[1])


@pytest.mark.parametrize("stops_at_m", [0.3, 0.7])
def test_rival_keeps_off_the_spot_while_the_ball_is_pushed(stops_at_m: float) -> None:
    """The ball rolls off its spot in the stoppage, and lies there again when the set piece may be taken."""
    game = Game(State.THROW_IN, stopped=True, whose=Whose.THEIRS, spot=Point(3.5, 6.9), number=4)
    tactics, own = Tactics(FIELD), robot("cyan2", 5.5, 4.6)
    decided = [tactics.decide(view(own, ball(3.5, 6.9)), game, job(ATTACKER), False, 0.05).place]
    for step in range(15):
        away_m, speed_m_s = min(0.05 * step, stops_at_m), 1.0 if 0.05 * step < stops_at_m else 0.0
        seen = view(own, ball(3.5 - away_m, 6.9, -speed_m_s))
        decided.append(tactics.decide(seen, game, job(ATTACKER), False, 0.05).place)
    back = tactics.decide(view(own, ball(3.5, 6.9)), game._replace(stopped=False), job(ATTACKER), False, 0.05)
    assert back.place == decided[0]
    assert all(math.dist(place, decided[0]) < 0.01 for place in decided[: round(stops_at_m / 0.05)])


def test_taker_draws_the_variant_of_each_set_piece() -> None:
    tactics, said = Tactics(FIELD, np.random.default_rng(1)), []
    seen = view(robot("cyan2", 0.7, 0.0, math.pi), ball(0.0, 0.0), (robot("cyan3", -2.0, 1.5, role=SUPPORTER),))
    for number in range(20):
        game = Game(State.KICK_OFF, stopped=True, whose=Whose.OURS, number=number)
        for _ in range(3):
            tactics.decide(seen, game, job(ATTACKER), False, 0.05)
            said.append(tactics.passing.said.place)
    assert said[::3] == said[1::3] == said[2::3]
    places = {set_pieces.receiver_place(variant, game, FIELD) for variant in BOOK[State.KICK_OFF]}
    assert set(said) == places


@pytest.mark.parametrize(("stopped", "skill"), [(True, "goto"), (False, "get_ball")])
def test_pass_of_a_set_piece_is_fetched_after_its_start(stopped: bool, skill: str) -> None:
    """A mate that was to take it until now still announces the pass until its next message."""
    game = Game(State.FREE_KICK, stopped=stopped, whose=Whose.OURS, spot=Point(-3.0, 1.0))
    mate = robot("cyan3", -3.7, 1.0, role=ATTACKER)._replace(agreement=Agreement("cyan2"))
    seen = view(robot("cyan2", -4.5, 1.0), ball(-3.0, 1.0), (mate,))
    assert Tactics(FIELD).decide(seen, game, job(ATTACKER), False, 0.05).skill == skill


def test_plan_of_a_set_piece_is_kept_once_it_may_be_taken() -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=Point(0.0, 0.0), number=4)
    tactics, supporter = Tactics(FIELD), robot("cyan3", -2.0, 1.5, role=SUPPORTER)
    seen = view(robot("cyan2", 0.7, 0.0, math.pi), ball(0.0, 0.0), (supporter,))
    tactics.decide(seen, game, job(ATTACKER), False, 0.05)
    before = tactics.passing.said.place
    rival = robot("", *between(game.spot, before, 0.6))
    tactics.decide(seen._replace(opponents=(rival,)), game._replace(stopped=False), job(ATTACKER), False, 0.05)
    assert tactics.passing.said.place == before


@pytest.mark.parametrize(("share", "aside_m"), [(0.6, 0.0), (1.4, 0.0), (1.0, 0.8)])
def test_rival_in_the_way_or_at_the_place_changes_the_plan(share: float, aside_m: float) -> None:
    """The rival comes when the plan stands: before the receiver's place, behind it, or beside it."""
    game = Game(State.KICK_OFF, stopped=True, whose=Whose.OURS, number=4)
    tactics, supporter = Tactics(FIELD), robot("cyan3", -2.0, 1.5, role=SUPPORTER)
    free = view(robot("cyan2", 0.7, 0.0, math.pi), ball(0.0, 0.0), (supporter,))
    tactics.decide(free, game, job(ATTACKER), False, 0.05)
    before = tactics.passing.said.place
    x_m, y_m = between(game.spot, before, share)
    for _ in range(10):
        tactics.decide(free._replace(opponents=(robot("", x_m, y_m + aside_m),)), game, job(ATTACKER), False, 0.05)
    assert math.dist(tactics.passing.said.place, before) > 1.0


def test_rival_that_drives_past_does_not_change_the_plan() -> None:
    game = Game(State.KICK_OFF, stopped=True, whose=Whose.OURS, number=4)
    tactics, supporter = Tactics(FIELD), robot("cyan3", -2.0, 1.5, role=SUPPORTER)
    free = view(robot("cyan2", 0.7, 0.0, math.pi), ball(0.0, 0.0), (supporter,))

    def planned(seen: View, ticks: int) -> Point:
        for _ in range(ticks):
            tactics.decide(seen, game, job(ATTACKER), False, 0.05)
        return tactics.passing.said.place

    before = planned(free, 1)
    blocked = free._replace(opponents=(robot("", *between(game.spot, before, 0.6)),))
    assert planned(blocked, 5) == planned(free, 1) == planned(blocked, 5) == before
    assert planned(blocked, 10) != before


def two_robots(x_m: float, heading_rad: float = 0.0) -> View:
    """Returns the view of a field player at its ball at (x_m + 0.33, 4.0), whose only mate is the goalkeeper."""
    keeper = robot("cyan1", -10.5, 0.0, role=GOALKEEPER)
    return view(robot("cyan2", x_m, 4.0, heading_rad), ball(x_m + 0.33, 4.0), (keeper,), (robot("", 10.5, 0.0),))


@pytest.mark.parametrize(("x_m", "skill"), [(0.0, "push"), (-3.0, "push"), (-7.0, "clear")])
def test_taker_with_only_its_keeper_does_not_kick_the_ball_out(x_m: float, skill: str) -> None:
    tactics, game = Tactics(FIELD), Game(State.FREE_KICK, stopped=False, whose=Whose.OURS, spot=Point(x_m + 0.33, 4.0))
    orders = [tactics.decide(two_robots(x_m), game, job(ATTACKER), True, 0.05) for _ in range(10)]
    assert orders[-1].skill == skill
    assert skill == "clear" or FIELD.in_field(*orders[-1].place, -0.5)


def test_only_field_player_awaits_a_touch_after_its_set_piece() -> None:
    tactics, game = Tactics(FIELD), Game(State.FREE_KICK, stopped=False, whose=Whose.OURS, spot=Point(0.33, 4.0))
    for holds in [*[True] * 10, False]:
        tactics.decide(two_robots(0.0), game, job(ATTACKER), holds, 0.05)
    play, free = Game(State.PLAY, stopped=False), two_robots(0.0)._replace(ball=ball(2.0, 4.0))
    order = tactics.decide(free, play, job(ATTACKER), False, 0.05)
    assert tactics.barred
    assert (order.skill, order.intention) == ("goto", "await touch")
    assert math.dist(order.place, free.ball.place) > 1.0
    touched = free._replace(opponents=(robot("", 2.3, 4.0),))
    assert tactics.decide(touched, play, job(ATTACKER), False, 0.05).skill == "get_ball"
