"""Limits of a robot's kicker, and whether it tells that the ball is held."""

import math

from lcmtypes.robot import kicker_state_t

STEEPEST_RAD = math.pi / 3
"""Highest elevation of a kick."""
_TOLD_S = 0.5
"""A kicker that is silent for longer does not know whether the ball is in the mouth."""


def tells_held(kicker: kicker_state_t, silent_s: float) -> bool:
    """Returns whether the ball is held, as a kicker says that has been silent for so long."""
    return bool(kicker.ball_held) and silent_s <= _TOLD_S
