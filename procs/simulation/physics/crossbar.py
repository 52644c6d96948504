"""The crossbars of the goals, which a ball in flight can hit."""

from procs.model.field import Field
from procs.simulation.physics.ball_body import Ball


class Crossbar:
    """Sends a ball back that crosses the plane of a goal where the bar is."""

    def __init__(self, field: Field, ball: Ball, bounce: float) -> None:
        """`bounce` is the share of the ball's speed that is left."""
        self.over_ball = True
        """True if the ball was under the bar when it left the planes between the goals last, or was put down since."""
        self._bounce = bounce
        self._ball = ball
        self._line_m = field.goal_plane_m
        self._half_m = field.goal_width_m / 2
        self._low_m = field.goal_height_m
        self._high_m = field.bar_top_m
        self._before_m = 0.0

    def begin_at(self, x_m: float) -> None:
        """Takes the place of a ball that was put down, so that its way there crosses no goal."""
        self._before_m, self.over_ball = x_m, True

    def stops(self, x_m: float, y_m: float) -> bool:
        """Acts on the ball, which is now here, after each step; returns whether the bar sends it back."""
        ball = self._ball
        before_m, self._before_m = self._before_m, x_m
        if abs(before_m) >= self._line_m or abs(x_m) < self._line_m:
            return False
        self.over_ball = ball.z_m + 2 * ball.radius_m <= self._low_m
        if self.over_ball or ball.z_m >= self._high_m or abs(y_m) > self._half_m:
            return False
        vx_m_s, vy_m_s = ball.body.velocity
        ball.body.position = (before_m, y_m)
        ball.body.velocity = (-self._bounce * vx_m_s, vy_m_s)
        self._before_m = before_m
        return True
