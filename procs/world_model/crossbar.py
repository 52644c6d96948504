"""Crossbars of the goals, off which a ball in the air bounces if it is as high as they are."""

import math
from dataclasses import dataclass

from procs.model.ball import BallModel
from procs.model.field import Field
from procs.model.normal import normal_cdf
from procs.world_model.ball_filter import BallFilter
from procs.world_model.ball_modes import NO_CONTACT, Contact
from procs.world_model.flight import Flight

_BOUNCE = 0.7  # share of the speed towards a bar with which a ball leaves it
_MOST_M = 0.3  # largest deviation of the ball's place that counts; a less certain place is treated like this


@dataclass(frozen=True)
class Crossbars:
    """The bars of both goals."""

    x_m: float
    """Distance of the bars from the middle of the field."""
    half_width_m: float
    low_m: float
    """A ball whose lowest point is lower passes under a bar."""
    high_m: float
    """A ball whose lowest point is higher passes over a bar."""

    @classmethod
    def of(cls, field: Field, ball: BallModel) -> "Crossbars":
        """Returns the bars of a field's goals, for a ball of that size."""
        low_m = field.goal_height_m - 2 * ball.radius_m
        return cls(field.goal_plane_m, field.goal_width_m / 2, low_m, field.bar_top_m)

    def contact(self, ball: BallFilter, flight: Flight, duration_s: float) -> Contact:
        """Returns the effect of a bar on a ball in the air in a step: a ball as high as the bar bounces back."""
        x_m, y_m, vx_m_s, vy_m_s, place_m2, _ = ball.likeliest
        side = math.copysign(1.0, vx_m_s)
        ahead_m = self.x_m - side * x_m
        if not 0.0 < ahead_m <= duration_s * abs(vx_m_s):
            return NO_CONTACT
        after_s = ahead_m / abs(vx_m_s)
        spread_m = min(_MOST_M, math.sqrt(place_m2))
        inside_m = self.half_width_m - abs(y_m + after_s * vy_m_s)
        as_high = flight.probably_below(self.high_m, after_s) - flight.probably_below(self.low_m, after_s)
        hit = normal_cdf(inside_m / max(spread_m, 1e-6)) * as_high
        return Contact(hit, 0.0, -(1.0 + _BOUNCE) * vx_m_s, 0.0, after_s)
