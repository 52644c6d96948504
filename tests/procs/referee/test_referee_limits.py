"""Limits of the fouls: balls set free in time, robots that are driven into others."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from tests.procs.referee.script import TICK_S, Script


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
