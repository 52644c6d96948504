"""Limits of the fouls: balls that are set free in time."""

import pytest

from procs.model.events import Event, Kind
from procs.model.field import Point
from tests.procs.referee.script import Script


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
