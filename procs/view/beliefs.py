"""Draws the beliefs of a robot: its pose, and the ball with its uncertainty."""

import math

import numpy as np

from lcmtypes.soccer import world_model_t
from procs.view.canvas import Canvas
from procs.view.palette import TEAM_COLOURS, UNKNOWN_TEAM

_SIGMAS, _LIMIT_M = 2.0, 3.0  # half axes of an ellipse in standard deviations, and their longest
_RING_M, _LINE_M = 0.03, 0.02  # distance of the ring at the believed pose from the body of a robot there, and its width


def draw_beliefs(canvas: Canvas, team: str, belief: world_model_t, radius_m: float) -> None:
    """Draws, in the colour of a team, a ring at the believed pose and an ellipse of two deviations around the ball.

    `radius_m` is that of a robot.
    """
    colour = TEAM_COLOURS.get(team, UNKNOWN_TEAM)
    if belief.localized:
        canvas.ring((belief.x_m, belief.y_m), radius_m + _RING_M, _LINE_M, colour)
    covariance = np.array(belief.ball.covariance)[:2, :2]
    if belief.ball.known and np.isfinite(covariance).all():
        variances, axes = np.linalg.eigh((covariance + covariance.T) / 2)
        sizes = [min(_LIMIT_M, _SIGMAS * math.sqrt(max(0.0, variance))) for variance in variances[::-1].tolist()]
        angle_deg = math.degrees(math.atan2(axes[1, 1], axes[0, 1]))
        canvas.ellipse((belief.ball.x_m, belief.ball.y_m), (sizes[0], sizes[1]), angle_deg, colour)
