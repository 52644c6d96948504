"""Friction between ball and ground: a kicked ball slides until its spin fits its speed, then it rolls.

The two phases of the straight ball model that teams of the small size league use; here the spin is a vector, so that
every push, bounce or kick starts a new sliding phase by itself.
"""

import math

from procs.model.ball import BallModel


class RollingFriction:
    """Keeps the ball's spin as the velocity (m/s, world frame) at which it would roll without sliding."""

    def __init__(self, ball: BallModel, scale: float = 1.0) -> None:
        """`scale` multiplies both decelerations of `ball`."""
        self._sliding_m_s2 = ball.sliding_m_s2 * scale
        self._rolling_m_s2 = ball.rolling_m_s2 * scale
        self._inertia, self._standstill_m_s = ball.inertia, ball.standstill_m_s
        self.spin_x_m_s = 0.0
        self.spin_y_m_s = 0.0

    def roll(self, vx_m_s: float, vy_m_s: float) -> None:
        """Sets the spin to that of a ball that rolls at this velocity."""
        self.spin_x_m_s, self.spin_y_m_s = vx_m_s, vy_m_s

    def advance(self, vx_m_s: float, vy_m_s: float, duration_s: float) -> tuple[float, float]:
        """Returns the velocity of the ball after `duration_s` on the ground, without other forces."""
        slip_x, slip_y = vx_m_s - self.spin_x_m_s, vy_m_s - self.spin_y_m_s
        slip_m_s = math.hypot(slip_x, slip_y)
        loss_m_s = self._sliding_m_s2 * duration_s
        until_rolling_m_s = slip_m_s / (1 + 1 / self._inertia)
        if loss_m_s < until_rolling_m_s:
            share = loss_m_s / slip_m_s
            self.spin_x_m_s += slip_x * share / self._inertia
            self.spin_y_m_s += slip_y * share / self._inertia
            return vx_m_s - slip_x * share, vy_m_s - slip_y * share
        share = 1 / (1 + 1 / self._inertia)
        vx_m_s, vy_m_s = vx_m_s - slip_x * share, vy_m_s - slip_y * share
        speed_m_s = math.hypot(vx_m_s, vy_m_s)
        rolling_s = duration_s - until_rolling_m_s / self._sliding_m_s2
        slower_m_s = speed_m_s - self._rolling_m_s2 * rolling_s
        factor = slower_m_s / speed_m_s if slower_m_s > self._standstill_m_s else 0.0
        self.spin_x_m_s, self.spin_y_m_s = vx_m_s * factor, vy_m_s * factor
        return self.spin_x_m_s, self.spin_y_m_s
