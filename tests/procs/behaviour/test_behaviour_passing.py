"""Passes agreed between passer and receiver: who says what, and what each robot then does."""

import pytest

from procs.behaviour import roles
from procs.behaviour.game import Game, Whose
from procs.behaviour.order import Order
from procs.behaviour.passing import ANSWER_S, Passing
from procs.behaviour.roles import ATTACKER, SUPPORTER, receiver
from procs.behaviour.tactics import Tactics
from procs.behaviour.view import Agreement, Ball, Robot, View
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.robot import ABSENT
from tests.procs.behaviour.behaviour_parts import FIELD, agreed, ball, job, robot, view

TICK_S = 0.05
PLAY = Game(State.PLAY, stopped=False)
RIVAL = robot("", -1.2, -0.2)
PASSER, NEAR, FAR = robot("cyan2", -2.33, 0.0), robot("cyan3", 3.0, 3.0), robot("cyan4", 3.0, -4.0)
MOVING = agreed(NEAR)._replace(velocity_m_s=Point(0.0, 1.0))
HELD = ball(-2.0, 0.0)
ROLLING = ball(0.0, 0.0, 2.0, 0.0)


def pressed(*mates: Robot) -> View:
    return view(PASSER, HELD, mates, (RIVAL, robot("", 10.5, 0.0)))


def asks(mate: Robot, receiver: str) -> Robot:
    return mate._replace(agreement=Agreement(receiver, Point(0.0, 0.0)))


def play(tactics: Tactics, seen: View, duration_s: float, holds_ball: bool = True) -> list[Order]:
    ticks = range(round(duration_s / TICK_S))
    return [tactics.decide(seen, PLAY, job(ATTACKER), holds_ball, TICK_S) for _ in ticks]


def test_pass_is_announced_and_played_once_accepted() -> None:
    tactics = Tactics(FIELD)
    waiting = play(tactics, pressed(NEAR), 0.2)[-1]
    assert (waiting.skill, tactics.passing.said.receiver) == ("aim", "cyan3")
    assert tactics.passing.said.place == waiting.place == NEAR.place
    assert play(tactics, pressed(agreed(NEAR)), 2 * TICK_S)[-1].skill == "pass"


def test_passer_waits_until_the_receiver_has_stopped() -> None:
    tactics = Tactics(FIELD)
    orders = play(tactics, pressed(MOVING), 0.4)
    assert orders[-1].skill == "aim"
    assert play(tactics, pressed(agreed(NEAR)), 2 * TICK_S)[-1].skill == "pass"


def test_passer_does_not_wait_long_for_a_receiver_that_drives_on() -> None:
    orders = play(Tactics(FIELD), pressed(MOVING), 0.7)
    assert (orders[5].skill, orders[-1].skill) == ("aim", "pass")


@pytest.mark.parametrize(("rival_m", "skill"), [(1.1, "pass"), (0.9, "clear")])
def test_marked_mate_gets_no_pass(rival_m: float, skill: str) -> None:
    behind = robot("", NEAR.place.x_m + rival_m, NEAR.place.y_m)
    danger = view(
        PASSER._replace(place=Point(-4.5, 0.0)), ball(-4.17, 0.0), (agreed(NEAR),), (robot("", -3.4, -0.4), behind)
    )
    assert play(Tactics(FIELD), danger, 0.5)[-1].skill == skill


OUTSIDE = agreed(NEAR)._replace(place=Point(3.0, 7.4))


@pytest.mark.parametrize(
    ("mate", "stalled", "passes"), [(agreed(NEAR), (), True), (agreed(NEAR), ("cyan3",), False), (OUTSIDE, (), False)]
)
def test_mate_that_is_out_of_order_or_off_the_field_gets_no_pass(
    mate: Robot, stalled: tuple[str, ...], passes: bool
) -> None:
    tactics = Tactics(FIELD)
    tactics.passing.stalled = stalled
    assert (play(tactics, pressed(mate), 2 * TICK_S)[-1].skill == "pass") == passes


def test_mate_that_stops_to_play_loses_the_pass_begun() -> None:
    tactics = Tactics(FIELD)
    assert play(tactics, pressed(agreed(NEAR)), 2 * TICK_S)[-1].skill == "pass"
    absent = NEAR._replace(role=ABSENT)
    assert play(tactics, pressed(absent), TICK_S)[-1].receiver == ""


@pytest.mark.parametrize(("stalled", "receiver"), [((), "cyan3"), (("cyan3",), "cyan4")])
def test_set_piece_goes_past_a_mate_that_is_out_of_order(stalled: tuple[str, ...], receiver: str) -> None:
    tactics, spot = Tactics(FIELD), Point(-2.0, 0.0)
    tactics.passing.stalled = stalled
    supporter = NEAR._replace(role=SUPPORTER)
    seen = view(PASSER, HELD, (supporter, FAR), ())
    for stopped in (True, False):
        game = Game(State.FREE_KICK, stopped, Whose.OURS, spot)
        tactics.decide(seen, game, job(ATTACKER), not stopped, TICK_S)
        assert tactics.passing.said.receiver == receiver


def test_mate_that_does_not_answer_in_time_is_not_asked_again() -> None:
    tactics = Tactics(FIELD)
    orders = play(tactics, pressed(NEAR), ANSWER_S + 2 * TICK_S)
    assert "pass" not in {order.skill for order in orders}
    assert (tactics.passing.said.receiver, orders[-1].skill) != ("cyan3", "aim")
    assert not tactics.passing.may_ask(NEAR)
    assert tactics.passing.may_ask(FAR)


def test_mate_is_asked_again_after_a_while() -> None:
    passing = Passing()
    passing.announce("cyan3", NEAR.place)
    passing.drop()
    for _ in range(29):
        passing.watch(pressed(NEAR), True, TICK_S)
    assert not passing.may_ask(NEAR)
    passing.watch(pressed(NEAR), True, 2 * TICK_S)
    assert passing.may_ask(NEAR)


def test_acceptance_of_another_robots_pass_is_no_answer() -> None:
    tactics = Tactics(FIELD)
    assert play(tactics, pressed(agreed(NEAR, "cyan5")), 0.3)[-1].skill == "aim"


def test_dribbling_robot_asks_the_mate_of_a_likely_pass() -> None:
    tactics = Tactics(FIELD)
    calm = view(PASSER, HELD, (NEAR,), (robot("", 10.5, 0.0),))
    assert play(tactics, calm, TICK_S)[-1].skill == "dribble"
    assert tactics.passing.said.receiver == "cyan3"


def test_robot_asks_as_soon_as_it_has_caught_the_ball() -> None:
    tactics = Tactics(FIELD)
    play(tactics, pressed(NEAR), TICK_S, holds_ball=False)
    assert {order.skill for order in play(tactics, pressed(NEAR), 2 * TICK_S)} == {"get_ball"}, "the ball settles"
    assert tactics.passing.said.receiver == "cyan3"
    assert play(tactics, pressed(agreed(NEAR)), TICK_S)[-1].skill == "pass"


def test_ball_lost_before_the_pass_takes_the_announcement_back() -> None:
    tactics = Tactics(FIELD)
    play(tactics, pressed(NEAR), 0.2)
    play(tactics, pressed(NEAR)._replace(ball=ball(-1.0, 0.5)), TICK_S, holds_ball=False)
    assert tactics.passing.said.receiver == ""


def test_robot_that_pushes_the_ball_ahead_announces_no_pass() -> None:
    tactics = Tactics(FIELD)
    stuck = view(PASSER, HELD, (agreed(NEAR),), (robot("", 10.5, 0.0),))
    orders = play(tactics, stuck, 1.0)
    assert orders[-1].skill == "push"
    assert tactics.passing.said.receiver == ""


def test_receiver_accepts_and_waits_where_it_is() -> None:
    tactics = Tactics(FIELD)
    seen = view(NEAR, HELD, (asks(PASSER, "cyan3"),), (RIVAL,))
    order = tactics.decide(seen, PLAY, job(SUPPORTER, 5.0, 5.0), False, TICK_S)
    assert tactics.passing.said.passer == "cyan2"
    assert (order.skill, order.place, order.intention) == ("receive", NEAR.place, "await pass")


@pytest.mark.parametrize("mate", [PASSER, asks(PASSER, "cyan4")])
def test_robot_that_is_not_asked_takes_its_place(mate: Robot) -> None:
    tactics = Tactics(FIELD)
    order = tactics.decide(view(NEAR, HELD, (mate,)), PLAY, job(SUPPORTER, 5.0, 5.0), False, TICK_S)
    assert (tactics.passing.said.passer, order.place) == ("", (5.0, 5.0))


def test_robot_with_the_ball_accepts_no_pass() -> None:
    tactics = Tactics(FIELD)
    seen = view(NEAR, ball(3.33, 3.0), (asks(PASSER, "cyan3"),))
    play(tactics, seen, 0.3)
    assert tactics.passing.said.passer == ""


@pytest.mark.parametrize(
    ("rival", "mate", "duration_s", "kept"),
    [
        ((8.0, 0.0), NEAR, 2.0, True),
        ((8.0, 0.0), NEAR, 3.0, False),
        ((0.2, 0.0), NEAR, 0.1, False),
        ((8.0, 0.0), robot("cyan3", 0.33, 0.0), 0.1, False),
        ((8.0, 0.0), robot("cyan4", 0.33, 0.0), 0.1, True),
    ],
)
def test_announcement_ends_with_the_flight_of_the_ball(
    rival: tuple[float, float], mate: Robot, duration_s: float, kept: bool
) -> None:
    passing = Passing()
    passing.watch(pressed(NEAR), True, TICK_S)
    passing.announce("cyan3", NEAR.place)
    for _ in range(round(duration_s / TICK_S)):
        passing.watch(view(PASSER, ROLLING, (mate,), (robot("", *rival),)), False, TICK_S)
    assert (passing.said.receiver == "cyan3") == kept


@pytest.mark.parametrize(
    ("where", "opponent", "attacker"),
    [
        (ROLLING, (8.0, 0.0), "cyan3"),
        (ROLLING, (0.3, 0.0), "cyan4"),
        (ball(0.0, 0.0), (8.0, 0.0), "cyan4"),
    ],
)
def test_receiver_of_a_pass_on_its_way_attacks(where: Ball, opponent: tuple[float, float], attacker: str) -> None:
    passer = PASSER._replace(agreement=Agreement("cyan3", NEAR.place), role=roles.PASSER)
    nearer = robot("cyan4", 1.5, 0.5)
    team = (robot("cyan1", -10.5, 0.0), passer, nearer)
    seen = view(agreed(NEAR), where, team, (robot("", *opponent),))
    assert roles.assign(seen, FIELD)[attacker].role == ATTACKER


def test_both_sides_have_to_agree_on_a_pass_that_was_played() -> None:
    waits, asking = agreed(NEAR), asks(PASSER, "cyan3")
    passed = asking._replace(role=roles.PASSER)
    assert receiver([waits], view(waits, ROLLING, (passed,))) == waits
    assert receiver([waits], view(waits, ROLLING, (asking,))) is None
    assert receiver([waits], view(waits, ROLLING, (PASSER._replace(role=roles.PASSER),))) is None
    assert receiver([NEAR], view(NEAR, ROLLING, (passed,))) is None


def test_keeper_does_not_pass_to_a_mate_that_does_not_answer() -> None:
    own, mate = robot("cyan1", -9.33, 0.0), robot("cyan3", -6.0, 2.0)
    seen = view(own, ball(-9.0, 0.0), (mate,), (robot("", -8.2, -0.4),))
    tactics = Tactics(FIELD)
    orders = [tactics.decide(seen, PLAY, job(roles.GOALKEEPER), True, TICK_S) for _ in range(round(1.0 / TICK_S))]
    assert [order.skill for order in orders].count("aim") > 5
    assert "pass" not in {order.skill for order in orders}
    assert orders[-1].skill == "clear"
