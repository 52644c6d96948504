"""The ball as the finder of the ball would report it, drawn from the truth: on the ground, or in the air."""

import math
from dataclasses import dataclass

import numpy as np

from lcmtypes.soccer import ball_candidate_t, ball_percept_t
from procs.model.algebra import Floats
from procs.model.rays import left_of, rays
from procs.simulation.percept_errors import PerceptErrors
from procs.simulation.sight import Glimpse, blurred, claimed
from procs.vision.ball_finder import (
    IN_THE_AIR,
    LEAST_TOLD_PX,
    area_share,
    hidden_shift_px,
    most_fit,
    seems_whole,
    unsure_px,
)
from procs.vision.mirror import Mirror
from procs.vision.uncertainty import sphere_covariance

_LEAST_AREA = 1e-6
_VISIBLE = (0.37, 0.50, 0.63, 0.75, 0.86, 0.95, 1.0)
_SPREADS = (1.45, 1.29, 1.18, 1.11, 1.05, 1.025, 1.015)
"""Spread of the visible part of a disc behind a straight edge, compared with a disc of its area; by visible share."""


@dataclass(frozen=True)
class BallSight:
    """Draws the percepts that a camera gives of a ball of known size."""

    mirror: Mirror
    radius_m: float
    reach_m: float
    """Largest distance of a ball that is found."""
    errors: PerceptErrors
    least_visible: float
    """Least visible part of a ball that is found."""
    stated_px: float
    """Standard deviation of a ball's place that the finder states, with the shaking of the mirror."""

    def found(
        self, at_m: Floats, height_m: float, glimpse: Glimpse, moved_px: tuple[float, float], noise: list[float]
    ) -> ball_percept_t:
        """Returns the percept of a ball.

        Where a ball in the air appears, a ball on the ground would be further away and smaller. A ball that is not much
        larger than that is taken for a ball on the ground. One on the ground that a shake moves outwards seems larger.

        Args:
            at_m: (1, 2), x and y in the robot frame.
            height_m: of its lowest point.
            glimpse: part of its disc that nothing hides.
            moved_px: shift of the ball in the picture, along and across the ray.
            noise: standard normal errors of its place along and across the ray, and of its area.
        """
        visible, seen_m = glimpse.visible, at_m + glimpse.aside_m * left_of(rays(at_m)[1])
        column, row, radius_px = self.mirror.sphere((*at_m[0].tolist(), height_m + self.radius_m), self.radius_m)
        restored = glimpse.one_edge and radius_px >= LEAST_TOLD_PX
        middle_m, doubt = (at_m, 0.0) if restored else (seen_m, 1.0)
        area_error = self.errors.ball_area_px / radius_px * noise[2] - self.errors.ball_area_lost
        area = max(_LEAST_AREA, visible * (1.0 + area_error))
        viewpoint_m = self.mirror.height_m - self.radius_m
        if height_m < viewpoint_m:
            appears_m = self._blurred(middle_m * viewpoint_m / (viewpoint_m - height_m), moved_px, noise)
            *_, expected_px = self.mirror.sphere((*appears_m, self.radius_m), self.radius_m)
            fit = area * (radius_px / expected_px) ** 2
            if fit <= most_fit(expected_px):
                return self.on_ground(*appears_m, min(fit, 1.0 / fit), doubt)
        if not self.mirror.shows_all(column, row, radius_px):
            return ball_percept_t()
        spread = float(np.interp(visible, _VISIBLE, _SPREADS))
        if not seems_whole(spread, radius_px):
            return ball_percept_t()
        share = area_share(spread, radius_px)
        return self._in_the_air(seen_m, height_m, area, share, moved_px, noise)

    def on_ground(self, x_m: float, y_m: float, confidence: float, doubt: float = 1.0) -> ball_percept_t:
        """Returns the percept of a ball that is found at a place of the robot frame, or of none.

        `confidence` is its visible part; `doubt` that about the side on which the other part is hidden, 0..1.
        """
        percept = ball_percept_t()
        if confidence >= self.least_visible and math.hypot(x_m, y_m) <= self.reach_m:
            percept.visible, percept.confidence = True, confidence
            percept.x_m, percept.y_m = x_m, y_m
            *_, radius_px = self.mirror.sphere((x_m, y_m, self.radius_m), self.radius_m)
            deviation_px = self.stated_px + unsure_px(hidden_shift_px(confidence, radius_px), doubt)
            percept.covariance_m2 = claimed(self.mirror, x_m, y_m, (deviation_px, deviation_px), self.radius_m)
        return percept

    def _blurred(self, at_m: Floats, moved_px: tuple[float, float], noise: list[float]) -> tuple[float, float]:
        """Returns where a ball on the ground appears that would be at a place (1, 2) without errors."""
        along, across = (
            np.array([px + self.errors.ball_px * drawn]) for px, drawn in zip(moved_px, noise[:2], strict=True)
        )
        moved_m = blurred(self.mirror, at_m, along, across, self.radius_m)
        x_m, y_m = moved_m[0].tolist()
        return x_m, y_m

    def _in_the_air(
        self,
        at_m: Floats,
        height_m: float,
        area: float,
        stated_share: float,
        moved_px: tuple[float, float],
        noise: list[float],
    ) -> ball_percept_t:
        """Returns the percept of a ball whose distance follows from its size: one that seems small seems far away."""
        further = 1.0 / math.sqrt(area)
        below_m = self.mirror.height_m - self.radius_m - height_m
        range_m = max(1e-6, float(np.hypot(*at_m[0])))
        distance_m = math.hypot(range_m, below_m)
        px_rad = self.mirror.scale_px / (1.0 + below_m / distance_m)
        along, across = moved_px
        up_rad = (along + self.errors.ball_px * noise[0]) / px_rad
        across_m = (across + self.errors.ball_px * noise[1]) / px_rad * distance_m
        ahead_x, ahead_y = (at_m[0] / range_m).tolist()
        below_m, range_m = further * (below_m - up_rad * range_m), further * (range_m + up_rad * below_m)
        percept = ball_percept_t()
        if range_m <= self.reach_m:
            percept.visible, percept.confidence = True, IN_THE_AIR
            percept.x_m = ahead_x * range_m - ahead_y * across_m
            percept.y_m = ahead_y * range_m + ahead_x * across_m
            centre_m = self.mirror.height_m - below_m
            percept.z_m = max(0.0, centre_m - self.radius_m)
            place_m = (percept.x_m, percept.y_m, centre_m)
            percept.covariance_m2 = sphere_covariance(self.mirror, place_m, stated_share, self.stated_px).tolist()
        return percept


def candidate(percept: ball_percept_t) -> ball_candidate_t:
    """Returns the ball of a percept as one candidate among others."""
    made = ball_candidate_t()
    made.x_m, made.y_m, made.z_m = percept.x_m, percept.y_m, percept.z_m
    made.covariance_m2, made.confidence = percept.covariance_m2, percept.confidence
    return made
