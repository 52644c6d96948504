"""A match that is led by commands: stops and starts, breaks, and commands that make no sense."""

import pytest

from procs.model.field import Point
from procs.referee.orders import carry_out
from procs.referee.restarts import State
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
