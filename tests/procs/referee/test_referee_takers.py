"""Takers of set pieces: their own goals, and their touches when they are alone."""

import pytest

from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee.reasons import Reason
from tests.procs.referee.script import CYAN, MAGENTA, Script


@pytest.mark.parametrize(
    ("second", "score", "state", "team"),
    [("", (0, 0), State.CORNER_KICK, MAGENTA), ("magenta2", (0, 1), State.KICK_OFF, CYAN)],
)
def test_dropped_ball_own_goal_needs_two_robots(second: str, score: tuple[int, int], state: State, team: Team) -> None:
    script = Script(deadlock_s=1.0).playing()
    script.wait(1.1)
    script.started()
    assert script.state == (State.DROP_BALL, 0, False)
    script.ball = Point(-1.0, 0.0)
    if second:
        script.touch(second)
    script.touch("cyan2")
    script.roll(-3.0, 0.0)
    script.goal(-11.2, "cyan2")
    assert (script.score, script.state) == (score, (state, team, True))


def test_mates_that_come_back_make_no_touch_a_double_one() -> None:
    script = Script(repair_s=3.0).started()
    for mate in ("cyan1", "cyan3"):
        script.whistle.take_out(mate, Reason.REPAIR)
    script.touch("cyan2")
    script.roll(0.7, 0.0)
    script.touch("cyan2")
    for _ in range(80):
        script.roll(script.ball.x_m + 0.05, 0.0)
    assert not script.whistle.cards.sent_off
    assert (script.state[0], script.reasons) == (State.PLAY, [])
