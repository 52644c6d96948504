"""The omnidirectional mirror: which pixel sees which direction, and where that meets the ground.

The camera looks up into a parabolic mirror. Such a mirror has one effective viewpoint and maps directions to pixels by
stereographic projection (Nayar, "Catadioptric Omnidirectional Camera", CVPR 1997): a direction `angle` away from
straight down appears `scale * tan(angle / 2)` pixels from the centre. The mapping turns circles of directions into
circles, so a ball's outline is a circle in the picture, wherever it is.

Robot frame: x forward, y left, z up, metres, origin on the ground under the viewpoint. Pixels: (column, row), a whole
number is the middle of a pixel; forward is up in the picture, left is left.
"""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from procs.model.algebra import Floats, product

_LEAST = 1e-9  # smallest divisor


@dataclass(frozen=True)
class Mirror:
    """Calibration of a camera with its mirror."""

    size_px: int = 430
    """Height and width of the picture."""
    height_m: float = 0.75
    """Viewpoint above the ground."""
    view_angle_rad: float = math.radians(96.0)
    """Angle from straight down that the picture's edge sees; beyond 90 degrees is above the horizon."""
    roll_rad: float = 0.0
    """Tilt about the robot's x axis."""
    pitch_rad: float = 0.0
    """Tilt about the robot's y axis."""

    @property
    def centre_px(self) -> float:
        """Column and row of the picture's centre."""
        return (self.size_px - 1) / 2

    @property
    def scale_px(self) -> float:
        """Distance from the picture's centre at which a level direction appears."""
        return self.size_px / 2 / math.tan(self.view_angle_rad / 2)

    @cached_property
    def _from_mirror(self) -> Floats:
        """Turns directions in the mirror's frame into the robot's."""
        cr, sr, cp, sp = (f(a) for a in (self.roll_rad, self.pitch_rad) for f in (math.cos, math.sin))
        about_x = np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])
        about_y = np.array([[cp, 0.0, sp], [0.0, 1.0, 0.0], [-sp, 0.0, cp]])
        return product(about_y, about_x)

    def project(self, points_m: Floats) -> Floats:
        """Returns the pixels (n, 2) at which points (n, 3) of the robot frame appear."""
        rays = product(points_m - (0.0, 0.0, self.height_m), self._from_mirror)
        spread = np.linalg.norm(rays, axis=1) - rays[:, 2]
        return self._pixels(rays[:, :2] / spread[:, None])

    def sphere(self, centre_m: tuple[float, float, float], radius_m: float) -> tuple[float, float, float]:
        """Returns column, row and radius in pixels of the circle that a sphere forms in the picture.

        A sphere straight above the viewpoint is outside the circle; the radius is negative then. One around the
        viewpoint, level with it, is seen everywhere; the circle is huge then.
        """
        ray = product(np.array([centre_m]) - (0.0, 0.0, self.height_m), self._from_mirror)[0]
        distance_m = max(math.hypot(*ray), _LEAST)
        sine = min(radius_m / distance_m, 1.0)
        spread = (math.sqrt(1.0 - sine * sine) - float(ray[2]) / distance_m) or _LEAST
        column, row = self._pixels(ray[None, :2] / (distance_m * spread))[0]
        return float(column), float(row), self.scale_px * sine / spread

    def shows_all(self, column: float, row: float, radius_px: float) -> bool:
        """Returns whether a circle lies within the mirror's round picture; False without a positive radius."""
        return (
            radius_px > 0.0 and math.hypot(column - self.centre_px, row - self.centre_px) + radius_px < self.size_px / 2
        )

    def centre_of(self, column: float, row: float, radius_px: float, radius_m: float) -> tuple[float, float, float]:
        """Returns the centre (x, y, z) of a sphere of known radius that appears as this circle; undoes `sphere`."""
        offsets = (self.centre_px - np.array((row, column))) / self.scale_px
        squared, circle = float(offsets @ offsets), radius_px / self.scale_px
        down = (squared - circle * circle - 1.0) / 2.0
        spread = 1.0 / math.sqrt(squared + down * down)
        ray = product(np.array([(*(spread * offsets), spread * down)]), self._from_mirror.T)[0]
        x_m, y_m, z_m = (radius_m / (circle * spread) * ray).tolist()
        return x_m, y_m, z_m + self.height_m

    def ground(self, pixels: Floats, plane_m: float = 0.0) -> Floats:
        """Returns the points (n, 2) of the robot frame that pixels (n, 2) see in the level plane at height `plane_m`.

        Pixels that see the horizon or above it give NaN.
        """
        ahead, left = ((self.centre_px - pixels[:, axis]) / self.scale_px for axis in (1, 0))
        rays = (2.0 * ahead, 2.0 * left, ahead * ahead + left * left - 1.0)  # in the mirror's frame
        # By columns, which takes a third of the time that rows of three take.
        x, y, z = (rays[0] * row[0] + rays[1] * row[1] + rays[2] * row[2] for row in self._from_mirror)
        scale = (self.height_m - plane_m) / np.where(z < -_LEAST, -z, np.nan)
        return np.column_stack((x * scale, y * scale))

    def radius_px(self, distance_m: float) -> float:
        """Returns the radius in the picture at which ground at that distance appears, without tilt."""
        return self.scale_px * math.tan(math.atan2(distance_m, self.height_m) / 2)

    def distance_m(self, radius_px: float) -> float:
        """Returns the distance of the ground that appears at that radius, without tilt; inf from the horizon on."""
        angle_rad = 2.0 * math.atan(radius_px / self.scale_px)
        return self.height_m * math.tan(angle_rad) if angle_rad < math.pi / 2 else math.inf

    def reach_m(self, plane_m: float = 0.0) -> float:
        """Returns the largest distance at which the picture shows the level plane at height `plane_m`, without tilt."""
        level = self.view_angle_rad >= math.pi / 2
        return math.inf if level else (self.height_m - plane_m) * math.tan(self.view_angle_rad)

    def metres_per_px(self, distance_m: float, plane_m: float = 0.0) -> tuple[float, float]:
        """Returns the metres that one pixel covers at a distance in the level plane at height `plane_m`.

        They are those along the ray, and those across it.
        """
        below_m = self.height_m - plane_m
        reach_m = math.hypot(distance_m, below_m)
        along_px_rad = self.scale_px / (1.0 + below_m / reach_m)  # of the angle from straight down
        return reach_m**2 / below_m / along_px_rad, reach_m / along_px_rad

    def metres_per_px_each(self, distances_m: Floats, plane_m: float = 0.0) -> tuple[Floats, Floats]:
        """Returns `metres_per_px` of many distances (n): along the rays (n) and across them (n)."""
        below_m = self.height_m - plane_m
        reach_m = np.hypot(distances_m, below_m)
        across_m = reach_m * (1.0 + below_m / reach_m) / self.scale_px
        return across_m * reach_m / below_m, across_m

    def _pixels(self, offsets: Floats) -> Floats:
        return self.centre_px - self.scale_px * offsets[:, ::-1]
