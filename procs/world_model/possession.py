"""Determines which robot has the ball, as far as a robot knows."""

import math
from collections.abc import Iterable

from lcmtypes.soccer import world_model_t
from procs.world_model.team import Mate

OPPONENT = "?"
"""Holder of a ball at an opponent, whose name no robot of the team knows."""
_TOLD_S = 0.3  # a mate's statement that it holds the ball is believed for so long
_NEAR_M = 0.9  # an opponent further from the ball does not have it, however uncertain the ball's place is
_LOW_M = 0.3  # a ball that is higher above the carpet flies over an opponent's mouth


def holder_of(
    model: world_model_t, robot: str, holds: bool, mates: Iterable[Mate], now_s: float, mouth_m: float
) -> str:
    """Returns the robot of the team that has the ball in its mouth, `OPPONENT` for one at the ball, or nothing.

    Args:
        model: ball and opponents, already filled in.
        robot: name of the robot itself.
        holds: whether it has the ball in its mouth.
        mates: its mates.
        now_s: logical time.
        mouth_m: from a robot's middle to the middle of a held ball.
    """
    if holds:
        return robot
    for mate in mates:
        if mate.holds_ball and now_s - mate.told_s <= _TOLD_S:
            return mate.name
    ball = model.ball
    if ball.known and ball.z_m < _LOW_M and model.opponents:
        nearest_m = min(math.hypot(one.x_m - ball.x_m, one.y_m - ball.y_m) for one in model.opponents)
        near_m = mouth_m + 2 * math.sqrt(ball.covariance[0][0] + ball.covariance[1][1])
        if nearest_m < min(_NEAR_M, near_m):
            return OPPONENT
    return ""
