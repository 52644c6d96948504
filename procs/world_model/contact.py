"""Whether a robot may touch the ball: the ball keeps its motion while none is within reach."""

import math

import numpy as np

from procs.model.frames import Floats
from procs.world_model.ball_filter import BallFilter

_HULL_M = 0.03  # from the distance in the mouth to that beside it
_HULL_SD_M = 0.03  # deviation of the distance at which a robot touches the ball: its mouth is flat, its back round
_MOST_M = 0.2  # a ball whose place is less certain than that is treated as if it were
_FLEES_M_S = 0.5  # a ball that surely leaves a robot faster than that was kicked, and is not touched again


def touch_probability(ball: BallFilter, robots: Floats, robots_m2: Floats, touch_m: float, duration_s: float) -> float:
    """Returns the probability that the nearest of the robots reaches the ball within `duration_s`.

    Args:
        ball: belief about the ball.
        robots: (n, 4): x, y (m), vx, vy (m/s) of the robots' middles.
        robots_m2: (n), variances of the middles along an axis.
        touch_m: distance of the middles of robot and ball when they touch.
        duration_s: the step.
    """
    if not len(robots):
        return 0.0
    covariance, away = ball.covariance, robots - ball.state
    ways_m = np.hypot(away[:, 0], away[:, 1])
    closing_m_s = -(away[:, :2] * away[:, 2:]).sum(axis=1) / np.maximum(ways_m, 1e-6)
    gaps_m = ways_m - touch_m - _HULL_M - duration_s * np.maximum(closing_m_s, 0.0)
    ball_m2 = min(_MOST_M**2, (covariance[0, 0] + covariance[1, 1]) / 2)
    likely = -gaps_m / np.sqrt(ball_m2 + robots_m2 + _HULL_SD_M**2)
    deviation_m_s = math.sqrt((covariance[2, 2] + covariance[3, 3]) / 2)
    stays = -closing_m_s - 2 * deviation_m_s < _FLEES_M_S
    return _normal(float(likely[stays].max())) if stays.any() else 0.0


def _normal(deviations: float) -> float:
    """Returns the probability that a value of the standard normal distribution is below `deviations`."""
    return 0.5 * math.erfc(-deviations / math.sqrt(2.0))
