"""The simple opponent: the actions of each robot, and the choice of strategy in a launch file."""

import math

import pytest

from fwk.testing import settings_in
from procs.behaviour.game import Game, Whose
from procs.behaviour.greedy import decide
from procs.behaviour.view import Ball, Robot
from procs.model.field import Field, Point
from procs.model.game_states import State
from procs.model.robot import ABSENT
from tests.procs.behaviour.behaviour_parts import ball, robot, view

FIELD = Field()
PLAY = Game(State.PLAY, stopped=False)
KEEPER = robot("cyan1", -10.5, 0.0)
OTHERS = (KEEPER, robot("cyan3", -4.0, 2.0))
FIVE = (KEEPER, *(robot(f"cyan{number}", 1.9 - 0.1 * number, -3.0) for number in range(2, 6)))


def five_without(name: str) -> tuple[Robot, ...]:
    return tuple(mate for mate in FIVE if mate.name != name)


def test_nearest_robot_chases_and_others_stay_behind_the_ball() -> None:
    near = view(robot("cyan2", 0.0, 0.0), ball(2.0, 0.0), OTHERS)
    role, order = decide(near, PLAY, False, FIELD)
    assert (role, order.skill, order.place) == ("attacker", "get_ball", (2.0, 0.0))
    far = view(robot("cyan2", -6.0, 0.0), ball(2.0, 0.0), OTHERS)
    role, order = decide(far, PLAY, False, FIELD)
    assert (role, order.skill) == ("defender", "goto")
    assert order.place.x_m < 2.0


@pytest.mark.parametrize(("x_m", "skill"), [(6.0, "shoot"), (-3.0, "dribble")])
def test_robot_with_the_ball_shoots_or_drives_to_the_goal(x_m: float, skill: str) -> None:
    seen = view(robot("cyan2", x_m, 0.0), ball(x_m + 0.3, 0.0), OTHERS)
    assert decide(seen, PLAY, True, FIELD)[1].skill == skill


def small(point: Point) -> Point:
    return Point(point.x_m / 2, point.y_m / 2)


@pytest.mark.parametrize(("name", "x_m"), [("cyan2", -6.0), ("cyan4", -3.0), ("cyan5", 4.0)])
def test_distances_shrink_with_the_field(name: str, x_m: float) -> None:
    field, mates = Field(length_m=11.0, width_m=7.0, penalty_area_depth_m=1.0), five_without(name)
    usual = view(robot(name, x_m, 1.0), ball(2.0, 0.4), mates)
    nearer = tuple(mate._replace(place=small(mate.place)) for mate in mates)
    half = view(robot(name, x_m / 2, 0.5), ball(1.0, 0.2), nearer)
    assert decide(half, PLAY, False, field)[1].place == pytest.approx(small(decide(usual, PLAY, False, FIELD)[1].place))
    with_ball = decide(usual, PLAY, True, FIELD)[1], decide(half, PLAY, True, field)[1]
    assert with_ball[1].skill == with_ball[0].skill
    assert with_ball[1].place == pytest.approx(small(with_ball[0].place))


def test_robots_line_up_in_half_the_room_of_half_the_field() -> None:
    field, game = (
        Field(length_m=11.0, width_m=7.0),
        Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=Point(5, 0)),
    )
    place = decide(view(robot("cyan5", 1.2, 0.0), ball(5.0, 0.0), five_without("cyan5")), game, False, field)[1].place
    assert place.x_m == pytest.approx(5.0 - 5 * 0.75)


def test_first_robot_keeps_the_goal() -> None:
    role, order = decide(view(robot("cyan1", -10.0, 0.0), ball(0.0, 0.0), OTHERS), PLAY, False, FIELD)
    assert (role, order.skill) == ("goalkeeper", "keep_line")


@pytest.mark.parametrize("name", ["cyan1", "cyan4"])
def test_robot_that_is_alone_plays_whatever_its_number(name: str) -> None:
    alone = view(robot(name, -1.0, 0.0), ball(0.0, 0.0))
    assert decide(alone, PLAY, False, FIELD)[1].skill == "get_ball"
    assert decide(alone, PLAY, True, FIELD)[1].skill == "push", "a dribble of three metres would not do"
    game = Game(State.GOAL_KICK, stopped=False, whose=Whose.OURS, spot=Point(-7.4, 3.5))
    assert decide(alone, game, False, FIELD)[1].skill == "get_ball"
    assert decide(alone, game, True, FIELD)[1].skill == "push", "no shot from the own half counts"
    near = alone._replace(own=robot(name, 5.0, 0.0))
    assert decide(near, PLAY, True, FIELD)[1].skill == "shoot"


def test_robot_that_is_alone_keeps_the_goal_at_their_penalty() -> None:
    game, alone = (
        Game(State.PENALTY, True, Whose.THEIRS, Point(-7.4, 0.0)),
        view(robot("cyan4", -1.0, 0.0), ball(-7.4, 0.0)),
    )
    assert decide(alone, game, False, FIELD)[1].skill == "keep_line"
    assert decide(alone, game._replace(whose=Whose.OURS), False, FIELD)[1].intention == "take set piece"


def test_robot_whose_mates_are_silent_is_not_alone() -> None:
    seen = view(robot("cyan1", -10.0, 0.0), ball(0.0, 0.0))._replace(silent_mates=OTHERS)
    assert decide(seen, PLAY, False, FIELD)[0] == "goalkeeper"


@pytest.mark.parametrize("name", ["cyan2", "cyan3", "cyan5"])
def test_distance_is_kept_at_the_other_teams_set_piece(name: str) -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=Point(1.0, 1.0))
    role, order = decide(view(robot(name, -5.0, 0.0), ball(1.0, 1.0)), game, False, FIELD)
    assert (role, order.skill) == ("defender", "goto")
    assert math.dist(order.place, game.spot) > 3.0


def test_second_robot_takes_the_own_set_piece() -> None:
    game = Game(State.FREE_KICK, stopped=False, whose=Whose.OURS, spot=Point(1.0, 1.0))
    orders = {}
    for name in ("cyan2", "cyan3"):
        seen = view(robot(name, 0.0, 1.0), ball(1.0, 1.0), five_without(name))
        orders[name] = decide(seen, game, False, FIELD)[1].skill
    assert orders == {"cyan2": "get_ball", "cyan3": "goto"}


TRIO = (robot("cyan3", -9.0, 0.0), robot("cyan7", -3.0, 1.0), robot("cyan9", 0.5, -2.0))


def decided(name: str, team: tuple[Robot, ...], game: Game) -> tuple[str, str]:
    own = next(one for one in team if one.name == name)
    role, order = decide(view(own, ball(1.0, 1.0), tuple(one for one in team if one is not own)), game, False, FIELD)
    return role, order.skill


def test_lowest_numbers_of_a_team_keep_goal_and_take_set_pieces() -> None:
    game = Game(State.FREE_KICK, stopped=False, whose=Whose.OURS, spot=Point(1.0, 1.0))
    found = [decided(one.name, TRIO, game) for one in TRIO]
    assert found == [("goalkeeper", "keep_line"), ("passer", "get_ball"), ("defender", "goto")]


def test_robots_that_do_not_play_neither_keep_goal_nor_chase() -> None:
    dead = (TRIO[0]._replace(role=ABSENT), robot("cyan4", 1.2, 1.0, role=ABSENT), *TRIO[1:])
    assert decided("cyan7", dead, PLAY) == ("goalkeeper", "keep_line")
    assert decided("cyan9", dead, PLAY) == ("attacker", "get_ball")
    last = view(TRIO[1], ball(1.0, 1.0), (TRIO[0]._replace(role=ABSENT),))
    assert decide(last, PLAY, False, FIELD)[1].skill == "get_ball", "the only one that plays is alone"


@pytest.mark.parametrize("name", ["cyan9", "cyan12"])
def test_places_of_high_numbers_are_on_the_field(name: str) -> None:
    silent = view(robot(name, -4.0, 0.0), ball(2.0, 6.5), (robot("cyan1", -10.0, 0.0), robot("cyan2", 2.0, 6.0)))
    for seen in (silent, silent._replace(mates=(), silent_mates=silent.mates, ball=Ball(known=False))):
        assert FIELD.in_field(*decide(seen, PLAY, False, FIELD)[1].place, -0.3)


def test_taker_shoots_and_leaves_the_ball_until_it_is_touched() -> None:
    game = Game(State.FREE_KICK, stopped=False, whose=Whose.OURS, spot=Point(-3.0, 1.0))
    seen = view(robot("cyan2", -3.3, 1.0), ball(-3.0, 1.0), OTHERS)
    role, order = decide(seen, game, True, FIELD)
    assert (role, order.skill) == ("passer", "shoot")
    taker = seen._replace(own=seen.own._replace(role=role))
    assert decide(taker, PLAY, True, FIELD)[1].skill == "shoot", "a dribble would touch the ball twice"
    role, order = decide(taker, PLAY, False, FIELD)
    assert (role, order.skill) == ("passer", "goto")
    touched = taker._replace(opponents=(robot("magenta4", -2.7, 1.0),))
    assert decide(touched, PLAY, False, FIELD)[1].skill == "get_ball"


def test_only_the_goalkeeper_waits_in_the_own_penalty_area() -> None:
    seen = view(robot("cyan4", 0.0, 0.0), ball(-9.0, 0.0), OTHERS)
    place = decide(seen, PLAY, False, FIELD)[1].place
    assert not FIELD.in_penalty_area(*place, -1.0)


def test_launch_file_chooses_the_strategy_of_a_team() -> None:
    assert settings_in("soccer-greedy.yaml", "magenta2/agent")["strategy"] == "greedy"
    assert settings_in("soccer-greedy.yaml", "cyan2/agent")["strategy"] == "team"
    assert not settings_in("soccer-greedy.yaml", "magenta2/world_model")["use_team_sight"]
