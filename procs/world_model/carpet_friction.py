"""Friction between the ball and the carpet: the ball slides until its spin fits its speed, then rolls."""

import math
from typing import NamedTuple

from procs.world_model.ball_modes import Mode

_TINY = 1e-9  # avoids divisions by 0
_LEAST_CARPET = 0.3  # least factor of the decelerations


class Friction(NamedTuple):
    """Friction between a ball and the usual carpet."""

    sliding_m_s2: float
    """Deceleration of the sliding ball."""
    rolling_m_s2: float
    """Deceleration of the rolling ball."""
    rolling_share: float
    """Share of a kick's speed that is left when the ball begins to roll."""


def rubbed(
    mode: Mode, state: list[float], slip_m2_s2: float, duration_s: float, grounded_s: float, friction: Friction
) -> tuple[list[float], list[float]]:
    """Lets the carpet act on a moving ball for a step.

    Friction acts against the slip, which is velocity minus settled velocity. It is weaker where the slip is uncertain,
    and where the slip ends within the step. In a mouth, friction turns the ball instead of braking it.

    Args:
        mode: the model.
        state: (7), as `ball_filter` explains it.
        slip_m2_s2: variance of the slip along an axis.
        duration_s: the step.
        grounded_s: part of the step in which the carpet acts on the ball.
        friction: of the ball on the usual carpet.

    Returns:
        The new state (7), and the derivatives (6, 5) of its first six values by the last five of the old one, row
        after row.
    """
    x_m, y_m, vx_m_s, vy_m_s, ux_m_s, uy_m_s, carpet = state
    sliding_m_s2, rolling_m_s2, rolling_share = friction
    slip_x_m_s, slip_y_m_s = vx_m_s - ux_m_s, vy_m_s - uy_m_s
    per_carpet_m_s = sliding_m_s2 * grounded_s
    step_m_s = per_carpet_m_s * carpet
    slip2_m2_s2 = slip_x_m_s * slip_x_m_s + slip_y_m_s * slip_y_m_s
    scale = 1.0 / math.sqrt(slip2_m2_s2 + max(0.0, slip_m2_s2) + step_m_s * step_m_s + _TINY)
    along_x, along_y, turn = slip_x_m_s * scale, slip_y_m_s * scale, step_m_s * scale
    xx, xy, yy = turn * (1.0 - along_x * along_x), -turn * along_x * along_y, turn * (1.0 - along_y * along_y)
    if mode is Mode.HANDLED:
        step_m_s, per_carpet_m_s = rolling_share * step_m_s, rolling_share * per_carpet_m_s
        xx, xy, yy = rolling_share * xx, rolling_share * xy, rolling_share * yy
        wx_m_s, wy_m_s = vx_m_s, vy_m_s
        ux_m_s, uy_m_s = ux_m_s + step_m_s * along_x, uy_m_s + step_m_s * along_y
        by_velocity = [1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0]
        by_settled = [xx, xy, 1.0 - xx, -xy, per_carpet_m_s * along_x, xy, yy, -xy, 1.0 - yy, per_carpet_m_s * along_y]
    else:
        speed_m_s = math.hypot(ux_m_s, uy_m_s) + _TINY
        share = rolling_m_s2 * grounded_s * (1.0 - math.sqrt(slip2_m2_s2) * scale) / speed_m_s  # that rolling takes
        by_x_m_s, by_y_m_s = share * ux_m_s, share * uy_m_s
        lost = min(1.0, share * carpet)
        wx_m_s = vx_m_s - step_m_s * along_x - lost * ux_m_s
        wy_m_s = vy_m_s - step_m_s * along_y - lost * uy_m_s
        ux_m_s, uy_m_s = (1.0 - lost) * ux_m_s, (1.0 - lost) * uy_m_s
        slid_x_m_s, slid_y_m_s = -per_carpet_m_s * along_x - by_x_m_s, -per_carpet_m_s * along_y - by_y_m_s
        by_velocity = [1.0 - xx, -xy, xx, xy, slid_x_m_s, -xy, 1.0 - yy, xy, yy, slid_y_m_s]
        by_settled = [0.0, 0.0, 1.0, 0.0, -by_x_m_s, 0.0, 0.0, 0.0, 1.0, -by_y_m_s]
    half_s = duration_s / 2.0
    by_place = [half_s * each for each in by_velocity]
    by_place[0] += half_s
    by_place[6] += half_s
    x_m, y_m = x_m + half_s * (vx_m_s + wx_m_s), y_m + half_s * (vy_m_s + wy_m_s)
    moved = [x_m, y_m, wx_m_s, wy_m_s, ux_m_s, uy_m_s, max(_LEAST_CARPET, carpet)]
    return moved, [*by_place, *by_velocity, *by_settled]
