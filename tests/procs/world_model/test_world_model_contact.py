"""Whether a robot may touch the ball: by its reach, its approach, and a ball that leaves it."""

import numpy as np
import pytest

from procs.world_model.ball_filter import BallFilter
from procs.world_model.contact import may_touch

TOUCH_M = 0.33


def ball(speed_m_s: float = 0.0) -> BallFilter:
    """Returns a ball at the origin, known well; with a speed it was kicked along x."""
    found = BallFilter(np.zeros(2), np.eye(2) * 0.01**2)
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
        ((0.6, 0.0, -3.0, 0.0), 0.0, True),
        ((0.6, 0.0, 3.0, 0.0), 0.0, False),
        ((-0.35, 0.0, 0.0, 0.0), 4.0, False),
        ((-0.35, 0.0, 3.5, 0.0), 4.0, True),
        ((0.6, 0.0, 0.0, 0.0), 4.0, True),
    ],
)
def test_robot_within_reach_may_touch(robot: tuple[float, ...], speed_m_s: float, expected: bool) -> None:
    assert may_touch(ball(speed_m_s), np.array([robot]), TOUCH_M, 0.05) is expected


def test_without_robots_no_contact() -> None:
    assert not may_touch(ball(), np.zeros((0, 4)), TOUCH_M, 0.05)
