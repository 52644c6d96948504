"""Decisions of robots: situations and the orders that follow."""

import math

import pytest

from procs.behaviour.game import Game, Whose
from procs.behaviour.order import Order
from procs.behaviour.posts import posts
from procs.behaviour.roles import ATTACKER, DEFENDER, GOALKEEPER, SUPPORTER
from procs.behaviour.tactics import Tactics
from procs.behaviour.view import Ball, Robot, View
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.geometry import bearing_rad, wrap_rad
from tests.procs.behaviour.behaviour_parts import FIELD, agreed, ball, job, robot, view

PLAY = Game(State.PLAY, stopped=False)
KEEPER = robot("", 10.5, 0.0)


def decide(seen: View, game: Game = PLAY, role: str = ATTACKER, holds_ball: bool = False, ticks: int = 1) -> Order:
    tactics = Tactics(FIELD)
    for _ in range(ticks):
        order = tactics.decide(seen, game, job(role, -3.0, 1.0), holds_ball, 0.05)
    return order


def with_ball(x_m: float, y_m: float, *opponents: Robot, mates: tuple[Robot, ...] = ()) -> View:
    return view(robot("cyan2", x_m - 0.33, y_m), ball(x_m, y_m), mates, (KEEPER, *opponents))


@pytest.mark.parametrize("state", [State.FROZEN, State.HALF_TIME])
@pytest.mark.parametrize("role", [GOALKEEPER, ATTACKER, DEFENDER])
def test_robots_stand_still_in_a_pause(state: State, role: str) -> None:
    seen = view(robot("cyan2", 0.0, 0.0), ball(1.0, 0.0))
    assert decide(seen, Game(state, stopped=True), role).skill == "stop"


@pytest.mark.parametrize(("game", "skill"), [(PLAY, "search"), (Game(State.FROZEN, stopped=True), "stop")])
def test_robot_without_a_pose_searches_it_unless_paused(game: Game, skill: str) -> None:
    seen = view(robot("cyan2", 0.0, 0.0), ball(1.0, 0.0))._replace(localized=False)
    assert decide(seen, game).skill == skill


def test_attacker_gets_a_free_ball() -> None:
    order = decide(view(robot("cyan2", -2.0, 0.0), ball(1.0, 0.0)))
    assert (order.skill, order.place) == ("get_ball", (1.0, 0.0))


def test_attacker_intercepts_a_ball_that_approaches() -> None:
    assert decide(view(robot("cyan2", -2.0, 0.0), ball(3.0, 0.0, -3.0, 0.0))).skill == "intercept"
    assert decide(view(robot("cyan2", -2.0, 0.0), ball(3.0, 0.0, 3.0, 0.0))).skill == "get_ball"


def test_open_goal_is_shot_beside_the_keeper() -> None:
    order = decide(with_ball(7.0, 0.0), holds_ball=True)
    assert order.skill == "shoot"
    assert order.place.x_m == 11.0
    assert abs(order.place.y_m) > 0.4


def test_ball_just_caught_settles_before_it_is_played() -> None:
    tactics, seen = Tactics(FIELD), with_ball(3.0, 0.5)
    skills = [tactics.decide(seen, PLAY, job(ATTACKER), holds, 0.05).skill for holds in (False, *[True] * 4)]
    assert skills[:3] == ["get_ball"] * 3
    assert skills[-1] != "get_ball"


def test_robot_far_from_the_goal_dribbles_towards_the_goal() -> None:
    order = decide(with_ball(-3.0, 4.0), holds_ball=True)
    assert order.skill == "dribble"
    assert order.place.x_m > -1.0
    assert abs(order.place.y_m) < 4.0


def test_robot_in_its_own_half_does_not_shoot() -> None:
    assert decide(with_ball(-0.5, 0.0), holds_ball=True).skill == "dribble"


def test_robot_under_pressure_passes_to_a_free_mate_ahead() -> None:
    mate = agreed(robot("cyan3", 3.0, 3.0, role=SUPPORTER))
    pressed = with_ball(-2.0, 0.0, robot("", -1.2, -0.2), mates=(mate,))
    assert decide(pressed, holds_ball=True, ticks=2).skill == "pass"
    assert decide(with_ball(-2.0, 0.0, mates=(mate,)), holds_ball=True).skill == "dribble"


def test_robot_that_keeps_the_ball_too_long_clears_the_ball() -> None:
    assert decide(with_ball(-2.0, 0.0), holds_ball=True, ticks=140)[:1] == ("clear",)


def test_robot_pressed_for_long_kicks_the_ball_past_its_rival() -> None:
    contest = with_ball(-2.0, 0.0, robot("", -1.4, 0.0), robot("", -3.0, 2.0))
    assert decide(contest, holds_ball=True, ticks=90).intention == "clear"


def test_shot_once_begun_keeps_its_target() -> None:
    tactics, seen = Tactics(FIELD), with_ball(7.0, 0.0)
    first = tactics.decide(seen, PLAY, job(ATTACKER), True, 0.05)
    moved = seen._replace(opponents=(robot("", 10.5, 0.1 if first.place.y_m > 0 else -0.1),))
    assert tactics.decide(moved, PLAY, job(ATTACKER), True, 0.05).place == first.place


WALL = tuple(robot("", 8.3, y_m) for y_m in (-1.2, -0.6, 0.0, 0.6, 1.2))


def test_ball_is_lobbed_over_a_wall_before_the_goal() -> None:
    order = decide(with_ball(4.6, 0.0, *WALL), holds_ball=True, ticks=4)
    assert (order.skill, order.place.x_m) == ("lob", 11.0)
    assert abs(order.place.y_m) < 0.8
    assert decide(with_ball(1.5, 0.0, *WALL), holds_ball=True, ticks=4).skill == "lob"
    assert decide(with_ball(0.2, 0.0, *WALL), holds_ball=True, ticks=4).skill != "lob", "too far away"


def test_rival_just_before_the_ball_blocks_a_lob() -> None:
    tactics, free = Tactics(FIELD), with_ball(4.6, 0.0, *WALL)
    orders = [tactics.decide(free, PLAY, job(ATTACKER), True, 0.05) for _ in range(4)]
    assert orders[-1].skill == "lob"
    blocked = with_ball(4.6, 0.0, *WALL, robot("", 5.6, orders[-1].place.y_m / 6))
    order = tactics.decide(blocked, PLAY, job(ATTACKER), True, 0.05)
    assert (order.skill, order.place) != ("lob", orders[-1].place)


def test_penalty_is_lobbed_over_a_keeper_in_the_middle() -> None:
    spot, penalty = Point(7.4, 0.0), Game(State.PENALTY, stopped=False, whose=Whose.OURS, spot=Point(7.4, 0.0))
    keeper = robot("", 10.5, 0.0), robot("", 10.5, 0.6), robot("", 10.5, -0.6)
    seen = view(robot("cyan2", 7.07, 0.0), ball(*spot), (), keeper)
    assert decide(seen, penalty, holds_ball=True, ticks=6).skill == "lob"


@pytest.mark.parametrize("stopped", [True, False])
def test_taker_of_a_penalty_faces_the_goal(stopped: bool) -> None:
    """A taker that turns to a mate takes the ball from the goal's side, and shoots 3 s later."""
    spot, supporter = Point(7.4, 0.0), robot("cyan3", 4.0, 3.0, role=SUPPORTER)
    penalty, tactics = Game(State.PENALTY, stopped, Whose.OURS, spot), Tactics(FIELD)
    order = tactics.decide(
        view(robot("cyan2", 6.0, 0.0), ball(*spot), (supporter,)), penalty, job(ATTACKER), False, 0.05
    )
    assert (order.skill, order.heading_rad) == ("goto" if stopped else "get_ball", 0.0)
    assert order.place.x_m <= spot.x_m
    assert not tactics.passing.said.receiver


def test_while_stopped_the_taker_waits_behind_the_ball() -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=Point(2.0, 1.0))
    order = decide(view(robot("cyan2", -2.0, 0.0), ball(2.0, 1.0)), game)
    assert order.skill == "goto"
    assert order.place.x_m < 2.0
    assert math.dist(order.place, game.spot) < 1.0


def test_kick_off_taker_stays_in_its_half_before_a_back_pass() -> None:
    game = Game(State.KICK_OFF, stopped=True, whose=Whose.OURS)
    mates = (robot("cyan3", -3.0, 3.0, role=SUPPORTER),)
    order = decide(view(robot("cyan2", -2.0, 0.0), ball(0.0, 0.0), mates), game)
    assert order.place.x_m < -0.25


def test_set_piece_is_played_to_a_mate() -> None:
    game = Game(State.THROW_IN, stopped=False, whose=Whose.OURS, spot=Point(0.0, 6.9))
    mates = (agreed(robot("cyan3", 0.0, 3.0, role=SUPPORTER)),)
    seen = view(robot("cyan2", 0.0, 6.9, -math.pi / 2), ball(0.0, 6.6), mates)
    assert decide(seen, game).skill == "get_ball"
    order = decide(seen, game, holds_ball=True, ticks=2)
    assert (order.skill, order.place) == ("pass", (0.0, 3.0))


def test_taker_keeps_its_receiver_once_the_ball_may_be_played() -> None:
    spot, tactics = Point(0.0, 0.0), Tactics(FIELD)
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=spot)
    own, taken = robot("cyan2", -0.7, 0.0), job(ATTACKER)
    left, right = robot("cyan3", 3.0, 3.0, role=SUPPORTER), robot("cyan4", 2.0, -3.0, role=DEFENDER)
    tactics.decide(view(own, ball(*spot), (left, right)), game, taken, False, 0.05)
    moved = view(own, ball(*spot), (left, right._replace(place=Point(6.0, -1.0))))
    order = tactics.decide(moved, game._replace(stopped=False), taken, False, 0.05)
    assert order.heading_rad == pytest.approx(math.pi / 4)


def test_taker_keeps_to_one_receiver_when_the_first_is_blocked() -> None:
    spot, tactics = Point(0.0, 0.0), Tactics(FIELD)
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=spot)
    own, first = robot("cyan2", -0.3, 0.0), robot("cyan3", 4.0, 0.0, role=SUPPORTER)
    second, rival = agreed(robot("cyan4", 0.0, 4.0, role=DEFENDER)), robot("", 2.0, 0.0)
    free, blocked = (view(own, ball(*spot), (first, second), rivals) for rivals in ((), (rival,)))
    tactics.decide(free, game, job(ATTACKER), False, 0.05)
    game = game._replace(stopped=False)
    assert tactics.decide(free, game, job(ATTACKER), False, 0.05).heading_rad == 0.0
    orders = [tactics.decide(seen, game, job(ATTACKER), True, 0.05) for seen in [blocked] * 4 + [free, blocked] * 4]
    assert [order.receiver for order in orders[2:]] == ["cyan4"] * 10
    assert [order.skill for order in orders[4:]] == ["pass"] * 8, "the second has accepted"


@pytest.mark.parametrize(
    ("spot", "most_rad"), [(Point(7.4, -1.0), 0.5), (Point(2.0, 6.9), 0.8), (Point(-7.4, 3.5), 0.5)]
)
def test_receiver_of_a_set_piece_sees_ball_and_goal(spot: Point, most_rad: float) -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=spot)
    place = posts(1, view(robot("cyan3", 0.0, 0.0), ball(*spot)), FIELD, game, sooner=True)[0]
    turn_rad = wrap_rad(bearing_rad(place, spot) - bearing_rad(place, FIELD.goal_centre(1.0)))
    assert math.dist(place, spot) > 2.0
    assert FIELD.in_field(*place)
    assert abs(turn_rad) < most_rad


def test_set_piece_goes_to_the_receiver_behind_the_ball() -> None:
    game, tactics = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=Point(2.0, 0.0)), Tactics(FIELD)
    receiver, ahead = agreed(robot("cyan3", 0.0, -1.2, role=SUPPORTER)), robot("cyan4", 6.0, 2.0, role=DEFENDER)
    seen = view(robot("cyan2", 2.6, 0.3, math.pi), ball(2.0, 0.0), (receiver, ahead))
    waiting = tactics.decide(seen, game, job(ATTACKER), False, 0.05)
    assert waiting.place.x_m > 2.0, "the taker stands on the other side of the ball"
    for _ in range(4):
        order = tactics.decide(seen, game._replace(stopped=False), job(ATTACKER), True, 0.05)
    assert (order.skill, order.place) == ("pass", receiver.place)


def test_rival_that_comes_fast_presses_from_further_away() -> None:
    mates = (agreed(robot("cyan3", 0.0, 3.0, role=SUPPORTER)),)
    rival = robot("", 0.0, -0.5)
    standing = decide(with_ball(-2.0, 0.0, rival, mates=mates), holds_ball=True)
    coming = with_ball(-2.0, 0.0, rival._replace(velocity_m_s=Point(-2.5, 0.5)), mates=mates)
    assert (standing.skill, decide(coming, holds_ball=True, ticks=2).skill) == ("dribble", "pass")


@pytest.mark.parametrize("stopped", [True, False])
def test_robots_keep_away_at_the_other_teams_set_piece(stopped: bool) -> None:
    game = Game(State.FREE_KICK, stopped=stopped, whose=Whose.THEIRS, spot=Point(-3.0, 1.0))
    blocking = decide(view(robot("cyan2", -3.0, 0.0), ball(-3.0, 1.0)), game, ATTACKER)
    assert (blocking.skill, blocking.place) == ("block", game.spot)
    for role in (SUPPORTER, DEFENDER):
        order = decide(view(robot("cyan2", -3.0, 0.0), ball(-3.0, 1.0)), game, role)
        assert order.skill == "goto"
        assert math.dist(order.place, game.spot) >= 3.0


@pytest.mark.parametrize(
    ("laid", "distant"), [(Point(-3.5, 1.0), True), (Point(-3.1, 1.0), False), (Point(3.0, 1.0), False)]
)
def test_distance_is_kept_to_a_ball_laid_beside_its_spot(laid: Point, distant: bool) -> None:
    game = Game(State.FREE_KICK, stopped=True, whose=Whose.THEIRS, spot=Point(-3.0, 1.0))
    order = decide(view(robot("cyan2", -6.5, 1.0), ball(*laid)), game, SUPPORTER)
    goal_side = decide(view(robot("cyan2", -6.5, 1.0), ball(*game.spot)), game, SUPPORTER)
    assert (math.dist(order.place, laid) >= 3.2) == (distant or laid.x_m > 0.0)
    assert (order.place != goal_side.place) == distant


def test_keeper_keeps_goal_and_fetches_a_slow_ball_before_it() -> None:
    keeper = robot("cyan1", -10.5, 0.0, role=GOALKEEPER)
    far = robot("", 0.0, 0.0)
    assert decide(view(keeper, ball(-5.0, 0.0), (), (far,)), role=GOALKEEPER).skill == "keep_goal"
    assert decide(view(keeper, ball(-9.5, 0.0), (), (far,)), role=GOALKEEPER).skill == "get_ball"
    assert decide(view(keeper, ball(-9.5, 0.0, -4.0, 0.0), (), (far,)), role=GOALKEEPER).skill == "keep_goal"
    near = robot("", -9.0, 0.0)
    assert decide(view(keeper, ball(-9.5, 0.0), (), (near,)), role=GOALKEEPER).skill == "keep_goal"
    assert decide(view(keeper, ball(-10.2, 0.0), (), (far,)), role=GOALKEEPER, holds_ball=True).skill == "clear"


@pytest.mark.parametrize(
    ("places", "speeds_m_s", "rival"),
    [
        pytest.param((-8.5, -8.4), (0.0, 0.0), 0.0, id="the end of its room"),
        pytest.param((-9.0, -9.0), (1.1, 1.3), 0.0, id="a ball that is nearly too fast"),
        pytest.param((-8.8, -8.74), (0.0, 0.0), -7.55, id="a rival that is nearly as soon"),
    ],
)
def test_keeper_on_its_way_to_the_ball_does_not_turn_back(
    places: tuple[float, float], speeds_m_s: tuple[float, float], rival: float
) -> None:
    """Noise around a limit once sent it to the ball and back ten times a second."""
    tactics, skills = Tactics(FIELD), []
    for tick in range(40):
        where = ball(places[tick % 2], 0.0, 0.0, speeds_m_s[tick % 2])
        seen = view(robot("cyan1", -10.5, 0.0, role=GOALKEEPER), where, (), (robot("", rival, 0.0),))
        skills.append(tactics.decide(seen, PLAY, job(GOALKEEPER), False, 0.05).skill)
    assert skills[0] == "get_ball"
    assert len(set(skills)) == 1


@pytest.mark.parametrize("stopped", [True, False])
def test_keeper_goes_home_around_their_set_piece(stopped: bool) -> None:
    """A robot becomes the keeper of its team anywhere on the field when the lower number is sent off."""
    game = Game(State.FREE_KICK, stopped=stopped, whose=Whose.THEIRS, spot=Point(-7.0, 0.5))
    order = decide(view(robot("cyan1", -3.0, 0.0), ball(*game.spot)), game, GOALKEEPER)
    way_rad = bearing_rad(Point(-3.0, 0.0), order.place) - bearing_rad(Point(-3.0, 0.0), game.spot)
    assert math.dist(Point(-3.0, 0.0), game.spot) * abs(math.sin(way_rad)) > 3.0
    too_near = decide(view(robot("cyan1", -6.0, -1.0), ball(*game.spot)), game, GOALKEEPER)
    assert math.dist(too_near.place, game.spot) > 3.0
    before_its_area = decide(view(robot("cyan1", -8.0, -1.0), ball(*game.spot)), game, GOALKEEPER)
    assert before_its_area.skill == "keep_goal"


def test_robot_that_meets_a_ball_goes_on_when_it_gets_slower() -> None:
    """Around the limit it once began the skill anew in every other tick."""
    tactics, skills = Tactics(FIELD), []
    for speed_m_s in (1.0, *(1.3, 1.1) * 10, 0.6):
        seen = view(robot("cyan2", 0.0, 0.0), ball(3.0, 0.0, -speed_m_s, 0.0))
        skills.append(tactics.decide(seen, PLAY, job(ATTACKER), False, 0.05).skill)
    assert skills == ["get_ball", *["intercept"] * 20, "get_ball"]


def test_attacker_leaves_a_ball_that_the_keeper_takes() -> None:
    keeper = robot("cyan1", -10.0, 0.0, role=GOALKEEPER)
    order = decide(view(robot("cyan2", -6.0, 0.0), ball(-9.5, 0.4), (keeper,)))
    assert (order.skill, FIELD.in_penalty_area(*order.place, -1.0, 1.0)) == ("goto", False), "out of the keeper's way"
    assert order.place.y_m < -1.5


def test_defender_marks_a_free_opponent_nearby() -> None:
    opponents = (robot("", 2.0, 0.0), robot("", -4.0, 2.0))
    order = decide(view(robot("cyan3", -5.0, 2.0), ball(1.8, 0.0), (), opponents), role=DEFENDER)
    assert (order.skill, order.place) == ("mark", (-4.0, 2.0))


def test_defender_leaves_an_opponent_to_a_nearer_mate() -> None:
    opponents = (robot("", 2.0, 0.0), robot("", -4.0, 2.0))
    nearer = robot("cyan4", -4.8, 2.0, role=DEFENDER)
    order = decide(view(robot("cyan3", -5.0, 2.0), ball(1.8, 0.0), (nearer,), opponents), role=DEFENDER)
    assert order.skill == "goto"


def test_pressed_robot_before_its_own_goal_clears_the_ball() -> None:
    beside = robot("", -6.0, 1.0)
    assert decide(with_ball(-6.0, 0.0, beside), holds_ball=True).skill == "clear"
    assert decide(with_ball(-6.0, 0.0), holds_ball=True).skill == "dribble"


def test_ball_that_an_opponent_dribbles_is_not_waited_for() -> None:
    seen = view(robot("cyan2", -2.0, 0.0), ball(3.0, 0.0, -2.0, 0.0), (), (robot("", 3.33, 0.0),))
    assert decide(seen).skill == "get_ball"


def test_unknown_ball_is_searched_from_the_place_in_formation() -> None:
    seen = view(robot("cyan2", 0.0, 0.0), Ball(known=False))
    order = decide(seen)
    assert (order.skill, order.place) == ("search", (-3.0, 1.0))


@pytest.mark.parametrize(
    ("place", "kept"), [((8.0, 2.5), True), ((8.0, -2.5), False), ((8.0, 0.2), False), ((2.0, -2.5), True)]
)
def test_mates_of_a_robot_that_may_shoot_leave_its_way_free(place: tuple[float, float], kept: bool) -> None:
    own, shooter = robot("cyan3", min(7.0, place[0]), 1.0), robot("cyan2", 4.67, 0.0)
    seen = view(own, ball(5.0, 0.0), (shooter,))
    order = Tactics(FIELD).decide(seen, PLAY, job(SUPPORTER, *place), False, 0.05)
    assert (order.place == place) == kept
    assert kept or order.place.y_m >= 1.2
    free = seen._replace(mates=(shooter._replace(place=Point(2.0, 0.0)),))
    assert Tactics(FIELD).decide(free, PLAY, job(SUPPORTER, *place), False, 0.05).place == place


def test_pass_once_begun_follows_its_receiver() -> None:
    tactics, pressing = Tactics(FIELD), robot("", -1.2, -0.2)
    near, other = agreed(robot("cyan3", 3.0, 3.0, role=SUPPORTER)), robot("cyan4", 3.0, 2.0, role=SUPPORTER)
    tactics.decide(with_ball(-2.0, 0.0, pressing, mates=(near,)), PLAY, job(ATTACKER), True, 0.05)
    moved = near._replace(place=Point(2.5, 3.5))
    order = tactics.decide(with_ball(-2.0, 0.0, pressing, mates=(moved, other)), PLAY, job(ATTACKER), True, 0.05)
    assert (order.skill, order.place) == ("pass", moved.place)


def test_ball_that_gets_no_further_is_released() -> None:
    before_robot = with_ball(-2.0, 0.0, robot("", -1.2, 0.0))
    assert decide(before_robot, holds_ball=True).skill == "dribble"
    assert decide(before_robot, holds_ball=True, ticks=14).skill == "push"


def test_ball_at_the_end_line_is_not_shot_at_the_post() -> None:
    assert decide(with_ball(10.6, 4.0), holds_ball=True).skill != "shoot"


def test_taker_that_bumped_the_ball_away_leaves_it_to_a_mate() -> None:
    tactics, mates = Tactics(FIELD), (robot("cyan3", 0.0, 3.0, role=SUPPORTER),)
    waiting = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=Point(2.0, 0.0))
    seen = view(robot("cyan2", 1.6, 0.0), ball(2.0, 0.0), mates)
    for game, where in ((waiting, ball(2.0, 0.0)), (waiting._replace(stopped=False), ball(2.5, 0.0))):
        tactics.decide(seen._replace(ball=where), game, job(ATTACKER), False, 0.05)
    assert tactics.barred


def test_ball_that_a_mate_bumped_away_is_taken_by_the_next_robot() -> None:
    tactics, mates = Tactics(FIELD), (robot("cyan3", 0.0, 3.0, role=SUPPORTER),)
    waiting = Game(State.FREE_KICK, stopped=True, whose=Whose.OURS, spot=Point(2.0, 0.0))
    game = waiting._replace(stopped=False)
    for seen_game, own_x_m, ball_x_m in ((waiting, -1.0, 2.0), (game, -1.0, 2.5), (game, 1.8, 2.5)):
        seen = view(robot("cyan2", own_x_m, 0.0), ball(ball_x_m, 0.0), mates)
        tactics.decide(seen, seen_game, job(ATTACKER), False, 0.05)
    assert not tactics.barred


def test_clearance_beside_the_touch_line_goes_upfield() -> None:
    order = decide(with_ball(-7.0, 6.0, robot("", -6.1, 6.0)), holds_ball=True, ticks=4)
    assert order.intention == "clear"
    assert order.heading_rad < -0.3


def test_keeper_that_has_time_is_lobbed_and_an_empty_goal_is_not() -> None:
    beside = with_ball(4.0, 2.0)
    assert decide(beside, holds_ball=True, ticks=4).skill == "lob"
    assert decide(beside._replace(opponents=()), holds_ball=True, ticks=4).skill == "shoot"
