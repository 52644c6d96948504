"""Probability that a robot touches the ball: by its reach, its approach, and a ball that leaves it."""

import numpy as np
import pytest

from procs.model.ball import BALL
from procs.world_model.ball_filter import BallFilter
from procs.world_model.contact import touch_probability

TOUCH_M = 0.33
ROBOT_M2 = np.array([0.03**2])


def ball(speed_m_s: float = 0.0) -> BallFilter:
    """Returns a ball at the origin, known well; with a speed it was kicked along x."""
    found = BallFilter(np.zeros(2), np.eye(2) * 0.01**2, BALL)
    if speed_m_s:
        found.kick(np.array((speed_m_s, 0.0)))
    else:
        found.hold(np.zeros(4), np.eye(4) * 0.01**2)
    return found


@pytest.mark.parametrize(
    ("robot", "speed_m_s", "expected"),
    [
        ((0.35, 0.0, 0.0, 0.0), 0.0, True),
        ((0.75, 0.0, 0.0, 0.0), 0.0, False),
        ((0.5, 0.0, -3.0, 0.0), 0.0, True),
        ((0.6, 0.0, 3.0, 0.0), 0.0, False),
        ((-0.35, 0.0, 0.0, 0.0), 4.0, False),
        ((-0.35, 0.0, 3.5, 0.0), 4.0, True),
        ((0.55, 0.0, 0.0, 0.0), 4.0, True),
    ],
)
def test_robot_within_reach_touches(robot: tuple[float, ...], speed_m_s: float, expected: bool) -> None:
    probability = touch_probability(ball(speed_m_s), np.array([robot]), ROBOT_M2, TOUCH_M, 0.05)
    assert probability > 0.5 if expected else probability < 0.05


def test_robot_that_follows_the_ball_hardly_touches_it() -> None:
    """A gap of 0.2 m, well known, makes a touch improbable; the same gap with an uncertain robot does not."""
    robot = np.array([(0.56, 0.0, 0.0, 0.0)])
    assert touch_probability(ball(), robot, ROBOT_M2, TOUCH_M, 0.05) < 0.01
    assert touch_probability(ball(), robot, np.array([0.2**2]), TOUCH_M, 0.05) > 0.1


def test_without_robots_no_contact() -> None:
    assert touch_probability(ball(), np.zeros((0, 4)), np.zeros(0), TOUCH_M, 0.05) == 0.0
