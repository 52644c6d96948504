"""A camera that hangs: the same picture, or the same percepts, again and again, each as if it were new."""

from typing import Any

import pytest

from lcmtypes.soccer import ball_percept_t, line_points_t
from tests.procs.simulation.test_simulation_percepts import Flying, seen_through


@pytest.mark.parametrize("rendered", [False, True])
def test_frozen_camera_repeats_what_it_saw_with_new_times(rendered: bool) -> None:
    """The ball goes around the robot."""
    system = seen_through(rendered, Flying, {"frozen": True})
    system.tick(6)
    balls = list(map(ball_percept_t.decode, system.sent["cyan1/ball_percept"]))
    lines = list(map(line_points_t.decode, system.sent["cyan1/line_points"]))
    assert len({(each.x_m, each.y_m, each.visible) for each in balls}) == 1
    assert len({(*each.x_m, *each.y_m) for each in lines}) == 1
    assert len({each.capture_us for each in balls}) == len(balls) == 6


@pytest.mark.parametrize("rendered", [False, True])
def test_camera_that_hangs_during_a_match_recovers(rendered: bool) -> None:
    system = seen_through(rendered, Flying)
    eyes: Any = system.runners["cyan1/camera" if rendered else "cyan1/percepts"].component
    for frozen in (False, True, False):
        eyes.config.frozen = frozen
        eyes.config_changed()
        system.tick(3)
    places = [(each.x_m, each.y_m) for each in map(ball_percept_t.decode, system.sent["cyan1/ball_percept"])]
    assert len(set(places[:3])) == len(set(places[6:])) == 3
    assert len(set(places[3:6])) == 1
    assert places[6] != places[5]
