"""Honesty of what robots claim about others, and about a ball that none of them sees: how often errors are covered."""

import math

import numpy as np

from procs.evaluation.beliefs import Samples, covers, models_of, placed_ticks
from procs.evaluation.piece import Piece

UNSEEN_S = 0.3
"""A ball without a sighting for that time counts as unseen."""
_SAME_M = 1.0  # an opponent further from all robots is not one of them


def claims(piece: Piece) -> Samples:
    """Returns whether the truth lies within each claimed ellipse of 95 %: of an unseen ball, opponents and mates.

    A robot without a covariance, as the truth is told in some launch files, is no claim.
    """
    placed = placed_ticks(piece)
    unseen: list[bool] = []
    opponents: list[bool] = []
    mates: list[bool] = []
    for robot, tick, model, truth in models_of(piece):
        ball, at = model.ball, {each.name: (each.x_m, each.y_m) for each in truth.robots}
        if ball.known and ball.age_s >= UNSEEN_S and tick not in placed:
            error = np.array((ball.x_m - truth.ball_x_m, ball.y_m - truth.ball_y_m))
            unseen.append(covers(np.array(ball.covariance)[:2, :2], error))
        rivals = [at[rival.name] for rival in piece.rivals(tick, robot)]
        for one in model.opponents:
            place = (one.x_m, one.y_m)
            nearest = min(rivals, key=lambda rival: math.dist(rival, place), default=None)
            covariance_m2 = np.array(one.covariance_m2)
            if nearest is not None and math.dist(nearest, place) <= _SAME_M and covariance_m2.any():
                opponents.append(covers(covariance_m2, np.subtract(place, nearest)))
        for mate in model.mates:
            covariance_m2 = np.array(mate.covariance_m2)
            if mate.name in at and covariance_m2.any():
                mates.append(covers(covariance_m2, np.subtract((mate.x_m, mate.y_m), at[mate.name])))
    return {
        "inside 95 %, ball unseen": np.array(unseen, np.float64),
        "inside 95 %, opponents": np.array(opponents, np.float64),
        "inside 95 %, mates": np.array(mates, np.float64),
    }
