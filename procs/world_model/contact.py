"""Whether a robot may touch the ball: the ball keeps its motion while none is within reach."""

import math

import numpy as np

from procs.model.frames import Floats
from procs.world_model.ball_filter import BallFilter

_MARGIN_M = 0.15  # places of robots are that uncertain
_MOST_M = 0.2  # a ball whose place is less certain than that is treated as if it were
_FLEES_M_S = 0.5  # a ball that surely leaves a robot faster than that was kicked, and is not touched again


def may_touch(ball: BallFilter, robots: Floats, touch_m: float, duration_s: float) -> bool:
    """Returns whether one of the robots may touch the ball within `duration_s`.

    Args:
        ball: belief about the ball.
        robots: (n, 4): x, y (m), vx, vy (m/s) of the robots' middles.
        touch_m: distance of the middles of robot and ball when they touch.
        duration_s: the step.
    """
    if not len(robots):
        return False
    covariance, away = ball.covariance, robots - ball.state
    ways_m = np.hypot(away[:, 0], away[:, 1])
    closing_m_s = -(away[:, :2] * away[:, 2:]).sum(axis=1) / np.maximum(ways_m, 1e-6)
    unsure_m = min(_MOST_M, 2 * _deviation(covariance[:2, :2]))
    reach_m = touch_m + _MARGIN_M + unsure_m + duration_s * np.maximum(closing_m_s, 0.0)
    stays = -closing_m_s - 2 * _deviation(covariance[2:, 2:]) < _FLEES_M_S
    return bool(((ways_m < reach_m) & stays).any())


def _deviation(covariance: Floats) -> float:
    return math.sqrt((covariance[0, 0] + covariance[1, 1]) / 2)
