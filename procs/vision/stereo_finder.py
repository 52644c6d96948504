"""Finds upright bodies in the pictures of a stereo pair: disparity, height above the ground, then round obstacles."""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import NamedTuple

import cv2
import numpy as np

from procs.model.algebra import Floats
from procs.model.frames import Indices
from procs.model.robot import ROBOT
from procs.vision.obstacle_finder import Obstacle
from procs.vision.stereo_rig import Grey, StereoRig

LONGEST_PX = 400.0
"""Largest focal length at which robots are found: in larger pictures they are too plain for block matching."""
_NEAREST_M = 0.75  # ahead of the cameras; only the omnidirectional camera sees what is nearer
_SUBPIXELS = 16  # OpenCV's disparities are in sixteenths of a pixel
_LEAST_ROWS = 4  # of a column that a body covers
_COLUMN_GAP = 8  # widest gap within a body, in columns ...
_GAP = 0.3  # ... or, if that is wider, as a share of the width of a robot
_LEAST_WIDTH = 0.4  # share of the columns of a robot that must show a body
_WHOLE = 0.85  # share of its width from which a robot counts as seen from edge to edge
_SLACK_PX = 5  # usual difference between measured and expected widths
_DOUBT = 0.4  # standard deviation of the middle, as a share of the missing or excess width
_ACROSS_PX = 2.0  # standard deviation of the middle across the ray ...
_LEAST_M = 0.02  # ... and the part of the deviations along and across that does not depend on the distance


class _Body(NamedTuple):
    """Columns (n) that show a body, and its distance ahead in each."""

    columns: Indices
    near_m: Floats
    left_hidden: bool
    """Something nearer, or the end of the picture, hides the left edge."""
    right_hidden: bool


@dataclass(frozen=True)
class StereoFinder:
    """Finds robots of known radius in the pictures of one stereo pair."""

    rig: StereoRig
    lowest_m: float = 0.28
    """Lower limit of the heights that count: above the ball."""
    highest_m: float = 0.58
    """Upper limit of the heights that count."""
    farthest_m: float = 4.5
    """Bodies further ahead are not reported."""
    radius_m: float = ROBOT.radius_m
    deviation_px: float = 0.2
    """Standard deviation of a disparity."""
    block_px: int = 11
    """Width and height of the blocks that are compared; odd."""
    _matcher: list[cv2.StereoBM] = field(default_factory=list, compare=False)

    @property
    def disparities(self) -> int:
        """Number of disparities to search, in pixels: a multiple of 16, at most half of the width of a frame."""
        nearest_px = self.rig.focal_px * self.rig.baseline_m / _NEAREST_M
        return 16 * max(1, min(math.ceil(nearest_px / 16), self.rig.width_px // 32))

    @property
    def nearest_m(self) -> float:
        """Least distance ahead of the cameras at which surfaces are measured."""
        return self.rig.focal_px * self.rig.baseline_m / (self.disparities - 1)

    def disparity(self, pixels: Grey) -> Floats:
        """Returns the disparity (height, width) in pixels of the left frame's pixels; NaN where it is not known."""
        if not self._matcher:
            matcher = cv2.StereoBM.create(self.disparities, self.block_px)
            matcher.setUniquenessRatio(10)
            matcher.setTextureThreshold(40)
            matcher.setSpeckleWindowSize(40)
            matcher.setSpeckleRange(2)
            self._matcher.append(matcher)
        left, right = (np.ascontiguousarray(half) for half in self.rig.halves(pixels))
        found = np.asarray(self._matcher[0].compute(left, right), np.float64) / _SUBPIXELS
        return np.where(found > 0.5, found, np.nan)

    def find(self, pixels: Grey) -> list[Obstacle]:
        """Returns the obstacles in a pair, robot frame, from left to right."""
        rig = self.rig
        disparity_px = self.disparity(pixels)
        ahead_m = rig.focal_px * rig.baseline_m / disparity_px
        height_m = rig.height_m - rig.rows[:, None] * ahead_m
        upright = (height_m >= self.lowest_m) & (height_m <= self.highest_m) & (ahead_m <= self.farthest_m)
        columns = np.flatnonzero(upright.sum(axis=0) >= _LEAST_ROWS)
        if not len(columns):
            return []
        near_m = np.nanmedian(np.where(upright, ahead_m, np.nan)[:, columns], axis=0)
        return [self._obstacle(body) for body in self._bodies(columns, near_m)]

    def _bodies(self, columns: Indices, near_m: Floats) -> Iterator[_Body]:
        """Divides columns with something upright into bodies, from left to right."""
        width_px = self.rig.focal_px * 2 * self.radius_m / near_m
        gaps = np.diff(columns) > np.maximum(_COLUMN_GAP, _GAP * width_px[1:])
        steps_m = np.diff(near_m)  # one deeper than the radius of a robot separates bodies
        edges = np.flatnonzero(gaps | (np.abs(steps_m) > self.radius_m)) + 1
        first_px, last_px = self.disparities + self.block_px, self.rig.width_px - 1 - self.block_px
        for begin, end in itertools.pairwise([0, *edges.tolist(), len(columns)]):
            # An edge is hidden at the end of what both frames show, or behind something nearer.
            left = columns[begin] <= first_px or (begin > 0 and steps_m[begin - 1] > 0 and not gaps[begin - 1])
            right = columns[end - 1] >= last_px or (end < len(columns) and steps_m[end - 1] < 0 and not gaps[end - 1])
            whole_px = float(np.median(width_px[begin:end]))
            across_px = int(columns[end - 1] - columns[begin]) + 1
            parts = max(1, round(across_px / whole_px))
            cuts = np.searchsorted(columns, columns[begin] + across_px * np.arange(1, parts) / parts).tolist()
            for number, part in enumerate(itertools.starmap(slice, itertools.pairwise([begin, *cuts, end]))):
                if part.stop - part.start >= _LEAST_WIDTH * whole_px:
                    yield _Body(columns[part], near_m[part], left and number == 0, right and number == parts - 1)

    def _obstacle(self, body: _Body) -> Obstacle:
        """Returns the robot of a body; the usual width places the middle of one that is hidden on one side."""
        rig = self.rig
        points_m = np.column_stack((body.near_m, -rig.columns[body.columns] * body.near_m))
        left_rad, right_rad = (math.atan2(points_m[end, 1], points_m[end, 0]) for end in (0, -1))
        ray_rad, half_rad, away_m = (left_rad + right_rad) / 2, 0.0, 0.0
        for _ in range(3):  # how wide a body should be depends on its distance, which depends on its middle
            ahead = np.array((math.cos(ray_rad), math.sin(ray_rad)))
            across_m = points_m @ np.array((-ahead[1], ahead[0]))
            away_m = float(np.median(points_m @ ahead + np.sqrt((self.radius_m**2 - across_m**2).clip(0.0))))
            # Matched blocks reach over the body's edges by half of their width.
            half_rad = math.asin(self.radius_m / max(away_m, self.radius_m)) + self.block_px / 2 / rig.focal_px
            if left_rad - right_rad > 2 * _WHOLE * half_rad or body.left_hidden == body.right_hidden:
                break
            ray_rad = right_rad + half_rad if body.left_hidden else left_rad - half_rad
        wrong_rad = max(0.0, abs(2 * half_rad - left_rad + right_rad) - _SLACK_PX / rig.focal_px)
        guessed = body.left_hidden != body.right_hidden and 2 * half_rad > left_rad - right_rad
        x_m, y_m = away_m * ahead
        along_m = self.deviation_px * away_m**2 / (rig.focal_px * rig.baseline_m) + _LEAST_M
        across_m = _ACROSS_PX * away_m / rig.focal_px + _LEAST_M + _DOUBT * (0.0 if guessed else wrong_rad) * away_m
        axes = np.column_stack((ahead, (-ahead[1], ahead[0])))
        covariance_m2 = axes @ np.diag((along_m**2, across_m**2)) @ axes.T
        return Obstacle(x_m + rig.forward_m, y_m + rig.baseline_m / 2, covariance_m2)
