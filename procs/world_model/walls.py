"""Obstacles of a ball besides robots: the walls around the field, and the nets, posts and bars of its goals."""

import math
from dataclasses import dataclass

from procs.model.ball import BallModel
from procs.model.field import Field
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import Mode
from procs.world_model.crossbar import Crossbars

_WALL_BOUNCE, _NET_BOUNCE = 0.5, 0.05  # share of the speed that a wall and a net leave
_INSIDE_M = 1.0  # a ball this far from the walls is within them in every model
_RESTS = 0.5  # a ball that rests with a higher probability stays where it lies
_POST_M = 0.2  # largest distance between a post and the middle of a ball that touches it
_KEEPER_M = 1.0  # a keeper that no camera sees may stand this far in front of its goal
_MARGIN_M, _MOST_M = 0.05, 0.2  # distance that counts as near a wall, and most that an uncertain place adds to it


@dataclass(frozen=True)
class Walls:
    """Largest |x| and |y| that the middle of a ball can reach, in metres."""

    x_m: float
    y_m: float
    net_x_m: float
    """In a goal, where the net takes the place of the wall."""
    goal_x_m: float
    """Place of the posts along the field."""
    goal_half_width_m: float
    goal_height_m: float
    bars: Crossbars

    @classmethod
    def of(cls, field: Field, ball: BallModel) -> "Walls":
        """Returns the walls around a field and the nets of its goals."""
        return cls(
            x_m=field.half_length_m + field.border_m - ball.radius_m,
            y_m=field.half_width_m + field.border_m - ball.radius_m,
            net_x_m=field.half_length_m + field.goal_depth_m - ball.radius_m,
            goal_x_m=field.half_length_m,
            goal_half_width_m=field.goal_width_m / 2,
            goal_height_m=field.goal_height_m,
            bars=Crossbars.of(field, ball),
        )

    def behind_net(self, ball: BallFilter, radius_m: float) -> bool:
        """Returns whether a ball of that radius is between the back of a goal and the wall."""
        back_m = self.net_x_m + radius_m
        return not ball.surely_within(back_m, math.inf) and abs(float(ball.state[0])) > back_m

    def contain(self, ball: BallFilter, nets: bool) -> None:
        """Lets a ball beyond the walls bounce off them.

        `nets` states whether the nets stop it, too: they stop a ball from the field that does not fly over the goal.
        """
        x_limit_m, y_limit_m = self.goal_x_m - _INSIDE_M, self.y_m - _INSIDE_M
        if ball.surely_within(x_limit_m, y_limit_m):
            return
        x_m, y_m, *_ = map(abs, ball.state.tolist())
        if x_m < x_limit_m and y_m < y_limit_m:
            return
        in_goal = nets and y_m < self.goal_half_width_m
        ball.stay_within(self.net_x_m if in_goal else self.x_m, self.y_m, _NET_BOUNCE if in_goal else _WALL_BOUNCE)

    def near(self, ball: BallFilter, duration_s: float) -> bool:
        """Returns whether the ball may reach a wall, a net, a post or an unseen keeper within `duration_s`.

        Walls and posts do not move a ball that rests beside them.
        """
        (x_m, y_m, vx_m_s, vy_m_s), covariance = map(abs, ball.state.tolist()), ball.covariance
        margin_m = _MARGIN_M + duration_s * math.hypot(vx_m_s, vy_m_s)
        margin_m += min(_MOST_M, math.sqrt(2 * (covariance[0, 0] + covariance[1, 1])))
        at_posts = x_m > self.goal_x_m - margin_m and abs(y_m - self.goal_half_width_m) < margin_m + _POST_M
        at_wall = x_m > self.x_m - margin_m or y_m > self.y_m - margin_m
        at_goal = x_m > self.goal_x_m - _KEEPER_M - margin_m and y_m < self.goal_half_width_m + margin_m
        return bool(at_goal or (ball.weights[Mode.RESTS] < _RESTS and (at_posts or at_wall)))
