"""The crossbars of the goals, which a ball in flight can hit."""

from procs.model.field import Field
from procs.simulation.physics.ball_body import Ball

_BOUNCE = 0.7


class Crossbar:
    """Sends a ball back that crosses the plane of a goal where the bar is."""

    def __init__(self, field: Field, ball: Ball) -> None:
        self._ball = ball
        self._line_m = field.half_length_m - field.line_width_m / 2
        self._half_m = field.goal_width_m / 2
        self._low_m = field.goal_height_m
        self._high_m = field.goal_height_m + field.post_diameter_m
        self._before_m = 0.0

    def stop(self) -> None:
        """Acts on the ball after each step."""
        ball = self._ball
        (x_m, y_m), (vx_m_s, vy_m_s) = ball.body.position, ball.body.velocity
        before_m, self._before_m = self._before_m, x_m
        if not ball.z_m or abs(before_m) >= self._line_m or abs(x_m) < self._line_m or abs(y_m) > self._half_m:
            return
        if ball.z_m < self._high_m and ball.z_m + 2 * ball.radius_m > self._low_m:
            ball.body.position = (before_m, y_m)
            ball.body.velocity = (-_BOUNCE * vx_m_s, vy_m_s)
            self._before_m = before_m
