"""Parts of the message to the team besides sightings: target, battery, belief about the ball."""

import math
from typing import Any

import numpy as np
import pytest

from lcmtypes.robot import battery_state_t
from lcmtypes.soccer import ball_estimate_t, drive_target_t, team_message_t
from procs.world_model.world_messages import fill_ball, fill_plan
from tests.procs.world_model.team_on_bench import Robot


def told(robot: Robot) -> team_message_t:
    """Returns the newest message to the team after some ticks."""
    for _ in range(4):
        robot.sense(np.array((2.0, 0.0)), [])
        robot.bench.iterate()
    message: team_message_t = robot.bench.port("team_message").sent[-1]
    return message


def robot(**target: Any) -> Robot:
    made = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    if target:
        made.bench.port("drive_target").put(**target)
    return made


def target_of(message: team_message_t) -> tuple[bool, float, float, float]:
    return bool(message.has_target), message.target_x_m, message.target_y_m, message.target_heading_rad


def charge_of(message: team_message_t) -> tuple[bool, float]:
    return bool(message.battery_known), message.battery_charge


def test_team_hears_where_the_robot_drives_to() -> None:
    message = told(robot(x_m=3.0, y_m=-1.0, heading_rad=0.5))
    assert target_of(message) == (True, 3.0, -1.0, 0.5)


@pytest.mark.parametrize("target", [{}, {"stop": True, "x_m": 3.0}, {"x_m": math.nan}, {"heading_rad": math.inf}])
def test_robot_without_a_proper_target_says_so(target: dict[str, Any]) -> None:
    assert target_of(told(robot(**target))) == (False, 0.0, 0.0, 0.0)


def test_target_of_a_skiller_that_fell_silent_is_dropped() -> None:
    made = robot(x_m=3.0)
    assert told(made).has_target
    made.bench.iterate(12)
    assert target_of(told(made)) == (False, 0.0, 0.0, 0.0)


def test_team_hears_the_newest_charge() -> None:
    made = robot()
    assert charge_of(told(made)) == (False, 0.0), "no battery has told its state"
    for charge in (0.75, 0.5):
        made.bench.port("battery_state").put(charge=charge, voltage_v=25.0)
        assert charge_of(told(made)) == (True, charge)
    assert charge_of(told(made)) == (True, 0.5), "the state of a second ago is still the newest"


@pytest.mark.parametrize("charge", [math.nan, math.inf, -0.1, 1.1])
def test_charge_that_cannot_be_is_not_known(charge: float) -> None:
    message = team_message_t()
    fill_plan(message, drive_target_t(), battery_state_t(charge=charge))
    assert charge_of(message) == (False, 0.0)


def test_team_hears_the_believed_velocity_of_the_ball() -> None:
    made = Robot("cyan1", (0.0, 0.0, 0.0), seed=1)
    for number in range(30):
        made.sense(np.array((2.0, 0.1 * number - 1.5)), [])
        made.bench.iterate()
    message = made.bench.port("team_message").sent[-1]
    ball = next(each.ball for each in made.bench.port("world_model").sent if each.header.tick == message.header.tick)
    assert message.ball_known
    assert (message.ball_vx_m_s, message.ball_vy_m_s) == (ball.vx_m_s, ball.vy_m_s)
    assert message.ball_vy_m_s == pytest.approx(2.0, abs=0.3)


def test_velocity_of_an_unknown_ball_is_none() -> None:
    message = team_message_t(ball_known=True, ball_vx_m_s=3.0)
    fill_ball(message, ball_estimate_t(vx_m_s=1.0), confidence=1.0)
    assert (message.ball_known, message.ball_vx_m_s, message.ball_vy_m_s) == (False, 0.0, 0.0)


def test_team_hears_how_sure_the_robot_is_of_its_sighting() -> None:
    made = robot()
    assert told(made).ball_confidence == 0.9
    made.sense(None, [])
    made.bench.iterate(4)
    message = made.bench.port("team_message").sent[-1]
    assert (bool(message.ball_visible), message.ball_confidence) == (False, 0.0)


@pytest.mark.parametrize("confidence", [math.nan, math.inf, -1.0, 1.5])
def test_confidence_that_cannot_be_is_none(confidence: float) -> None:
    message = team_message_t(ball_visible=True)
    fill_ball(message, ball_estimate_t(), confidence)
    assert message.ball_confidence == 0.0
