"""Finds robots: black bodies on the carpet, located by their near edges."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from procs.model.algebra import Floats, median
from procs.model.robot import ROBOT
from procs.vision.colours import ColourRange, Picture
from procs.vision.feet import Feet, feet_in
from procs.vision.mirror import Mirror
from procs.vision.scan import Scan
from procs.vision.uncertainty import plane_covariance

MOST_RAYS = 720
_BETWEEN_RAYS = 0.23  # standard deviation of a middle across the ray, as a share of the distance between two rays
_BESIDE_RAYS = 2  # rays from one body to the next if nothing is between them
_GAP = 1.4  # width of the gap that a ball in front of a robot makes at most, as a multiple of the robot's radius
_APART = 0.6  # a gap this wide, as a share of the radius, divides what is too wide for one robot ...
_APART_RAYS = 2.5  # ... if rays in it meet no robot, and ...
_APART_WIDTH = 0.7  # ... if what is on either side is as wide as this share of a robot: a ball hides less
_OVERLAP_WIDTH = 1.15  # what is this wide for one robot is divided where one robot hides another
_WHOLE = 0.3  # a robot counts as seen wholly if at most this share of half its width is missing
_LOST = 0.2  # standard deviation of a middle across the ray, as a share of the hidden width


def ray_count(rays: int, radius_m: float) -> int:
    """Returns the number of rays that finds narrow robots as reliably as `rays` find robots of the usual width.

    It grows with the cube of the ratio, because a ball in front of a narrow robot also hides a larger share of it.
    """
    narrower = max(1.0, ROBOT.radius_m / radius_m)
    return min(MOST_RAYS, round(rays * narrower**3))


def across_rays_px(mirror: Mirror, away_m: float, rays: int, deviation_px: float) -> float:
    """Returns the standard deviation in the picture, across the ray, of a robot's middle that `rays` around find.

    It is `deviation_px`, but more where the rays are further apart: there pixels do not help.
    """
    return max(deviation_px, _BETWEEN_RAYS * math.tau / rays * mirror.radius_px(away_m))


@dataclass(frozen=True)
class Obstacle:
    """A robot's middle on the ground, robot frame."""

    x_m: float
    y_m: float
    covariance_m2: Floats


class _Group(NamedTuple):
    """Feet of one or more robots."""

    feet: Feet
    right_hidden: bool = False
    """Something nearer hides the first end."""
    left_hidden: bool = False
    """Something nearer hides the last end."""


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
    """Number of rays that must meet a robot."""

    def find(self, hsv: Picture) -> list[Obstacle]:
        """Returns all robots in a scan (rays, samples, 3) in HSV, counter-clockwise."""
        feet = feet_in(hsv, self.star, self.black, self.carpet)
        if len(feet) < self.least_rays:
            return []
        return [self._obstacle(part) for group in self._groups(feet) for part in self._robots(group)]

    def _groups(self, feet: Feet) -> list[_Group]:
        """Divides feet at gaps wider than those that a ball in front of a robot makes."""
        rays, edges_m = feet.rays, feet.points_m
        gaps_m = np.hypot(*(edges_m - np.roll(edges_m, 1, axis=0)).T)  # the first with the last: the rays go around
        ranges_m = np.hypot(edges_m[:, 0], edges_m[:, 1])
        blur_m, _ = self.mirror.metres_per_px_each(ranges_m)
        steps = (rays - np.roll(rays, 1)) % len(self.star.ground_m)
        breaks = np.flatnonzero(gaps_m > _GAP * self.radius_m + blur_m)
        if len(breaks) == 0:  # a group alone may go around from the last ray to the first
            return [_Group(feet.beginning_at(int(steps.argmax())))]
        beside = steps[breaks] <= _BESIDE_RAYS
        nearer_before = (np.roll(ranges_m, 1) < ranges_m)[breaks]
        right_hidden = (beside & nearer_before).tolist()
        left_hidden = np.roll(beside & ~nearer_before, -1).tolist()
        rolled, bounds = feet.beginning_at(int(breaks[0])), [*(breaks - breaks[0]).tolist(), len(feet)]
        ends = zip(pairwise(bounds), right_hidden, left_hidden, strict=True)
        return [_Group(rolled.part(slice(*bound)), right, left) for bound, right, left in ends]

    def _robots(self, group: _Group) -> Iterator[_Group]:
        """Divides a group that is too wide for one robot where one hides another or at a gap; without either evenly."""
        feet = group.feet
        if len(feet) < self.least_rays:
            return
        wide = self._robots_wide(feet.points_m)
        if wide > _OVERLAP_WIDTH and (step := self._begin_of_step(feet)) is not None:
            first, hides_left = step
            yield from self._robots(_Group(feet.part(slice(first + 1)), group.right_hidden, not hides_left))
            yield from self._robots(_Group(feet.part(slice(first + 1, None)), hides_left, group.left_hidden))
            return
        parts = min(max(round(wide), 1), len(feet) // self.least_rays)
        if parts == 1:
            yield group
        elif (gap := self._begin_of_gap(feet.points_m)) is not None:
            yield from self._robots(_Group(feet.part(slice(gap + 1)), group.right_hidden))
            yield from self._robots(_Group(feet.part(slice(gap + 1, None)), left_hidden=group.left_hidden))
        else:
            for number, part in enumerate(np.array_split(np.arange(len(feet)), parts)):
                ends = number == 0 and group.right_hidden, number == parts - 1 and group.left_hidden
                yield _Group(feet.part(part), *ends)

    def _robots_wide(self, edges_m: Floats) -> float:
        """Returns how wide the points (n, 2) of a group are, as a multiple of a robot at their distance."""
        range_m = float(np.hypot(edges_m[:, 0], edges_m[:, 1]).mean())
        expected_rad = 2 * math.asin(min(self.radius_m / (range_m + self.radius_m), 1.0))
        return _turn(edges_m[0], edges_m[-1]) / expected_rad

    def _begin_of_step(self, feet: Feet) -> tuple[int, bool] | None:
        """Returns the foot before the largest step in distance, and whether the nearer robot is before the step.

        None without a step from ray to ray between a robot and another one, which it hides in part.
        """
        ranges_m = np.hypot(feet.points_m[:, 0], feet.points_m[:, 1])
        steps_m = np.diff(ranges_m)
        steps_m[np.diff(feet.rays) % len(self.star.ground_m) > _BESIDE_RAYS] = 0.0
        least = self.least_rays - 1
        possible_m = steps_m[least : len(steps_m) - least]
        if len(possible_m) == 0:
            return None
        first = least + int(np.abs(possible_m).argmax())
        hides_left = bool(steps_m[first] > 0.0)
        blur_m, _ = self.mirror.metres_per_px(float(ranges_m[first : first + 2].max()))
        nearer_m = feet.points_m[: first + 1] if hides_left else feet.points_m[first + 1 :]
        if abs(steps_m[first]) <= _APART * self.radius_m + blur_m or self._robots_wide(nearer_m) < _APART_WIDTH:
            return None
        return first, hides_left

    def _begin_of_gap(self, edges_m: Floats) -> int | None:
        """Returns the point (of n, 2) before the widest gap between robots; None without a gap."""
        gaps_m = np.hypot(*np.diff(edges_m, axis=0).T)
        widest = int(gaps_m.argmax())
        missed_rad = _turn(edges_m[widest], edges_m[widest + 1])
        if gaps_m[widest] <= _APART * self.radius_m or missed_rad <= _APART_RAYS * math.tau / len(self.star.ground_m):
            return None
        sides = edges_m[: widest + 1], edges_m[widest + 1 :]
        return widest if all(self._robots_wide(side) >= _APART_WIDTH for side in sides) else None

    def _obstacle(self, group: _Group) -> Obstacle:
        """Returns the robot of a group; the usual width places the middle of one that is hidden on one side."""
        edges_m, step_rad = group.feet.points_m, math.tau / len(self.star.ground_m)
        seen_m = group.feet.seen_m()
        seen_rad = _turn(edges_m[0], edges_m[-1])
        begin_rad = math.atan2(*edges_m[0, ::-1])
        away_m = self._away_m(seen_m, begin_rad + seen_rad / 2)
        middle_rad, lost_rad = seen_rad / 2, 0.0
        if group.right_hidden or group.left_hidden:
            for _ in range(2):  # how wide a robot should be depends on its distance, which depends on its middle
                half_rad = math.asin(min(self.radius_m / max(away_m, 1e-6), 1.0))
                lost_rad = 2 * half_rad - seen_rad - step_rad
                if lost_rad < _WHOLE * half_rad:
                    lost_rad = 0.0
                    break
                if group.right_hidden != group.left_hidden:
                    seen = half_rad - step_rad / 2  # from the edge that is seen to the middle
                    middle_rad = seen_rad - seen if group.right_hidden else seen
                    away_m = self._away_m(seen_m, begin_rad + middle_rad)
        middle_rad += begin_rad
        x_m, y_m = away_m * math.cos(middle_rad), away_m * math.sin(middle_rad)
        along_px, across_px = self.deviation_px
        across_px = across_rays_px(self.mirror, abs(away_m), len(self.star.ground_m), across_px)
        across_px = math.hypot(across_px, _LOST * lost_rad * self.mirror.radius_px(abs(away_m)))
        return Obstacle(x_m, y_m, plane_covariance(self.mirror, x_m, y_m, (along_px, across_px)))

    def _away_m(self, edges_m: Floats, middle_rad: float) -> float:
        """Returns the distance of a robot whose middle is in a direction."""
        ahead_x, ahead_y = math.cos(middle_rad), math.sin(middle_rad)
        edge_x_m, edge_y_m = edges_m.T
        along_m = edge_x_m * ahead_x + edge_y_m * ahead_y
        across_m = edge_y_m * ahead_x - edge_x_m * ahead_y
        return median(along_m + np.sqrt(np.maximum(self.radius_m**2 - across_m**2, 0.0)))


def _turn(first: Floats, last: Floats) -> float:
    """Returns the counter-clockwise angle from one direction to another, -pi..pi."""
    return math.remainder(math.atan2(last[1], last[0]) - math.atan2(first[1], first[0]), 2 * math.pi)
