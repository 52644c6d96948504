"""A match that is led by commands: stops and starts, breaks, and commands that make no sense."""

import math

import pytest

from procs.model.events import Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.referee.cards import Card
from procs.referee.orders import carry_out
from procs.referee.sight import Sight
from tests.procs.referee.script import CYAN, MAGENTA, Script


def ask(script: Script, name: str, team: str = "") -> str:
    """Gives a command, and lets the crew place the ball; returns why it was refused."""
    refused = carry_out(script.whistle, Sight(script.ball, robots=script.robots), name, team)
    script.tick()
    return refused


def led_by_hand() -> Script:
    """Returns a match that only commands lead, in play."""
    script = Script(automatic=False)
    assert ask(script, "start") == ""
    script.touch("cyan2")
    script.roll(-1.0, 0.0)
    assert script.state[0] is State.PLAY
    return script


@pytest.mark.parametrize(
    ("ball", "command", "spot"),
    [
        ((2.0, 5.0), "freekick", (2.0, 5.0)),
        ((2.0, 7.1), "throwin", (2.0, 6.9)),
        ((-3.0, -7.4), "throwin", (-3.0, -6.9)),
        ((11.2, -3.0), "goalkick", (-7.4, -3.5)),
        ((11.2, -3.0), "corner", (10.8, -6.8)),
        ((6.0, -3.0), "drop_ball", (7.4, -3.5)),
    ],
)
def test_set_piece_belongs_where_play_was_stopped(
    ball: tuple[float, float], command: str, spot: tuple[float, float]
) -> None:
    script = led_by_hand()
    script.roll(*ball)
    ask(script, "stop")
    script.wait(2.0)
    assert ask(script, command, "" if command == "drop_ball" else "cyan") == ""
    assert script.whistle.spot == pytest.approx(spot)
    script.wait(2.0)
    ask(script, "penalty", "cyan")
    ask(script, command, "" if command == "drop_ball" else "cyan")
    assert script.whistle.spot == pytest.approx(spot), "the decision is changed"


@pytest.mark.parametrize(
    ("ball", "dropped"), [((2.0, 5.0), (2.0, 5.0)), ((10.0, 3.0), (7.4, 3.0)), ((2.0, -6.9), (2.0, -6.5))]
)
def test_stopped_ball_is_dropped_away_from_lines_and_goals(
    ball: tuple[float, float], dropped: tuple[float, float]
) -> None:
    script = led_by_hand()
    script.roll(*ball)
    ask(script, "stop")
    assert script.state == (State.DROP_BALL, 0, True)
    assert script.whistle.spot == pytest.approx(dropped)
    ask(script, "goalkick", "magenta")
    assert script.whistle.spot == pytest.approx((7.4, math.copysign(3.5, ball[1]))), (
        "on the side where play was stopped"
    )


def test_throw_in_belongs_where_the_ball_went_out() -> None:
    script = led_by_hand()
    for place in ((2.0, 6.9), (2.2, 7.2), (3.0, 7.9)):
        script.roll(*place)
    ask(script, "stop")
    ask(script, "throwin", "magenta")
    assert script.whistle.spot == pytest.approx((2.2, 6.9))


def test_stop_leaves_the_ball_where_it_is() -> None:
    script = led_by_hand()
    script.roll(2.0, 5.0)
    ask(script, "stop")
    assert (script.state, script.ball) == ((State.DROP_BALL, 0, True), (2.0, 5.0))


def test_start_after_a_stop_drops_the_ball_there() -> None:
    for ball, spot in (((2.0, 5.0), (2.0, 5.0)), ((2.0, 7.4), (2.0, 6.5)), ((10.8, 1.0), (7.4, 1.0))):
        script = led_by_hand()
        script.roll(*ball)
        ask(script, "stop")
        assert ask(script, "start") == ""
        assert (script.state[0], script.whistle.stopped) == (State.DROP_BALL, False)
        assert script.ball == pytest.approx(spot)
        script.roll(0.0, 0.0)
        assert script.state[0] is State.PLAY


def test_set_piece_without_a_stop_belongs_where_the_ball_is() -> None:
    script = led_by_hand()
    script.roll(3.0, -2.0)
    script.ball = Point(3.2, -2.0)
    ask(script, "freekick", "magenta")
    assert (script.state[:2], script.whistle.spot) == ((State.FREE_KICK, MAGENTA), (3.2, -2.0))


def test_set_piece_is_not_taken_where_another_half_ended() -> None:
    script = led_by_hand()
    script.roll(5.0, 5.0)
    ask(script, "stop")
    ask(script, "second_half")
    ask(script, "freekick", "cyan")
    assert (script.state[:2], script.whistle.spot) == ((State.FREE_KICK, CYAN), (0.0, 0.0))


def test_break_led_by_hand_lasts_until_the_next_half() -> None:
    script = led_by_hand()
    ask(script, "half_time")
    script.wait(60.0)
    assert (script.state[0], script.whistle.half) == (State.HALF_TIME, 1)
    assert ask(script, "second_half") == ""
    assert (script.state, script.whistle.half) == ((State.KICK_OFF, MAGENTA, True), 2)


def test_half_led_by_hand_lasts_until_a_command() -> None:
    script = Script(automatic=False, half_s=5.0, overtime_half_s=5.0, decide=True)
    for half, command in enumerate(("start", "second_half", "first_half_overtime", "second_half_overtime"), 1):
        ask(script, command)
        script.wait(20.0)
        assert (script.whistle.half, script.whistle.at_rest) == (half, False)


def test_penalty_led_by_hand_lasts_until_a_command() -> None:
    script = Script(automatic=False, penalties=1)
    ask(script, "penalties")
    ask(script, "start")
    script.touch("cyan2", Kind.KICK)
    script.goal(11.2, "cyan2")
    script.wait(60.0)
    assert (script.state, script.score) == ((State.PENALTY, CYAN, False), (0, 0))


def test_break_ends_the_match_if_no_half_follows_any_more() -> None:
    script = Script(half_s=2.0, half_time_s=1.0, decide=True)
    ask(script, "goal", "cyan")
    ask(script, "second_half")
    ask(script, "goal", "magenta")
    script.wait(2.0)
    assert (script.state[0], script.whistle.half) == (State.HALF_TIME, 2)
    assert ask(script, "subgoal", "magenta") == ""
    script.wait(1.0)
    assert (script.state[0], script.score) == (State.FROZEN, (1, 0))


@pytest.mark.parametrize("automatic", [True, False])
def test_start_right_after_a_set_piece_waits_for_the_ball(automatic: bool) -> None:
    script = Script(automatic=automatic)
    script.tick()
    script.ball = Point(5.0, 3.0)
    sight = Sight(script.ball, robots=script.robots)
    assert carry_out(script.whistle, sight, "corner", "cyan") == ""
    assert carry_out(script.whistle, sight, "start") == ""
    assert script.state == (State.CORNER_KICK, CYAN, True)
    script.tick()
    assert script.state == (State.CORNER_KICK, CYAN, False)
    script.tick()
    assert script.state == (State.CORNER_KICK, CYAN, False), "the way of the crew is no way of the ball"


def test_start_does_not_wait_long_for_the_ball() -> None:
    script = Script(automatic=False)
    script.placed = script.whistle.placements + 1  # by no crew
    script.ball = Point(5.0, 3.0)
    sight = Sight(script.ball, robots=script.robots)
    carry_out(script.whistle, sight, "corner", "cyan")
    carry_out(script.whistle, sight, "start")
    for _ in range(20):
        script.whistle.step(0.05, sight)
    assert not script.whistle.stopped


def test_stop_takes_back_a_start_that_waits() -> None:
    script = Script(automatic=False)
    sight = Sight(Point(5.0, 3.0), robots=script.robots)
    for name, team in (("corner", "cyan"), ("start", ""), ("stop", "")):
        assert carry_out(script.whistle, sight, name, team) == ""
    script.wait(1.0)
    assert script.state == (State.CORNER_KICK, CYAN, True)


def test_start_in_the_tick_of_a_stop_waits_for_the_ball() -> None:
    script = Script(automatic=False)
    assert ask(script, "freekick", "cyan") == ask(script, "start") == ""
    spot = script.ball
    script.carry("cyan2", spot.x_m + 1.5)
    for name in ("stop", "start"):
        assert carry_out(script.whistle, Sight(script.ball, robots=script.robots), name) == ""
    assert script.state == (State.FREE_KICK, CYAN, True)
    script.tick()
    assert (script.state, script.ball) == ((State.FREE_KICK, CYAN, False), spot)


def test_repeats_by_hand_use_up_no_repeats_after_breaches() -> None:
    """A breach has a set piece repeated twice at most; what a person repeats does not count."""
    script = Script(penalties=2)
    ask(script, "penalties")
    for _ in range(3):
        ask(script, "start")
        assert not script.whistle.stopped
        ask(script, "penalty", "cyan")
    ask(script, "start")
    script.touch("magenta1")
    assert script.state == (State.PENALTY, CYAN, True)
    assert script.reasons[-1] == "touch before the set piece was taken"


@pytest.mark.parametrize(("piece", "time_s"), [("penalty", 10.0), ("corner", 7.0)])
def test_set_piece_by_hand_has_the_time_of_the_rules(piece: str, time_s: float) -> None:
    script = Script(automatic=False)
    ask(script, piece, "cyan")
    script.tick()
    ask(script, "start")
    script.wait(time_s - 0.2)
    before = script.state[0]
    script.wait(0.4)
    assert (before is State.PLAY, script.state[0] is State.PLAY) == (False, True)


def test_start_by_hand_excuses_the_keeper_that_plays() -> None:
    """The goalkeeper of before is off the field; the new one is far from its goal."""
    script = Script()
    script.whistle.card("magenta1", Card.RED)
    script.robots |= {"magenta1": Point(10.5, 7.5), "magenta2": Point(3.0, 3.0), "cyan2": Point(6.7, 0.0)}
    ask(script, "penalty", "cyan")
    ask(script, "start")
    script.tick()
    assert script.state == (State.PENALTY, CYAN, False)
    assert script.reasons == []


def test_dropped_ball_led_by_hand_is_play_after_a_touch() -> None:
    script = led_by_hand()
    ask(script, "drop_ball")
    ask(script, "start")
    script.tick()
    assert script.state == (State.DROP_BALL, 0, False)
    script.touch("cyan2")
    assert script.state == (State.PLAY, 0, False)
