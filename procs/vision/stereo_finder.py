"""Finds upright bodies in the pictures of a stereo pair: disparity, height above the ground, then round obstacles."""

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass, field

import cv2
import numpy as np

from procs.model.algebra import Floats
from procs.model.frames import Indices
from procs.model.robot import ROBOT
from procs.vision.obstacle_finder import Obstacle
from procs.vision.stereo_rig import Grey, StereoRig

_SUBPIXELS = 16  # OpenCV's disparities are in sixteenths of a pixel
_LEAST_ROWS = 4  # of a column that a body covers
_COLUMN_GAP = 8  # columns without a body that may lie within one
_SAME_PART = 0.25  # of the radius of a robot times two: deeper steps separate bodies


@dataclass(frozen=True)
class StereoFinder:
    """Finds robots of known radius in pairs of one rig."""

    rig: StereoRig
    lowest_m: float = 0.28
    """Lower edge of the heights that are looked at: above the ball."""
    highest_m: float = 0.58
    """Upper edge of these heights."""
    farthest_m: float = 4.5
    """Bodies further ahead are not reported."""
    radius_m: float = ROBOT.radius_m
    deviation_px: float = 0.35
    """Standard deviation of a disparity."""
    disparities: int = 64
    """Largest disparity in pixels, a multiple of 16; what is nearer is not seen."""
    block_px: int = 11
    """Width and height of the blocks that are compared; odd."""
    _matcher: list[cv2.StereoBM] = field(default_factory=list, compare=False)

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
        return [self._obstacle(columns[part], near_m[part]) for part in self._bodies(columns, near_m)]

    def _bodies(self, columns: Indices, near_m: Floats) -> Iterator[slice]:
        steps = (np.diff(columns) > _COLUMN_GAP) | (np.abs(np.diff(near_m)) > 2 * _SAME_PART * self.radius_m * 2)
        edges = [0, *(np.flatnonzero(steps) + 1).tolist(), len(columns)]
        for first, last in itertools.pairwise(edges):
            width_px = self.rig.focal_px * 2 * self.radius_m / float(np.median(near_m[first:last]))
            if last - first >= 0.4 * width_px:
                yield slice(first, last)

    def _obstacle(self, columns: Indices, near_m: Floats) -> Obstacle:
        rig = self.rig
        points_m = np.column_stack((near_m, -rig.columns[columns] * near_m))
        first, last = (math.atan2(points_m[end, 1], points_m[end, 0]) for end in (0, -1))
        ray_rad = (first + last) / 2
        ahead = np.array((math.cos(ray_rad), math.sin(ray_rad)))
        along_m = points_m @ ahead
        across_m = points_m @ np.array((-ahead[1], ahead[0]))
        depth_m = np.sqrt((self.radius_m**2 - across_m**2).clip(0.0))
        away_m = float(np.median(along_m + depth_m))
        x_m, y_m = away_m * ahead
        along = self.deviation_px * away_m**2 / (rig.focal_px * rig.baseline_m) + 0.02
        across = 2.0 * away_m / rig.focal_px + 0.02
        axes = np.column_stack((ahead, (-ahead[1], ahead[0])))
        covariance_m2 = axes @ np.diag((along**2, across**2)) @ axes.T
        return Obstacle(x_m + rig.forward_m, y_m + rig.baseline_m / 2, covariance_m2)
