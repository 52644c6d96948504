"""Advantage: a foul without contact waits while its victims have the ball."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from tests.procs.referee.script import CYAN, Script

FREE_KICK_CYAN = (State.FREE_KICK, CYAN, True)


def crowded_area(last_touch: str) -> Script:
    """Returns a script in which two robots of magenta have been in their penalty area for too long."""
    script = Script(deadlock_s=60.0).playing()
    script.roll(5.0, 0.0)
    script.touch(last_touch)
    script.robots |= {"magenta2": Point(9.5, 2.0), "magenta3": Point(9.5, -2.0)}
    script.wait(1.5)
    return script


def test_foul_waits_while_its_victims_have_the_ball() -> None:
    script = crowded_area("cyan2")
    assert script.reasons == []
    script.goal(11.2, "cyan2")
    assert script.score == (1, 0)


def test_foul_is_punished_when_its_victims_lose_the_ball() -> None:
    script = crowded_area("cyan2")
    script.touch("magenta1")
    assert (script.state, script.reasons) == (FREE_KICK_CYAN, ["too many in an area"])


def test_advantage_is_over_after_three_seconds() -> None:
    script = crowded_area("cyan2")
    script.robots |= {"magenta2": Point(4.0, 2.0)}
    script.wait(2.8)
    script.touch("magenta1")
    assert script.reasons == []


@pytest.mark.parametrize("touches", [False, True])
def test_contact_stops_the_game_while_a_foul_is_held_back(touches: bool) -> None:
    script = crowded_area("cyan2")
    crash = Event(Kind.COLLISION, "magenta2", "cyan2", 9.5, 0.5, 3.5)
    script.tick(crash, *[Event(Kind.TOUCH, "magenta2", "", *script.ball, 1.0)] * touches)
    assert (script.state, script.reasons) == ((State.PENALTY, CYAN, True), ["collision"])


def test_foul_of_the_team_with_the_ball_stops_the_game() -> None:
    assert crowded_area("magenta3").state == FREE_KICK_CYAN
