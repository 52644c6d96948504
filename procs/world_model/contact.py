"""Whether a robot may touch the ball: the ball keeps its motion while none is within reach."""

import math
from collections.abc import Iterable, Sequence

from procs.world_model.ball_filter import BallFilter

_HULL_M = 0.03  # from the distance in the mouth to that beside it
_HULL_SD_M = 0.03  # deviation of the distance at which a robot touches the ball: its mouth is flat, its back round
_MOST_M = 0.2  # a ball whose place is less certain than that is treated as if it were
_FLEES_M_S = 0.5  # a ball that surely leaves a robot faster than that was kicked, and is not touched again


def touch_probability(
    ball: BallFilter,
    robots: Iterable[Sequence[float]],
    robots_m2: Iterable[float],
    touch_m: float,
    duration_s: float,
) -> float:
    """Returns the probability that the nearest of the robots reaches the ball within `duration_s`.

    Args:
        ball: belief about the ball.
        robots: n rows x, y (m), vx, vy (m/s) of the robots' middles.
        robots_m2: n variances of the middles along an axis.
        touch_m: distance of the middles of robot and ball when they touch.
        duration_s: the step.
    """
    covariance, (x_m, y_m, vx_m_s, vy_m_s) = ball.covariance.tolist(), ball.state.tolist()
    ball_m2 = min(_MOST_M**2, (covariance[0][0] + covariance[1][1]) / 2)
    deviation_m_s = math.sqrt((covariance[2][2] + covariance[3][3]) / 2)
    likely = -math.inf
    for (robot_x_m, robot_y_m, robot_vx_m_s, robot_vy_m_s), robot_m2 in zip(robots, robots_m2, strict=True):
        away_x_m, away_y_m = robot_x_m - x_m, robot_y_m - y_m
        way_m = math.hypot(away_x_m, away_y_m)
        closing_m_s = -(away_x_m * (robot_vx_m_s - vx_m_s) + away_y_m * (robot_vy_m_s - vy_m_s)) / max(way_m, 1e-6)
        if -closing_m_s - 2 * deviation_m_s < _FLEES_M_S:
            gap_m = way_m - touch_m - _HULL_M - duration_s * max(closing_m_s, 0.0)
            likely = max(likely, -gap_m / math.sqrt(ball_m2 + robot_m2 + _HULL_SD_M**2))
    return _normal(likely)


def _normal(deviations: float) -> float:
    """Returns the probability that a value of the standard normal distribution is below `deviations`."""
    return 0.5 * math.erfc(-deviations / math.sqrt(2.0))
