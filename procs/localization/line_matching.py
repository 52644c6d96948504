"""Fits a pose to the white points that a robot sees, so that they lie on the field's lines.

This is the error-minimising self-localization of Lauer, Lange and Riedmiller ("Calculating the Perfect Match", RoboCup
2005): each point adds the robust error 1 - c²/(c² + e²) of its distance e from the nearest line. Two things differ:
weighted Gauss-Newton steps take the place of RPROP, and each point is weighted by the accuracy with which an
omnidirectional camera measures it along the line's normal.
"""

from dataclasses import dataclass

import numpy as np

from procs.localization.line_map import LineMap
from procs.model.frames import Floats

_DAMPING = np.diag((20.0, 20.0, 20.0))  # 1/m², 1/m², 1/rad²: limits steps in directions that no line determines
_LONGEST_STEP = np.array((0.3, 0.3, 0.15))  # m, m, rad: the planes of the table are valid nearby only
_CONVERGED = np.array((1e-3, 1e-3, 3e-4))  # m, m, rad: far below the error of a match
_NEAR_SD_M = 0.02  # deviation of a point near the robot ...
_SD_1_M = 0.005  # ... and its growth with the squared distance in m², about a pixel of the usual mirror at 2 to 5 m


class LinePoints:
    """White points (n) in the robot frame, in metres, with their accuracy.

    In an omnidirectional picture one pixel covers ground that grows with the square of the distance along the ray, and
    with the distance across it.
    """

    def __init__(self, x_m: Floats, y_m: Floats) -> None:
        self.x_m = x_m
        self.y_m = y_m
        self.range_m = np.hypot(x_m, y_m)
        along_m = _NEAR_SD_M + _SD_1_M * self.range_m**2
        self.along_m2 = along_m**2
        """(n): variance along the ray."""
        self.across_m2 = (_NEAR_SD_M + _SD_1_M * self.range_m) ** 2
        """(n): variance across the ray."""
        self.stretch = (self.along_m2 - self.across_m2) / np.maximum(self.range_m, 1e-6) ** 2
        """(n): growth of the variance along a line's normal with the squared part of the ray along that normal."""
        self.trust = 1.0 / along_m
        """(n): weight in a search of the whole field."""
        self.share = self.trust / max(float(self.trust.sum()), 1e-9)
        """(n): share of the score of a match."""

    @classmethod
    def chosen(cls, x_m: Floats, y_m: Floats, reach_m: float, most: int) -> "LinePoints":
        """Returns the points within reach, evenly thinned if there are too many."""
        with np.errstate(over="ignore"):  # a range that overflows is beyond reach
            near = np.flatnonzero(np.hypot(x_m, y_m) < reach_m)
        if len(near) > most:
            near = near[np.arange(most) * (len(near) - 1) // max(most - 1, 1)]
        return cls(x_m[near], y_m[near])

    def thinned(self, most: int) -> "LinePoints":
        """Returns at most `most` of the points, evenly chosen."""
        return LinePoints.chosen(self.x_m, self.y_m, np.inf, most)

    def __len__(self) -> int:
        return len(self.x_m)


@dataclass(frozen=True)
class Matches:
    """Results of k start poses."""

    poses: Floats
    """(k, 3): x, y (m), heading (rad), world frame."""
    information: Floats
    """(k, 3, 3): curvature of the error at each pose; the inverse of its covariance if all points were independent."""
    scores: Floats
    """(k): 1 if every point lies on a line, near 0 if no point does."""


def match(lines: LineMap, points: LinePoints, starts: Floats, iterations: int = 6, robust_m: float = 0.25) -> Matches:
    """Moves each of k start poses (k, 3) to the nearest minimum of the robust error.

    `robust_m` is the c of the robust error: a point twice as far from every line hardly counts.
    """
    poses, kept = starts, starts.copy()
    information, gradient, scores = _evaluate(lines, points, poses, robust_m)
    step_information, step_gradient = information, gradient
    for _ in range(iterations):
        step = np.linalg.solve(step_information + _DAMPING, step_gradient[..., None])[..., 0]
        if (np.abs(step) < _CONVERGED).all():
            break
        poses = poses - np.minimum(np.maximum(step, -_LONGEST_STEP), _LONGEST_STEP)
        step_information, step_gradient, new_scores = _evaluate(lines, points, poses, robust_m)
        better = new_scores >= scores
        kept[better], information[better], scores[better] = (
            poses[better],
            step_information[better],
            new_scores[better],
        )
    return Matches(kept, information, scores)


def _evaluate(lines: LineMap, points: LinePoints, poses: Floats, robust_m: float) -> tuple[Floats, Floats, Floats]:
    """Returns information (k, 3, 3), gradient (k, 3) and score (k) of poses (k, 3)."""
    cosine, sine = np.cos(poses[:, 2, None]), np.sin(poses[:, 2, None])
    x_m = cosine * points.x_m - sine * points.y_m
    y_m = sine * points.x_m + cosine * points.y_m
    distance_m, normal_x, normal_y = lines.look_up(x_m + poses[:, 0, None], y_m + poses[:, 1, None])
    variance_m2 = points.across_m2 + (normal_x * x_m + normal_y * y_m) ** 2 * points.stretch
    on_line = robust_m**2 / (robust_m**2 + distance_m**2)
    weight = on_line**2 / variance_m2
    slopes = np.empty((len(poses), 3, len(points)))
    slopes[:, 0], slopes[:, 1], slopes[:, 2] = normal_x, normal_y, normal_y * x_m - normal_x * y_m
    weighted = slopes * weight[:, None]
    gradient = (weighted @ distance_m[..., None])[..., 0]
    return weighted @ slopes.transpose(0, 2, 1), gradient, on_line @ points.share
