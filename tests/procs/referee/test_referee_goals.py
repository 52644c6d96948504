"""Own goals after set pieces."""

import pytest

from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
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
