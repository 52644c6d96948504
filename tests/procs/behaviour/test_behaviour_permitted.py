"""Places where a robot may stand, and drives to places where it may not."""

import math
from typing import Any

import pytest

from fwk.testing import Bench
from lcmtypes.core import answer_t
from lcmtypes.soccer import ball_estimate_t, mate_estimate_t, robot_estimate_t, world_model_t
from procs.behaviour.bodies import USUAL
from procs.behaviour.navigator import Navigator
from procs.behaviour.permitted import Permitted, is_field_player
from procs.behaviour.skiller import Skiller
from procs.model.field import Point
from procs.model.robot import PLAYERS
from tests.procs.behaviour.behaviour_parts import FIELD, moved

AREA_M = 11.0 - FIELD.goal_area_depth_m
"""Distance of the front of a goal area from the halfway line."""


def model(x_m: float, y_m: float, heading_rad: float, keeper: bool) -> world_model_t:
    made = world_model_t(localized=True, x_m=x_m, y_m=y_m, heading_rad=heading_rad, ball=ball_estimate_t())
    if keeper:
        made.mates = [mate_estimate_t(name="cyan1", number=1, role="goalkeeper", x_m=-4.0, y_m=5.0)]
        made.n_mates = 1
    return made


def driven(x_m: float, y_m: float, keeper: bool, ticks: int = 120) -> tuple[int, Point]:
    """Lets cyan2 carry out `goto` from 1.5 m before the goal; returns the last answer, and where the robot is."""
    skiller, navigator = Bench(Skiller, "cyan2/skiller"), Bench(Navigator, "cyan2/navigator")
    skiller.skill.put(skill="goto", x_m=x_m, y_m=y_m, heading_rad=0.0)
    here, heading_rad = Point(math.copysign(8.5, x_m), 3.0), 0.0
    for _ in range(ticks):
        for bench in (skiller, navigator):
            seen = model(*here, heading_rad, keeper)
            seen.header.time_us = bench.time_us
            bench.port("world_model").put(seen)
        skiller.iterate()
        target: Any = skiller.port("drive_target").sent[-1]
        target.header.time_us = navigator.time_us
        navigator.port("drive_target").put(target)
        navigator.iterate()
        here, heading_rad = moved(here, heading_rad, navigator.port("motor_command").sent[-1])
    return skiller.skill.sent[-1].answer.state, here


@pytest.mark.parametrize(
    ("place", "keeper", "there"),
    [
        ((10.6, 0.0), True, (AREA_M - 0.1, 0.0)),
        ((-10.6, 0.5), True, (-AREA_M + 0.1, 0.5)),
        ((10.6, 0.0), False, (10.6, 0.0)),
        ((10.95, 0.0), False, (10.9, 0.0)),
        ((11.75, 7.75), True, (11.65, 7.65)),
    ],
)
def test_goto_is_done_at_the_nearest_permitted_place(
    place: tuple[float, float], keeper: bool, there: tuple[float, float]
) -> None:
    state, here = driven(*place, keeper)
    assert math.dist(here, there) < 0.1
    assert state == answer_t.DONE


def test_permitted_place_is_the_nearest() -> None:
    permitted = Permitted(FIELD, USUAL)
    assert permitted.nearest(Point(1.0, 2.0), field_player=True) == (1.0, 2.0)
    assert permitted.nearest(Point(11.3, 0.0), field_player=False) == (10.9, 0.0)
    assert permitted.nearest(Point(11.3, 0.0), field_player=True) == pytest.approx((AREA_M - 0.1, 0.0))


@pytest.mark.parametrize(("robot", "keeper", "plays"), [("cyan2", True, True), ("cyan2", False, False)])
def test_robot_with_a_lower_mate_is_a_field_player(robot: str, keeper: bool, plays: bool) -> None:
    assert is_field_player(model(0.0, 0.0, 0.0, keeper), robot, PLAYERS) == plays


@pytest.mark.parametrize(("robot", "plays"), [("cyan1", False), ("cyan2", True), ("cyan5", True)])
def test_robot_that_only_sees_mates_goes_by_its_number(robot: str, plays: bool) -> None:
    made = model(0.0, 0.0, 0.0, keeper=False)
    made.silent_mates, made.n_silent_mates = [robot_estimate_t(x_m=-10.5)], 1
    assert is_field_player(made, robot, PLAYERS) == plays
