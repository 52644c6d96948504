"""Finds robots: black that stands on the carpet, seen from its near edge."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import reduce
from operator import and_, or_

import numpy as np
from numpy.typing import NDArray

from procs.model.algebra import Floats, median
from procs.model.robot import ROBOT
from procs.vision.colours import ColourRange, Mask, Picture
from procs.vision.mirror import Mirror
from procs.vision.scan import Scan
from procs.vision.uncertainty import ground_covariance

_BODY_SAMPLES = 4  # so many black samples in a row are a body
_COVERED = 0.75  # share of rays that are black from their beginning: a covered camera, not robots all around
_BETWEEN_RAYS = 0.23  # standard deviation of a middle across the ray, as a part of the way between two rays
_FEET_SAMPLES = 3  # carpet must be visible this close before it, otherwise the near edge is hidden


@dataclass(frozen=True)
class Obstacle:
    """A robot's middle on the ground, robot frame."""

    x_m: float
    y_m: float
    covariance_m2: Floats


@dataclass(frozen=True)
class ObstacleFinder:
    """Finds round black robots of known radius on the rays of a star scan."""

    mirror: Mirror
    star: Scan
    black: ColourRange
    carpet: tuple[ColourRange, ...]
    """Colours of the carpet and its lines."""
    radius_m: float = ROBOT.radius_m
    deviation_px: tuple[float, float] = (0.5, 0.8)
    """Standard deviation of the found middle in the picture, along and across the ray; the rays' distance from each
    other may make it larger."""
    least_rays: int = 2
    """Rays that must meet a robot."""

    def find(self, hsv: Picture) -> list[Obstacle]:
        """Returns all robots in a scan (rays, samples, 3) in HSV, counter-clockwise."""
        edges_m = self._near_edges(hsv)
        if len(edges_m) < self.least_rays:
            return []
        return [self._obstacle(part) for group in self._groups(edges_m) for part in self._robots(group)]

    def _near_edges(self, hsv: Picture) -> Floats:
        """Points (n, 2) at which rays meet the feet of something black, in the order of the rays."""
        if hsv.shape[1] < _BODY_SAMPLES:
            return np.empty((0, 2))
        black = self.black.mask(hsv)
        standing = reduce(or_, (colour.mask(hsv) for colour in self.carpet))
        last = black.shape[1] - _BODY_SAMPLES + 1
        body = reduce(and_, (black[:, i : last + i] for i in range(_BODY_SAMPLES)))
        rays = np.flatnonzero(body.any(axis=1))
        starts = body[rays].argmax(axis=1)
        if (starts == 0).sum() > _COVERED * len(body):
            return np.empty((0, 2))
        seen = (starts == 0) | _any_before(standing, rays, starts)
        rays, starts = rays[seen], starts[seen]
        return np.asarray((self.star.ground_m[rays, starts] + self.star.ground_m[rays, np.maximum(starts - 1, 0)]) / 2)

    def _groups(self, edges_m: Floats) -> list[Floats]:
        """Edge points that may belong together, (n, 2) each: neighbours with a gap that a ball could hide."""
        gaps_m = np.hypot(*(edges_m - np.roll(edges_m, 1, axis=0)).T)  # the first with the last: the rays go around
        blur_m, _ = self.mirror.metres_per_px_each(np.hypot(edges_m[:, 0], edges_m[:, 1]))
        breaks = np.flatnonzero(gaps_m > 1.4 * self.radius_m + blur_m)
        if len(breaks) == 0:
            return [edges_m]
        return np.split(np.roll(edges_m, -breaks[0], axis=0), breaks[1:] - breaks[0])

    def _robots(self, group: Floats) -> Iterator[Floats]:
        """Divides a group that is too wide for one robot evenly."""
        if len(group) < self.least_rays:
            return
        width_rad = _turn(group[0], group[-1])
        range_m = float(np.hypot(group[:, 0], group[:, 1]).mean())
        expected_rad = 2 * math.asin(min(self.radius_m / (range_m + self.radius_m), 1.0))
        most = len(group) // self.least_rays
        parts = min(max(round(width_rad / expected_rad), 1), most)
        yield from np.array_split(group, parts) if parts > 1 else [group]

    def _obstacle(self, edges_m: Floats) -> Obstacle:
        middle_rad = math.atan2(*edges_m[0, ::-1]) + _turn(edges_m[0], edges_m[-1]) / 2
        ahead_x, ahead_y = math.cos(middle_rad), math.sin(middle_rad)
        edge_x_m, edge_y_m = edges_m.T
        along_m = edge_x_m * ahead_x + edge_y_m * ahead_y
        across_m = edge_y_m * ahead_x - edge_x_m * ahead_y
        away_m = median(along_m + np.sqrt(np.maximum(self.radius_m**2 - across_m**2, 0.0)))
        x_m, y_m = away_m * ahead_x, away_m * ahead_y
        along_px, across_px = self.deviation_px
        ray_px = math.tau / len(self.star.ground_m) * self.mirror.radius_px(abs(away_m))
        across_px = max(across_px, _BETWEEN_RAYS * ray_px)  # pixels do not help where rays are further apart
        return Obstacle(x_m, y_m, ground_covariance(self.mirror, x_m, y_m, along_px, across_px))


def _any_before(mask: Mask, rays: NDArray[np.intp], starts: NDArray[np.intp]) -> Mask:
    samples = (starts[:, None] - np.arange(1, _FEET_SAMPLES + 1)).clip(0)
    return np.asarray(mask[rays[:, None], samples].any(axis=1))


def _turn(first: Floats, last: Floats) -> float:
    """Returns the counter-clockwise angle from one direction to another, -pi..pi."""
    return math.remainder(math.atan2(last[1], last[0]) - math.atan2(first[1], first[0]), 2 * math.pi)
