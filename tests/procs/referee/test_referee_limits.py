"""Limits of the fouls: balls set free in time, robots that are driven into others, both teams at fault at once."""

import math

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from procs.model.game_states import State
from procs.model.teams import Team
from procs.referee import restarts
from tests.procs.referee.script import CYAN, MAGENTA, TICK_S, Script


@pytest.mark.parametrize("after", ["rolls", "is touched again"])
def test_dribble_ends_where_the_ball_is_set_free(after: str) -> None:
    script = Script().playing()
    start_m = script.ball.x_m
    script.carry("cyan3", start_m + 2.8)
    script.tick(Event(Kind.KICK, "cyan3", "", *script.ball, 8.0))
    for way_m in (3.0, 3.2, 3.25):
        script.roll(start_m + way_m, 0.0)
    assert script.reasons == []
    if after == "rolls":
        script.wait(1.0)
    else:
        script.touch("cyan3")
    assert script.reasons == ([] if after == "rolls" else ["dribbling"])


@pytest.mark.parametrize("first", ["cyan", "magenta"])
def test_robot_that_a_rival_drives_pushes_no_other(first: str) -> None:
    second = "magenta" if first == "cyan" else "cyan"
    row = (f"{first}2", f"{second}2", f"{first}3")
    script = Script().playing()
    while not script.whistle.stopped:
        script.robots |= {robot: Point(2.0 + 0.5 * place, 3.0) for place, robot in enumerate(row)}
        script.tick(**dict.fromkeys(row, Point(10 * TICK_S, 0.0)))
    assert [(call.robot, call.reason) for call in script.whistle.calls] == [(row[0], "pushing")]


@pytest.mark.parametrize("x_m", [9.5, -9.5])
@pytest.mark.parametrize("last", ["cyan2", "magenta2"])
def test_both_teams_crowd_an_area_and_the_ball_is_dropped(x_m: float, last: str) -> None:
    script = Script(deadlock_s=60.0, fouls_per_card=1).playing()
    script.touch(last)
    script.robots |= {"cyan2": Point(x_m, 2.0), "cyan3": Point(x_m, -2.0)}
    script.robots |= {"magenta2": Point(x_m, 1.0), "magenta3": Point(x_m, -1.0)}
    script.wait(1.2)
    assert (script.state, script.reasons) == ((State.DROP_BALL, Team.NONE, True), ["too many in an area"])
    assert script.whistle.cards.warned == {"cyan3", "magenta3"}


@pytest.mark.parametrize("taken", [True, False])
def test_two_collisions_at_once_bring_a_dropped_ball(taken: bool) -> None:
    script = Script(fouls_per_card=1).started()
    if taken:
        script.touch("cyan2")
        script.roll(-1.0, 0.0)
    crash = Event(Kind.COLLISION, "cyan2", "magenta2", 9.5, 0.5, 3.5)
    script.tick(crash, crash._replace(robot="cyan1"), crash._replace(robot="magenta3", other="cyan3"))
    assert (script.state, script.whistle.spot) == ((State.DROP_BALL, Team.NONE, True), (0.0, 0.0))
    assert script.whistle.cards.warned == {"cyan2", "magenta3"}


@pytest.mark.parametrize("touches", [True, False])
def test_third_breach_of_a_set_piece_brings_a_yellow_card(touches: bool) -> None:
    """The set piece is not repeated any more, and the breach is counted once however long it lasts."""
    script = Script()
    for breach in range(3):
        script.started()
        assert script.whistle.cards.warned == set()
        script.robots["magenta2"] = Point(1.0, 0.0)
        for _ in range(4 if breach == 2 else 1):
            if touches:
                script.touch("magenta2")
            else:
                script.tick()
        script.robots["magenta2"] = Point(4.0, 2.0)
    assert (len(script.reasons), script.whistle.stopped) == (2, False)
    assert script.whistle.cards.warned == {"magenta2"}
    script.wait(1.0)
    assert script.whistle.cards.sent_off == set()


@pytest.mark.parametrize(("taker", "rival"), [(CYAN, "magenta3"), (MAGENTA, "cyan3")])
@pytest.mark.parametrize("y_m", [1.0, 6.0])
def test_rivals_are_named_of_those_that_breach_a_kick_off(taker: Team, rival: str, y_m: float) -> None:
    script = Script()
    script.whistle.interrupt(restarts.kick_off(taker))
    script.started()
    script.robots |= {"cyan3": Point(1.0, y_m), "magenta3": Point(-1.0, y_m)}
    script.tick()
    assert script.whistle.stopped
    assert script.whistle.calls[-1].robot == rival


@pytest.mark.parametrize(("outwards_m_s", "reasons"), [(0.0, []), (0.3, ["holding"])])
def test_ball_that_is_led_around_a_bend_is_not_pulled_back(outwards_m_s: float, reasons: list[str]) -> None:
    """The carrier is outside of the bend, and pulls the ball only if it spirals outwards."""
    script = Script(deadlock_s=60.0).playing()
    for tick in range(80):
        angle, radius_m = 2.0 * tick * TICK_S, 1.0 + outwards_m_s * tick * TICK_S
        script.ball = Point(radius_m * math.cos(angle), radius_m * math.sin(angle))
        script.robots["cyan3"] = Point((radius_m + 0.33) * math.cos(angle), (radius_m + 0.33) * math.sin(angle))
        script.touch("cyan3")
    assert script.reasons == reasons
